"""Compiled gaps of points on plates' faces, from rigid surfaces and from other plates.

A point lies at a height h along its plate's normal, x = r + h n. Of a rigid surface with gap g(x), normal N = dg / dx
and bend B = d2g / dx2 the gap's second derivative is B by dx twice, and h N . d2n. Of another plate the gap is that of
the closest point x_m on its middle surface; with N its normal towards the point, D = N . (x - x_m), metric m and
curvature kappa = N . r_,ab there, tau_a = a_a . (dx - dx_m) and nu_a = N . dx_m,a,

    dD = N . (dx - dx_m),
    d2D = N . d2x - tau m^-1 nu - nu m^-1 tau - D nu m^-1 nu - (tau + D nu) (m - D kappa)^-1 kappa m^-1 (tau + D nu),

the same form as the solid model's facets have (docs/theory.md 2.4). Verified by tests/unit/test_ancf_wheel_contacts.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import compiled
from ancf_reduced.thin_plates.kernels import normal_second, unit_normal
from ancf_reduced.wheel.kernels import spread, vectors

__all__ = ["Faces", "face_points", "face_slopes", "plate_gaps", "rigid_gaps"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Faces = tuple[Index, Array, Array]
"""Points on faces: plates (n,), heights along their normals (n,) [m], rows r, r_1, r_2 (n, 3, 16)."""


@compiled
def face_points(q: Array, plates: Index, points: Faces, places: Array, normals: Array) -> None:
    """Points (n, 3) [m] and the unit normals (n, 3) of their faces, outwards, into ``places`` and ``normals``."""
    which, heights, tables = points
    v = np.empty((3, 3))
    for p in range(which.shape[0]):
        vectors(q, plates[which[p]], tables[p], v)
        n, _ = unit_normal(v[1:])
        for i in range(3):
            places[p, i] = v[0, i] + heights[p] * n[i]
            normals[p, i] = n[i] if heights[p] > 0.0 else -n[i]


@compiled
def face_slopes(q: Array, plates: Index, points: Faces, slopes: Array) -> None:
    """Derivatives (n, 3, 16, 3) of the places of points by their plates' vectors."""
    which, heights, tables = points
    v, second, turn, none = np.empty((3, 3)), np.empty((6, 6)), np.empty((3, 6)), np.zeros(3)
    for p in range(which.shape[0]):
        vectors(q, plates[which[p]], tables[p], v)
        n, J = unit_normal(v[1:])
        normal_second(v[1:], n, J, none, second, turn)
        for i in range(3):
            for k in range(16):
                for j in range(3):
                    value = tables[p, 0, k] if i == j else 0.0
                    value += heights[p] * (turn[i, j] * tables[p, 1, k] + turn[i, 3 + j] * tables[p, 2, k])
                    slopes[p, i, k, j] = value


@compiled
def rigid_gaps(
    q: Array,
    plates: Index,
    points: Faces,
    surface: tuple[Array, Array],
    forces: Array,
    slopes: Array,
    tangent: Array,
) -> None:
    """Slopes of gaps from a rigid surface, and what forces there add to the tangent.

    Parameters
    ----------
    points : see `Faces`
    surface : normals (n, 3) and bends (n, 3, 3) [1/m] of the surface at the points
    forces : (n,) [N] of the surface on the wheel
    slopes : (n, 16, 3) by the plate's vectors
    tangent : (n_plates, 16, 3, 16, 3) added to
    """
    which, heights, tables = points
    normals, bends = surface
    v, slope, H, moved = np.empty((3, 3)), np.empty(9), np.zeros((9, 9)), np.zeros((3, 9))
    second, turn = np.empty((6, 6)), np.empty((3, 6))
    for p in range(which.shape[0]):
        height, N = heights[p], normals[p]
        vectors(q, plates[which[p]], tables[p], v)
        n, J = unit_normal(v[1:])
        normal_second(v[1:], n, J, N, second, turn)
        slope[:3] = N
        for j in range(6):
            slope[3 + j] = height * (N[0] * turn[0, j] + N[1] * turn[1, j] + N[2] * turn[2, j])
        for k in range(16):
            for i in range(3):
                slopes[p, k, i] = 0.0
                for d in range(3):
                    slopes[p, k, i] += slope[3 * d + i] * tables[p, d, k]
        if forces[p] > 0.0 and tangent.shape[0]:
            for i in range(3):
                moved[i, i] = 1.0
                for j in range(6):
                    moved[i, 3 + j] = height * turn[i, j]
            H[:] = -forces[p] * (moved.T @ bends[p] @ moved)
            H[3:, 3:] -= forces[p] * height * second
            spread(H, tables[p], tangent[which[p]])


@compiled
def plate_gaps(
    q: Array,
    plates: Index,
    points: Faces,
    others: tuple[Index, Array, Array],
    forces: Array,
    block: Index,
    found: tuple[Array, Array],
    tangent: Array,
) -> None:
    """Gaps of points from the faces of other plates, at their closest points, with slopes and tangents.

    Parameters
    ----------
    others : plates (n,), heights of their faces along their normals (n,) [m], rows of `shape_tables` (n, 6, 16)
    forces : (n,) [N] that hold the point off
    block : (n,) number of the tangent
    found : gaps (n,) [m] and their slopes (n, 32, 3) by the vectors of point's plate and the other
    tangent : (n_blocks, 32, 3, 32, 3) added to
    """
    which, heights, tables = points
    masters, faces, rows = others
    gaps, slopes = found
    s, m, bend = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    second, turn, N = np.empty((6, 6)), np.empty((3, 6)), np.empty(3)
    slope, tau, nu = np.zeros(18), np.zeros((2, 18)), np.zeros((2, 18))
    metric, kappa, all_rows = np.empty((2, 2)), np.empty((2, 2)), np.zeros((6, 32))
    for p in range(which.shape[0]):
        vectors(q, plates[which[p]], tables[p], s)
        vectors(q, plates[masters[p]], rows[p, :3], m)
        vectors(q, plates[masters[p]], rows[p, 3:], bend)
        side = 1.0 if faces[p] > 0.0 else -1.0
        N[:] = side * unit_normal(m[1:])[0]
        n, J = unit_normal(s[1:])
        normal_second(s[1:], n, J, N, second, turn)
        distance = 0.0
        for i in range(3):
            distance += N[i] * (s[0, i] + heights[p] * n[i] - m[0, i])
        gaps[p] = distance - side * faces[p]
        slope[:3], slope[9:12] = N, -N
        for j in range(6):
            slope[3 + j] = heights[p] * (N[0] * turn[0, j] + N[1] * turn[1, j] + N[2] * turn[2, j])
        for k in range(16):
            for r in range(3):
                all_rows[r, k], all_rows[3 + r, 16 + k] = tables[p, r, k], rows[p, r, k]
        for k in range(32):
            for i in range(3):
                slopes[p, k, i] = 0.0
                for r in range(6):
                    slopes[p, k, i] += slope[3 * r + i] * all_rows[r, k]
        if forces[p] > 0.0:
            for a in range(2):
                tau[a, :3], tau[a, 9:12] = m[1 + a], -m[1 + a]
                for j in range(6):
                    tau[a, 3 + j] = heights[p] * (
                        m[1 + a, 0] * turn[0, j] + m[1 + a, 1] * turn[1, j] + m[1 + a, 2] * turn[2, j]
                    )
                nu[a, 12 + 3 * a : 15 + 3 * a] = N
                for b in range(2):
                    metric[a, b] = np.dot(m[1 + a], m[1 + b])
                    kappa[a, b] = np.dot(N, bend[a + b])
            inverse = np.linalg.inv(metric)
            along = tau + distance * nu
            both = tau.T @ inverse @ nu
            H = both + both.T + distance * (nu.T @ inverse @ nu)
            H += along.T @ (np.linalg.inv(metric - distance * kappa) @ kappa @ inverse) @ along
            H[3:9, 3:9] -= heights[p] * second
            H *= forces[p]
            spread(H, all_rows, tangent[block[p]])
