"""Compiled energy, force and tangent of ties. Verified by tests/unit/test_ancf_wheel_static.py."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import compiled
from ancf_reduced.thin_plates.kernels import normal_second, unit_normal

__all__ = ["find_tie_forces", "spread", "tie_terms", "vectors"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Ties = tuple[Index, Index, Array, Array, Array, Array, Array]


@compiled
def vectors(q: Array, nodes: Index, tables: Array, out: Array) -> None:
    """Vectors (n, 3), such as r, a_1, a_2, at a point of a plate with rows tables (n, 16)."""
    for d in range(tables.shape[0]):
        for i in range(3):
            out[d, i] = 0.0
            for k in range(16):
                out[d, i] += tables[d, k] * q[nodes[k // 4], k % 4, i]


@compiled
def tie_terms(
    q: Array,
    plates: Index,
    ties: Ties,
    weights: tuple[Array, Array],
    mixed: Array,
    force: Array,
    tangent: Array,
) -> float:
    """Energy of edges that follow a plate at an offset along its normal [J]; adds forces and tangents.

    With g = r_s - r_m - d n_m and h = a_s . (c_n n_m + c_2 a_2m): (k_r g . g + k_n h^2) / 2 at every point.

    Parameters
    ----------
    ties : plates that follow (springs) and that are followed (the rim) (n,), offsets d (n,) [m], rows r and a_s of
        the spring (n, p, 2, 16), r, r_1, r_2 of the rim at p points (n, p, 3, 16), c_n and c_2 (n, 2), and g and h
        (n, p, 4) at rest, which do not count: where both edges are curved, cubics leave some
    weights : k_r [N/m] and k_n [N m] of every point, (n, p)
    mixed : (n, p, 4) forces for the geometric part of the tangent; of no ties for those that belong to q
    force, tangent : (n, 32, 3), (n, 32, 3, 32, 3) of the spring's 16 and the rim's 16 vectors
    """
    springs, rims, offsets, of_spring, of_rim, square, rest = ties
    by_place, by_turn = weights
    energy, s, m = 0.0, np.empty((2, 3)), np.empty((3, 3))
    second, turn, c, normal = np.empty((6, 6)), np.empty((3, 6)), np.empty(3), np.empty(3)
    # Rows: vectors r_s, a_s, r_m, a_1m, a_2m; columns: components of g and h.
    slope, H = np.empty((15, 4)), np.empty((15, 15))
    weight, gap, held, rows = np.empty(4), np.empty(4), np.empty(4), np.zeros((5, 32))
    for t in range(springs.shape[0]):
        for p in range(by_place.shape[1]):
            vectors(q, plates[springs[t]], of_spring[t, p], s)
            vectors(q, plates[rims[t]], of_rim[t, p], m)
            n, J = unit_normal(m[1:])
            normal[:] = n
            d, c_n, c_2 = offsets[t], square[t, 0], square[t, 1]
            h = -rest[t, p, 3]
            for i in range(3):
                gap[i] = s[0, i] - m[0, i] - d * n[i] - rest[t, p, i]
                h += s[1, i] * (c_n * n[i] + c_2 * m[2, i])
            gap[3] = h
            weight[:3], weight[3] = by_place[t, p], by_turn[t, p]
            for i in range(4):
                held[i] = mixed[t, p, i] if mixed.shape[0] else weight[i] * gap[i]
            for i in range(3):
                c[i] = -d * held[i] + held[3] * c_n * s[1, i]
            normal_second(m[1:], n, J, c, second, turn)
            slope[:] = 0.0
            for i in range(3):
                slope[i, i], slope[6 + i, i] = 1.0, -1.0
                slope[3 + i, 3] = c_n * n[i] + c_2 * m[2, i]
                slope[12 + i, 3] += c_2 * s[1, i]
                for j in range(6):
                    slope[9 + j, i] = -d * turn[i, j]
                    slope[9 + j, 3] += c_n * s[1, i] * turn[i, j]
            for r in range(3):
                for k in range(16):
                    if r < 2:
                        rows[r, k] = of_spring[t, p, r, k]
                    rows[2 + r, 16 + k] = of_rim[t, p, r, k]
            for j in range(4):
                energy += 0.5 * weight[j] * gap[j] ** 2
            for a in range(5):
                for i in range(3):
                    value = 0.0
                    for j in range(4):
                        value += weight[j] * gap[j] * slope[3 * a + i, j]
                    for k in range(32):
                        force[t, k, i] += rows[a, k] * value
            if tangent.shape[0]:
                for a in range(15):
                    for b in range(15):
                        H[a, b] = 0.0
                        for j in range(4):
                            H[a, b] += weight[j] * slope[a, j] * slope[b, j]
                H[9:, 9:] += second
                for i in range(3):
                    H[3 + i, 12 + i] += held[3] * c_2
                    H[12 + i, 3 + i] += held[3] * c_2
                    for j in range(6):
                        H[3 + i, 9 + j] += held[3] * c_n * turn[i, j]
                        H[9 + j, 3 + i] += held[3] * c_n * turn[i, j]
                spread(H, rows, tangent[t])
    return energy


@compiled
def spread(H: Array, rows: Array, out: Array) -> None:
    """Add rows^T H rows: H (3 n, 3 n) by vectors, rows (n, m), out (m, 3, m, 3)."""
    n, m = rows.shape
    half = np.zeros((n, 3, m, 3))
    for a in range(n):
        for i in range(3):
            for b in range(n):
                for j in range(3):
                    value = H[3 * a + i, 3 * b + j]
                    for k in range(m):
                        half[a, i, k, j] += value * rows[b, k]
    for a in range(n):
        for k in range(m):
            if rows[a, k] != 0.0:
                for i in range(3):
                    for c in range(m):
                        for j in range(3):
                            out[k, i, c, j] += rows[a, k] * half[a, i, c, j]


@compiled
def find_tie_forces(
    q: Array,
    step: Array,
    plates: Index,
    ties: Ties,
    weights: tuple[Array, Array],
    out: Array,
) -> None:
    """Forces (n, p, 4) of ties after a step from q, linearised."""
    springs, rims, offsets, of_spring, of_rim, square, rest = ties
    s, m, ds, dm = np.empty((2, 3)), np.empty((3, 3)), np.empty((2, 3)), np.empty((3, 3))
    second, turn, c = np.empty((6, 6)), np.empty((3, 6)), np.zeros(3)
    for t in range(springs.shape[0]):
        for p in range(out.shape[1]):
            vectors(q, plates[springs[t]], of_spring[t, p], s)
            vectors(q, plates[rims[t]], of_rim[t, p], m)
            vectors(step, plates[springs[t]], of_spring[t, p], ds)
            vectors(step, plates[rims[t]], of_rim[t, p], dm)
            n, J = unit_normal(m[1:])
            normal_second(m[1:], n, J, c, second, turn)
            h = -rest[t, p, 3]
            for i in range(3):
                dn = 0.0
                for j in range(3):
                    dn += turn[i, j] * dm[1, j] + turn[i, 3 + j] * dm[2, j]
                gap = s[0, i] - m[0, i] + ds[0, i] - dm[0, i] - offsets[t] * (n[i] + dn) - rest[t, p, i]
                out[t, p, i] = weights[0][t, p] * gap
                across = square[t, 0] * n[i] + square[t, 1] * m[2, i]
                h += (s[1, i] + ds[1, i]) * across + s[1, i] * (square[t, 0] * dn + square[t, 1] * dm[2, i])
            out[t, p, 3] = weights[1][t, p] * h
