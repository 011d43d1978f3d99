"""Compiled loops over all plates of a mesh: exact tangent of the elastic force, plate by plate.

With the letters of `elastic_kernels` and h_k = G^km g_m, the derivative of P^k = S^kl g_l with respect to g_l is
    A_kl = w [S^kl I + lambda h_k (x) h_l + mu (G^kl B + h_l (x) h_k)],   B = g_m (x) h_m,
and the tangent between the functions s and t of a plate is the sum over its points of ds/dxi^k A_kl dt/dxi^l.
Row 3 s + i of a plate's matrix is function s, component i, in the normalised coordinates of `elastic_kernels.gather`;
`to_structure` turns it into structure coordinates.

Verified by tests/unit/test_ancf_plate_model.py (finite differences).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import (
    LANES,
    columns,
    combination,
    compiled,
    inlined,
    put,
    symmetric_at,
    vector_at,
)
from ancf_reduced.plates.elastic_kernels import base_vectors, gather, strain, stress

__all__ = [
    "SYMMETRIC",
    "add_stiffness",
    "mirror",
    "point_stiffness",
    "stresses_and_normals",
    "tangent_kernel",
    "to_structure",
]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SYMMETRIC = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
"""Place of component (k, l) in a symmetric tensor (11, 22, 33, 23, 13, 12)."""


@inlined
def add_stiffness(A: FloatArray, left: FloatArray, right: FloatArray, K: FloatArray, upper: bool) -> None:
    """Add sum over points of left_s^k A_kl right_t^l to K (48, 48); with ``upper`` only its blocks t >= s.

    A : (9, 9, LANES), row 3 k + i, column 3 l + j; left, right : (3, 16, LANES) derivatives of the shape functions
    """
    row = np.empty((9, LANES))
    for s in range(16):
        for i in range(3):
            for m in range(9):
                for q in range(LANES):
                    row[m, q] = left[0, s, q] * A[i, m, q] + left[1, s, q] * A[3 + i, m, q]
            if s % 4 == 3:
                for m in range(9):
                    for q in range(LANES):
                        row[m, q] += left[2, s, q] * A[6 + i, m, q]
            for t in range(s if upper else 0, 16):
                x, y, z = 0.0, 0.0, 0.0
                for q in range(LANES):
                    by_1, by_2 = right[0, t, q], right[1, t, q]
                    x += row[0, q] * by_1 + row[3, q] * by_2
                    y += row[1, q] * by_1 + row[4, q] * by_2
                    z += row[2, q] * by_1 + row[5, q] * by_2
                if t % 4 == 3:
                    for q in range(LANES):
                        by_3 = right[2, t, q]
                        x += row[6, q] * by_3
                        y += row[7, q] * by_3
                        z += row[8, q] * by_3
                K[3 * s + i, 3 * t] += x
                K[3 * s + i, 3 * t + 1] += y
                K[3 * s + i, 3 * t + 2] += z


@inlined
def mirror(K: FloatArray) -> None:
    """Fill the blocks below the diagonal of a symmetric plate matrix (48, 48)."""
    for row in range(48):
        for column in range(row - row % 3):
            K[row, column] = K[column, row]


@inlined
def to_structure(K: FloatArray, frame: FloatArray, half: FloatArray) -> None:
    """Turn a plate matrix K (48, 48) into structure coordinates in place; ``half`` (48, 48) is overwritten.

    K_p = T^T K T with the T of thesis eq. 2.17, which mixes the three gradients of a node and nothing else.
    """
    for n in range(4):
        for k in range(4):
            for i in range(3):
                row = 12 * n + 3 * k + i
                for column in range(48):
                    if k == 0:
                        half[row, column] = K[row, column]
                    else:
                        first = 12 * n + 3 + i
                        half[row, column] = (
                            frame[n, k - 1, 0] * K[first, column]
                            + frame[n, k - 1, 1] * K[first + 3, column]
                            + frame[n, k - 1, 2] * K[first + 6, column]
                        )
    for row in range(48):
        for n in range(4):
            for i in range(3):
                first = 12 * n + 3 + i
                K[row, 12 * n + i] = half[row, 12 * n + i]
                for k in range(3):
                    K[row, first + 3 * k] = (
                        frame[n, k, 0] * half[row, first]
                        + frame[n, k, 1] * half[row, first + 3]
                        + frame[n, k, 2] * half[row, first + 6]
                    )


@inlined
def stresses_and_normals(
    g: FloatArray, metric: FloatArray, moduli: FloatArray, S: FloatArray, h: FloatArray, B: FloatArray
) -> None:
    """Weighted stress S (6, LANES), h_k (3, 3, LANES) and B (6, LANES) at each point.

    g : (3, 3, LANES) base vectors; metric : (2, 6, LANES); moduli : (2, LANES) lambda and mu times the weight
    """
    for q in range(LANES):
        a, b, c = vector_at(g, 0, q), vector_at(g, 1, q), vector_at(g, 2, q)
        G = symmetric_at(metric[1], q)
        T = stress(strain(a, b, c, symmetric_at(metric[0], q)), G, moduli[0, q], moduli[1, q])
        S[0, q], S[1, q], S[2, q], S[3, q], S[4, q], S[5, q] = T
        g1, g2, g3 = columns(G)
        x, y, z = combination(g1, a, b, c), combination(g2, a, b, c), combination(g3, a, b, c)
        put(h, 0, q, x)
        put(h, 1, q, y)
        put(h, 2, q, z)
        B[0, q] = a[0] * x[0] + b[0] * y[0] + c[0] * z[0]
        B[1, q] = a[1] * x[1] + b[1] * y[1] + c[1] * z[1]
        B[2, q] = a[2] * x[2] + b[2] * y[2] + c[2] * z[2]
        B[3, q] = a[1] * x[2] + b[1] * y[2] + c[1] * z[2]
        B[4, q] = a[0] * x[2] + b[0] * y[2] + c[0] * z[2]
        B[5, q] = a[0] * x[1] + b[0] * y[1] + c[0] * z[1]


@inlined
def point_stiffness(
    S: FloatArray, h: FloatArray, B: FloatArray, G: FloatArray, moduli: FloatArray, A: FloatArray
) -> None:
    """A (9, 9, LANES) of the module's docstring; G (6, LANES) is the inverse metric."""
    for k in range(3):
        for m in range(3):
            km = SYMMETRIC[k, m]
            for i in range(3):
                for j in range(3):
                    ij = SYMMETRIC[i, j]
                    initial = 1.0 if i == j else 0.0
                    for q in range(LANES):
                        A[3 * k + i, 3 * m + j, q] = (
                            moduli[0, q] * h[k, i, q] * h[m, j, q]
                            + moduli[1, q] * (G[km, q] * B[ij, q] + h[m, i, q] * h[k, j, q])
                            + initial * S[km, q]
                        )


@compiled
def tangent_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    metric: FloatArray,
    w: FloatArray,
    lame: tuple[float, float],
    tangent: FloatArray,
) -> None:
    """Exact tangent dQ_s/dp of each plate.

    Parameters
    ----------
    p, elements, frame, D, metric, w, lame : as `elastic_kernels.energy_kernel`
    tangent : (n_plates, 48, 48) float [N/m, N, N m], overwritten; row 12 n + 3 c + i is the plate's node n, vector c of
        (r, r_X, r_Y, r_Z), component i
    """
    e, half = np.empty((16, 3)), np.empty((48, 48))
    g, h, S, B = np.empty((3, 3, LANES)), np.empty((3, 3, LANES)), np.empty((6, LANES)), np.empty((6, LANES))
    A, moduli = np.empty((9, 9, LANES)), np.empty((2, LANES))
    tangent[:] = 0.0
    for plate in range(len(elements)):
        gather(p, elements[plate], frame[plate], e)
        for k in range(len(D)):
            base_vectors(e, D[k], g)
            for q in range(LANES):
                moduli[0, q], moduli[1, q] = w[plate, k, q] * lame[0], w[plate, k, q] * lame[1]
            stresses_and_normals(g, metric[plate, k], moduli, S, h, B)
            point_stiffness(S, h, B, metric[plate, k, 1], moduli, A)
            add_stiffness(A, D[k], D[k], tangent[plate], True)
        mirror(tangent[plate])
        to_structure(tangent[plate], frame[plate], half)
