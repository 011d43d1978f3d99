"""Compiled loops over all plates of a mesh: Navier-Stokes damping, its force and both its tangents.

Viscous Cauchy stress sigma = lambda_v tr(D) I + 2 mu_v D of the rate of deformation D, the symmetric part of the
velocity gradient L = sum_k v_k (x) g^k; its second Piola-Kirchhoff form is that of Grossi & Shabana (2019). It vanishes
in every rigid motion. Letters as in `elastic_kernels`; v_k = d(dr/dt)/dxi^k; g^k are the dual base vectors, g^k . g_l =
delta_kl; V = g_1 . (g_2 x g_3); c the Gauss weight, so that c V is the present volume of a point. The force is the sum
over points of P^k . ds/dxi^k, P^k = c V sigma g^k, and its derivatives are
    by velocity : c V [lambda_v g^k (x) g^l + mu_v (g^k.g^l I + g^l (x) g^k)]
    by position : c V [sigma g^k (x) g^l - sigma g^l (x) g^k - lambda_v g^k (x) L^T g^l
                       - mu_v (g^k.g^l L + g^l (x) L^T g^k)]

Verified by tests/unit/test_ancf_damping.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import (
    LANES,
    Vector,
    columns,
    combination,
    compiled,
    dot,
    inlined,
    put,
    symmetric_at,
    vector_at,
)
from ancf_reduced.plates.elastic_kernels import add_structure_force, base_vectors, gather, point_forces
from ancf_reduced.plates.tangent_kernels import SYMMETRIC, add_stiffness, mirror, to_structure

__all__ = [
    "add_viscous_stiffness",
    "damping_force_kernel",
    "damping_position_kernel",
    "damping_velocity_kernel",
    "dual_vectors",
    "products_of",
]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@inlined
def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inlined
def _scaled(v: Vector, factor: float) -> Vector:
    return factor * v[0], factor * v[1], factor * v[2]


@inlined
def dual_vectors(g: FloatArray, dual: FloatArray, volume: FloatArray, c: FloatArray) -> None:
    """Dual base vectors (3, 3, LANES) and c V (LANES,) from the base vectors g (3, 3, LANES)."""
    for q in range(LANES):
        a1, a2, a3 = vector_at(g, 0, q), vector_at(g, 1, q), vector_at(g, 2, q)
        n1, n2, n3 = _cross(a2, a3), _cross(a3, a1), _cross(a1, a2)
        V = dot(a1, n1)
        factor = 1.0 / V if V != 0.0 else 0.0  # zero at the points that only fill up a block
        put(dual, 0, q, _scaled(n1, factor))
        put(dual, 1, q, _scaled(n2, factor))
        put(dual, 2, q, _scaled(n3, factor))
        volume[q] = c[q] * V


@inlined
def _velocity_gradient(v: FloatArray, dual: FloatArray, L: FloatArray) -> None:
    """L (3, 3, LANES), L_ij = sum_k v_k,i g^k_j."""
    for i in range(3):
        for j in range(3):
            for q in range(LANES):
                L[i, j, q] = v[0, i, q] * dual[0, j, q] + v[1, i, q] * dual[1, j, q] + v[2, i, q] * dual[2, j, q]


@inlined
def _viscous_stress(L: FloatArray, volume: FloatArray, moduli: tuple[float, float], T: FloatArray) -> None:
    """c V sigma (6, LANES)."""
    for q in range(LANES):
        lam, mu = moduli[0] * volume[q], moduli[1] * volume[q]
        trace = lam * (L[0, 0, q] + L[1, 1, q] + L[2, 2, q])
        T[0, q] = trace + 2.0 * mu * L[0, 0, q]
        T[1, q] = trace + 2.0 * mu * L[1, 1, q]
        T[2, q] = trace + 2.0 * mu * L[2, 2, q]
        T[3, q] = mu * (L[1, 2, q] + L[2, 1, q])
        T[4, q] = mu * (L[0, 2, q] + L[2, 0, q])
        T[5, q] = mu * (L[0, 1, q] + L[1, 0, q])


@inlined
def _tractions(T: FloatArray, dual: FloatArray, P: FloatArray) -> None:
    """P^k = c V sigma g^k, (3, 3, LANES)."""
    for q in range(LANES):
        t1, t2, t3 = columns(symmetric_at(T, q))
        put(P, 0, q, combination(vector_at(dual, 0, q), t1, t2, t3))
        put(P, 1, q, combination(vector_at(dual, 1, q), t1, t2, t3))
        put(P, 2, q, combination(vector_at(dual, 2, q), t1, t2, t3))


@compiled
def damping_force_kernel(
    p: FloatArray,
    v: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    c: FloatArray,
    moduli: tuple[float, float],
    force: FloatArray,
) -> None:
    """Generalised damping force of all plates; it opposes an external force, as the elastic force does.

    Parameters
    ----------
    p, v : (n_nodes, 4, 3) float, structure coordinates [m, -] and their rates [m/s, 1/s]
    elements, frame, D : as `elastic_kernels.energy_kernel`
    c : (n_blocks, LANES) float [-], Gauss weights
    moduli : lambda_v, mu_v [Pa s]
    force : (n_nodes, 4, 3) float [N, N m], overwritten
    """
    e, e_dot, forces = np.empty((16, 3)), np.empty((16, 3)), np.empty((16, 3))
    g, rate, dual = np.empty((3, 3, LANES)), np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    L, T, P, volume = np.empty((3, 3, LANES)), np.empty((6, LANES)), np.empty((3, 3, LANES)), np.empty(LANES)
    force[:] = 0.0
    for j in range(len(elements)):
        gather(p, elements[j], frame[j], e)
        gather(v, elements[j], frame[j], e_dot)
        forces[:] = 0.0
        for k in range(len(D)):
            base_vectors(e, D[k], g)
            base_vectors(e_dot, D[k], rate)
            dual_vectors(g, dual, volume, c[k])
            _velocity_gradient(rate, dual, L)
            _viscous_stress(L, volume, moduli, T)
            _tractions(T, dual, P)
            point_forces(P, D[k], forces)
        add_structure_force(forces, elements[j], frame[j], force)


@inlined
def products_of(dual: FloatArray, products: FloatArray) -> None:
    """g^k . g^l (6, LANES)."""
    for k in range(3):
        for m in range(k, 3):
            for q in range(LANES):
                products[SYMMETRIC[k, m], q] = (
                    dual[k, 0, q] * dual[m, 0, q] + dual[k, 1, q] * dual[m, 1, q] + dual[k, 2, q] * dual[m, 2, q]
                )


@inlined
def add_viscous_stiffness(
    dual: FloatArray, products: FloatArray, volume: FloatArray, moduli: tuple[float, float], A: FloatArray
) -> None:
    """Add the derivative of P^k by the rate of g_l to A (9, 9, LANES), see the module's docstring."""
    for k in range(3):
        for m in range(3):
            km = SYMMETRIC[k, m]
            for i in range(3):
                for j in range(3):
                    same = moduli[1] if i == j else 0.0
                    for q in range(LANES):
                        A[3 * k + i, 3 * m + j, q] += volume[q] * (
                            moduli[0] * dual[k, i, q] * dual[m, j, q]
                            + moduli[1] * dual[m, i, q] * dual[k, j, q]
                            + same * products[km, q]
                        )


@compiled
def damping_velocity_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    c: FloatArray,
    moduli: tuple[float, float],
    tangent: FloatArray,
) -> None:
    """Damping matrix of each plate, the derivative of its damping force by the rates, symmetric.

    tangent : (n_plates, 48, 48) float [N s/m, ...], overwritten, laid out as in `tangent_kernels.tangent_kernel`; the
    other arguments as `damping_force_kernel`
    """
    e, half, volume = np.empty((16, 3)), np.empty((48, 48)), np.empty(LANES)
    g, dual = np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    A, products = np.empty((9, 9, LANES)), np.empty((6, LANES))
    tangent[:] = 0.0
    for plate in range(len(elements)):
        gather(p, elements[plate], frame[plate], e)
        for block in range(len(D)):
            base_vectors(e, D[block], g)
            dual_vectors(g, dual, volume, c[block])
            products_of(dual, products)
            A[:] = 0.0
            add_viscous_stiffness(dual, products, volume, moduli, A)
            add_stiffness(A, D[block], D[block], tangent[plate], True)
        mirror(tangent[plate])
        to_structure(tangent[plate], frame[plate], half)


@inlined
def _carried(L: FloatArray, dual: FloatArray, carried: FloatArray) -> None:
    """L^T g^k (3, 3, LANES)."""
    for k in range(3):
        for j in range(3):
            for q in range(LANES):
                carried[k, j, q] = L[0, j, q] * dual[k, 0, q] + L[1, j, q] * dual[k, 1, q] + L[2, j, q] * dual[k, 2, q]


@inlined
def _position_stiffness(
    P: FloatArray,
    L: FloatArray,
    dual: FloatArray,
    carried: FloatArray,
    products: FloatArray,
    volume: FloatArray,
    moduli: tuple[float, float],
    A: FloatArray,
) -> None:
    """Derivative of P^k by g_l, (9, 9, LANES), see the module's docstring."""
    for k in range(3):
        for m in range(3):
            km = SYMMETRIC[k, m]
            for i in range(3):
                for j in range(3):
                    for q in range(LANES):
                        lam, mu = moduli[0] * volume[q], moduli[1] * volume[q]
                        A[3 * k + i, 3 * m + j, q] = (
                            P[k, i, q] * dual[m, j, q]
                            - P[m, i, q] * dual[k, j, q]
                            - lam * dual[k, i, q] * carried[m, j, q]
                            - mu * (products[km, q] * L[i, j, q] + dual[m, i, q] * carried[k, j, q])
                        )


@compiled
def damping_position_kernel(
    p: FloatArray,
    v: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    c: FloatArray,
    moduli: tuple[float, float],
    tangent: FloatArray,
) -> None:
    """Derivative of each plate's damping force by its coordinates at fixed rates, not symmetric.

    tangent : (n_plates, 48, 48) float [N/m, ...], overwritten, laid out as in `tangent_kernels.tangent_kernel`; the
    other arguments as `damping_force_kernel`
    """
    e, e_dot, half = np.empty((16, 3)), np.empty((16, 3)), np.empty((48, 48))
    g, rate, dual = np.empty((3, 3, LANES)), np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    L, T, P, volume = np.empty((3, 3, LANES)), np.empty((6, LANES)), np.empty((3, 3, LANES)), np.empty(LANES)
    A, products, carried = np.empty((9, 9, LANES)), np.empty((6, LANES)), np.empty((3, 3, LANES))
    tangent[:] = 0.0
    for plate in range(len(elements)):
        gather(p, elements[plate], frame[plate], e)
        gather(v, elements[plate], frame[plate], e_dot)
        for k in range(len(D)):
            base_vectors(e, D[k], g)
            base_vectors(e_dot, D[k], rate)
            dual_vectors(g, dual, volume, c[k])
            _velocity_gradient(rate, dual, L)
            _viscous_stress(L, volume, moduli, T)
            _tractions(T, dual, P)
            products_of(dual, products)
            _carried(L, dual, carried)
            _position_stiffness(P, L, dual, carried, products, volume, moduli, A)
            add_stiffness(A, D[k], D[k], tangent[plate], False)
        to_structure(tangent[plate], frame[plate], half)
