"""Compiled loops over all plates of a mesh: strain energy and elastic force.

General continuum mechanics with the St. Venant-Kirchhoff law (thesis eqs. 2.9, 2.10 mended, 2.23), written in the
normalised coordinates xi^1 = x1/a, xi^2 = x2/b, xi^3 = x3/t, so that one table of shape function derivatives serves
every plate. Letters, per integration point: g_k = dr/dxi^k; E_kl = (g_k . g_l - G_kl) / 2; S^kl = lambda tr(E) G^kl +
2 mu G^km E_mn G^nl with the metric G of the stress-free configuration; w = dV0 times the Gauss weight. These are the
components of thesis eq. 2.10's E = 1/2 (J0^-T Je^T Je J0^-1 - I) and of S in the base J0 diag(a, b, t).
The points of a plate lie along the last axis of every array, in blocks of LANES, a constant that the compiler turns
into vector instructions; the last block is filled up with points of weight zero.

Verified by tests/unit/test_ancf_plate_model.py (finite differences) and
tests/verification/test_ancf_plate_reference.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import (
    LANES,
    Symmetric,
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

__all__ = [
    "add_structure_force",
    "base_vectors",
    "energy_kernel",
    "force_kernel",
    "gather",
    "point_forces",
    "strain",
    "stress",
]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@inlined
def gather(p: FloatArray, nodes: IntArray, frame: FloatArray, e: FloatArray) -> None:
    """Normalised plate coordinates e (16, 3): per node r, r_xi1, r_xi2, r_xi3, from structure coordinates p.

    Thesis eq. 2.17 with the lengths: r_xi_m = sum_k r_Xk frame[k, m], frame (4, 3, 3) = J0 diag(a, b, t) at the nodes.
    """
    for n in range(4):
        node = p[nodes[n]]
        for i in range(3):
            e[4 * n, i] = node[0, i]
            for m in range(3):
                e[4 * n + 1 + m, i] = (
                    node[1, i] * frame[n, 0, m] + node[2, i] * frame[n, 1, m] + node[3, i] * frame[n, 2, m]
                )


@inlined
def add_structure_force(q: FloatArray, nodes: IntArray, frame: FloatArray, force: FloatArray) -> None:
    """Add the plate's force q (16, 3), conjugate to `gather`'s e, to the mesh's force (n_nodes, 4, 3)."""
    for n in range(4):
        for i in range(3):
            force[nodes[n], 0, i] += q[4 * n, i]
            for k in range(3):
                force[nodes[n], 1 + k, i] += (
                    q[4 * n + 1, i] * frame[n, k, 0]
                    + q[4 * n + 2, i] * frame[n, k, 1]
                    + q[4 * n + 3, i] * frame[n, k, 2]
                )


@inlined
def strain(a: Vector, b: Vector, c: Vector, G: Symmetric) -> Symmetric:
    """Covariant Green-Lagrange strain [m^2] of the base vectors a, b, c against the metric G_kl."""
    return (
        0.5 * (dot(a, a) - G[0]),
        0.5 * (dot(b, b) - G[1]),
        0.5 * (dot(c, c) - G[2]),
        0.5 * (dot(b, c) - G[3]),
        0.5 * (dot(a, c) - G[4]),
        0.5 * (dot(a, b) - G[5]),
    )


@inlined
def stress(E: Symmetric, G: Symmetric, lam: float, mu: float) -> Symmetric:
    """Contravariant second Piola-Kirchhoff stress [Pa/m^2] lam tr(E) G + 2 mu G E G; G is the inverse metric G^kl."""
    g1, g2, g3 = columns(G)
    e1, e2, e3 = columns(E)
    m1 = dot(g1, e1), dot(g1, e2), dot(g1, e3)  # rows of the mixed strain G E
    m2 = dot(g2, e1), dot(g2, e2), dot(g2, e3)
    m3 = dot(g3, e1), dot(g3, e2), dot(g3, e3)
    t, u = lam * (m1[0] + m2[1] + m3[2]), 2.0 * mu
    return (
        t * G[0] + u * dot(m1, g1),
        t * G[1] + u * dot(m2, g2),
        t * G[2] + u * dot(m3, g3),
        t * G[3] + u * dot(m2, g3),
        t * G[4] + u * dot(m1, g3),
        t * G[5] + u * dot(m1, g2),
    )


@inlined
def base_vectors(e: FloatArray, D: FloatArray, g: FloatArray) -> None:
    """Base vectors g (3, 3, LANES), [k, i] = dr_i/dxi^k, of a plate.

    e : (16, 3) normalised plate coordinates; D : (3, 16, LANES) derivatives of the shape functions. Only the
    director functions, every fourth, depend on xi^3.
    """
    g[:] = 0.0
    for s in range(16):
        x, y, z = e[s, 0], e[s, 1], e[s, 2]
        for q in range(LANES):
            by_1, by_2 = D[0, s, q], D[1, s, q]
            g[0, 0, q] += x * by_1
            g[0, 1, q] += y * by_1
            g[0, 2, q] += z * by_1
            g[1, 0, q] += x * by_2
            g[1, 1, q] += y * by_2
            g[1, 2, q] += z * by_2
    for s in range(3, 16, 4):
        x, y, z = e[s, 0], e[s, 1], e[s, 2]
        for q in range(LANES):
            by_3 = D[2, s, q]
            g[2, 0, q] += x * by_3
            g[2, 1, q] += y * by_3
            g[2, 2, q] += z * by_3


@inlined
def point_forces(P: FloatArray, D: FloatArray, forces: FloatArray) -> None:
    """Add the sum over the points of P^k . ds/dxi^k to the plate's forces (16, 3); P (3, 3, LANES) as g."""
    for s in range(16):
        x, y, z = 0.0, 0.0, 0.0
        for q in range(LANES):
            by_1, by_2 = D[0, s, q], D[1, s, q]
            x += P[0, 0, q] * by_1 + P[1, 0, q] * by_2
            y += P[0, 1, q] * by_1 + P[1, 1, q] * by_2
            z += P[0, 2, q] * by_1 + P[1, 2, q] * by_2
        if s % 4 == 3:
            for q in range(LANES):
                by_3 = D[2, s, q]
                x += P[2, 0, q] * by_3
                y += P[2, 1, q] * by_3
                z += P[2, 2, q] * by_3
        forces[s, 0] += x
        forces[s, 1] += y
        forces[s, 2] += z


@compiled
def energy_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    metric: FloatArray,
    w: FloatArray,
    lame: tuple[float, float],
) -> float:
    """Strain energy [J] of all plates, sum of w S : E / 2.

    Parameters
    ----------
    p : (n_nodes, 4, 3) float [m, -], structure coordinates
    elements : (n_plates, 4) int, nodes of each plate
    frame : (n_plates, 4, 3, 3) float [m], see `gather`
    D : (n_blocks, 3, 16, LANES) float [-], derivatives of the normalised shape functions
    metric : (n_plates, n_blocks, 2, 6, LANES) float [m^2, 1/m^2], G_kl and G^kl
    w : (n_plates, n_blocks, LANES) float [m^3]
    lame : lambda, mu [Pa]
    """
    e, g, total = np.empty((16, 3)), np.empty((3, 3, LANES)), 0.0
    for j in range(len(elements)):
        gather(p, elements[j], frame[j], e)
        for k in range(len(D)):
            base_vectors(e, D[k], g)
            for q in range(LANES):
                a, b, c = vector_at(g, 0, q), vector_at(g, 1, q), vector_at(g, 2, q)
                E = strain(a, b, c, symmetric_at(metric[j, k, 0], q))
                S = stress(E, symmetric_at(metric[j, k, 1], q), lame[0], lame[1])
                diagonal = S[0] * E[0] + S[1] * E[1] + S[2] * E[2]
                total += w[j, k, q] * (0.5 * diagonal + S[3] * E[3] + S[4] * E[4] + S[5] * E[5])
    return total


@compiled
def force_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    metric: FloatArray,
    w: FloatArray,
    lame: tuple[float, float],
    force: FloatArray,
) -> None:
    """Generalised elastic force Q_s = dU/dp of all plates (thesis eq. 2.23).

    Parameters
    ----------
    p, elements, frame, D, metric, w, lame : as `energy_kernel`
    force : (n_nodes, 4, 3) float [N, N m], overwritten
    """
    e, forces = np.empty((16, 3)), np.empty((16, 3))
    g, P = np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    force[:] = 0.0
    for j in range(len(elements)):
        gather(p, elements[j], frame[j], e)
        forces[:] = 0.0
        for k in range(len(D)):
            base_vectors(e, D[k], g)
            for q in range(LANES):
                a, b, c = vector_at(g, 0, q), vector_at(g, 1, q), vector_at(g, 2, q)
                E = strain(a, b, c, symmetric_at(metric[j, k, 0], q))
                S = stress(E, symmetric_at(metric[j, k, 1], q), w[j, k, q] * lame[0], w[j, k, q] * lame[1])
                s1, s2, s3 = columns(S)
                put(P, 0, q, combination(s1, a, b, c))
                put(P, 1, q, combination(s2, a, b, c))
                put(P, 2, q, combination(s3, a, b, c))
            point_forces(P, D[k], forces)
        add_structure_force(forces, elements[j], frame[j], force)
