"""Compiled loops that relieve Poisson locking: what they give is added to the elastic energy, force and tangent.

The director is linear through the thickness, so its strain E_33 cannot follow the Poisson contraction of bending, which
changes sign across it: with nu > 0 the plate is too stiff in bending, 1 / (1 - nu^2) times in a narrow strip and
(1 - nu)^2 / (1 - 2 nu) times where it is held flat across its width (1.12 and 1.32 at nu = 0.33).
The cure is that of shells with an enhanced linear thickness strain (Buechter, Ramm & Roehl 1994), condensed at each
point: the strain splits into that of the mid-surface, carried to the point, and the rest dE, and the rest has no stress
S^33. With c^kl = C^kl33, C = C^3333 and tau = c : dE / C the energy changes by -w C tau^2 / 2.
Letters as in `elastic_kernels`; f_k are the base vectors on the mid-surface below a point, H the components of the
stress-free base vectors at the point in those of the mid-surface, so that sum_m f_m H_mk is the mid-surface's
deformation carried to the point and dE_kl = (g_k.g_l - sum_mn H_mk H_nl f_m.f_n) / 2.

Verified by tests/unit/test_ancf_thickness.py and tests/verification/test_ancf_poisson.py.
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

__all__ = ["relief_energy_kernel", "relief_force_kernel", "relief_tangent_kernel"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@inlined
def _row(H: FloatArray, m: int, q: int) -> Vector:
    return H[m, 0, q], H[m, 1, q], H[m, 2, q]


@inlined
def _thickness_stress(
    g: FloatArray,
    f: FloatArray,
    H: FloatArray,
    G: FloatArray,
    lame: tuple[float, float],
    c: FloatArray,
    alpha: FloatArray,
    beta: FloatArray,
    stiffness: FloatArray,
    tau: FloatArray,
) -> None:
    """tau (LANES,), C (LANES,), c^kl (6, LANES), and d tau = (alpha^k . dg_k - beta^k . df_k) / C, (3, 3, LANES)."""
    for q in range(LANES):
        g1, g2, g3 = columns(symmetric_at(G, q))
        lam, mu = lame[0] * g3[2], 2.0 * lame[1]
        c1 = lam * g1[0] + mu * g1[2] * g1[2], lam * g1[1] + mu * g1[2] * g2[2], lam * g1[2] + mu * g1[2] * g3[2]
        c2 = c1[1], lam * g2[1] + mu * g2[2] * g2[2], lam * g2[2] + mu * g2[2] * g3[2]
        c3 = c1[2], c2[2], lam * g3[2] + mu * g3[2] * g3[2]
        c[0, q], c[1, q], c[2, q], c[3, q], c[4, q], c[5, q] = c1[0], c2[1], c3[2], c2[2], c1[2], c1[1]
        a1, a2, a3 = vector_at(g, 0, q), vector_at(g, 1, q), vector_at(g, 2, q)
        f1, f2, f3 = vector_at(f, 0, q), vector_at(f, 1, q), vector_at(f, 2, q)
        h1, h2, h3 = _row(H, 0, q), _row(H, 1, q), _row(H, 2, q)
        b1 = combination((h1[0], h2[0], h3[0]), f1, f2, f3)
        b2 = combination((h1[1], h2[1], h3[1]), f1, f2, f3)
        b3 = combination((h1[2], h2[2], h3[2]), f1, f2, f3)
        x1, x2, x3 = combination(c1, a1, a2, a3), combination(c2, a1, a2, a3), combination(c3, a1, a2, a3)
        y1, y2, y3 = combination(c1, b1, b2, b3), combination(c2, b1, b2, b3), combination(c3, b1, b2, b3)
        doubled = dot(x1, a1) + dot(x2, a2) + dot(x3, a3) - dot(y1, b1) - dot(y2, b2) - dot(y3, b3)
        stiffness[q] = c3[2]
        tau[q] = 0.5 * doubled / c3[2] if c3[2] > 0.0 else 0.0  # zero at the points that only fill up a block
        put(alpha, 0, q, x1)
        put(alpha, 1, q, x2)
        put(alpha, 2, q, x3)
        put(beta, 0, q, combination(h1, y1, y2, y3))
        put(beta, 1, q, combination(h2, y1, y2, y3))
        put(beta, 2, q, combination(h3, y1, y2, y3))


@compiled
def relief_energy_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: tuple[FloatArray, FloatArray],
    H: FloatArray,
    metric: FloatArray,
    w: FloatArray,
    lame: tuple[float, float],
) -> float:
    """Change of the strain energy of all plates, <= 0 [J].

    Parameters
    ----------
    p, elements, frame, metric, w, lame : as `elastic_kernels.energy_kernel`
    D : derivatives of the shape functions at the points and on the mid-surface, (n_blocks, 3, 16, LANES) each
    H : (n_plates, n_blocks, 3, 3, LANES) float [-]
    """
    e, g, f = np.empty((16, 3)), np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    alpha, beta, c = np.empty((3, 3, LANES)), np.empty((3, 3, LANES)), np.empty((6, LANES))
    stiffness, tau, energy = np.empty(LANES), np.empty(LANES), 0.0
    for j in range(len(elements)):
        gather(p, elements[j], frame[j], e)
        for k in range(len(w[j])):
            base_vectors(e, D[0][k], g)
            base_vectors(e, D[1][k], f)
            _thickness_stress(g, f, H[j, k], metric[j, k, 1], lame, c, alpha, beta, stiffness, tau)
            for q in range(LANES):
                energy -= 0.5 * w[j, k, q] * stiffness[q] * tau[q] * tau[q]
    return energy


@compiled
def relief_force_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: tuple[FloatArray, FloatArray],
    H: FloatArray,
    metric: FloatArray,
    w: FloatArray,
    lame: tuple[float, float],
    force: FloatArray,
) -> None:
    """Add the derivative of the energy's change to the generalised elastic force (n_nodes, 4, 3)."""
    e, forces = np.empty((16, 3)), np.empty((16, 3))
    g, f = np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    alpha, beta, c = np.empty((3, 3, LANES)), np.empty((3, 3, LANES)), np.empty((6, LANES))
    stiffness, tau = np.empty(LANES), np.empty(LANES)
    for j in range(len(elements)):
        gather(p, elements[j], frame[j], e)
        forces[:] = 0.0
        for k in range(len(w[j])):
            base_vectors(e, D[0][k], g)
            base_vectors(e, D[1][k], f)
            _thickness_stress(g, f, H[j, k], metric[j, k, 1], lame, c, alpha, beta, stiffness, tau)
            for m in range(3):
                for i in range(3):
                    for q in range(LANES):
                        weighted = w[j, k, q] * tau[q]
                        alpha[m, i, q] *= -weighted
                        beta[m, i, q] *= weighted
            point_forces(alpha, D[0][k], forces)
            point_forces(beta, D[1][k], forces)
        add_structure_force(forces, elements[j], frame[j], force)


@inlined
def _fill(left: FloatArray, right: FloatArray, by: FloatArray, S: FloatArray, A: FloatArray, initial: float) -> None:
    """A_kl = by left^k (x) right^l + initial S^kl I, (9, 9, LANES)."""
    for k in range(3):
        for m in range(3):
            km = SYMMETRIC[k, m]
            for i in range(3):
                for j in range(3):
                    geometric = initial if i == j else 0.0
                    for q in range(LANES):
                        A[3 * k + i, 3 * m + j, q] = by[q] * left[k, i, q] * right[m, j, q] + geometric * S[km, q]


@inlined
def _carry(H: FloatArray, c: FloatArray, carried: FloatArray) -> None:
    """H c H^T (6, LANES) of a symmetric c (6, LANES)."""
    for q in range(LANES):
        c1, c2, c3 = columns(symmetric_at(c, q))
        h1, h2, h3 = _row(H, 0, q), _row(H, 1, q), _row(H, 2, q)
        r1, r2, r3 = combination(h1, c1, c2, c3), combination(h2, c1, c2, c3), combination(h3, c1, c2, c3)
        carried[0, q], carried[1, q], carried[2, q] = dot(r1, h1), dot(r2, h2), dot(r3, h3)
        carried[3, q], carried[4, q], carried[5, q] = dot(r2, h3), dot(r1, h3), dot(r1, h2)


@inlined
def _add_both(cross: FloatArray, K: FloatArray) -> None:
    """Add a matrix and its transpose to K, (48, 48) both."""
    for row in range(48):
        for column in range(48):
            K[row, column] += cross[row, column] + cross[column, row]


@compiled
def relief_tangent_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: tuple[FloatArray, FloatArray],
    H: FloatArray,
    metric: FloatArray,
    w: FloatArray,
    lame: tuple[float, float],
    tangent: FloatArray,
) -> None:
    """Add the second derivative of the energy's change to the plates' tangents (n_plates, 48, 48)."""
    e, K, cross, half = np.empty((16, 3)), np.empty((48, 48)), np.empty((48, 48)), np.empty((48, 48))
    g, f = np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    alpha, beta = np.empty((3, 3, LANES)), np.empty((3, 3, LANES))
    c, carried = np.empty((6, LANES)), np.empty((6, LANES))
    stiffness, tau, by, A = np.empty(LANES), np.empty(LANES), np.empty(LANES), np.empty((9, 9, LANES))
    for plate in range(len(elements)):
        gather(p, elements[plate], frame[plate], e)
        K[:], cross[:] = 0.0, 0.0
        for k in range(len(w[plate])):
            base_vectors(e, D[0][k], g)
            base_vectors(e, D[1][k], f)
            _thickness_stress(g, f, H[plate, k], metric[plate, k, 1], lame, c, alpha, beta, stiffness, tau)
            _carry(H[plate, k], c, carried)
            for q in range(LANES):
                by[q] = -w[plate, k, q] / stiffness[q] if stiffness[q] > 0.0 else 0.0
                for m in range(6):
                    c[m, q] *= w[plate, k, q] * tau[q]
                    carried[m, q] *= w[plate, k, q] * tau[q]
            _fill(alpha, alpha, by, c, A, -1.0)
            add_stiffness(A, D[0][k], D[0][k], K, True)
            _fill(beta, beta, by, carried, A, 1.0)
            add_stiffness(A, D[1][k], D[1][k], K, True)
            for q in range(LANES):
                by[q] = -by[q]
            _fill(alpha, beta, by, c, A, 0.0)
            add_stiffness(A, D[0][k], D[1][k], cross, False)
        mirror(K)
        _add_both(cross, K)
        to_structure(K, frame[plate], half)
        tangent[plate] += K
