"""Compiled search for the contact points that touch the ground, and what the loops over them share (thesis 2.4.1).

A plate whose box (that of its face's Bezier points, which enclose the face) is clear of the terrain costs only the box;
of the others, points above all ground below the box are passed over.

Verified by tests/unit/test_ancf_plate_contact.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import LANES, Symmetric, Vector, compiled, dot, inlined, vector_at
from ancf_reduced.contact.grid import GridTables
from ancf_reduced.contact.law import LawNumbers
from ancf_reduced.contact.terrain_kernels import is_clear, is_outside, piece_bound, piece_gap
from ancf_reduced.plates.elastic_kernels import gather
from contracts.terrain import TerrainPieces

__all__ = ["TOUCH", "Constants", "at_point", "find_touching", "named", "touch_at"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Constants = tuple[
    tuple[IntArray, IntArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray],
    tuple[FloatArray, FloatArray, FloatArray],
    tuple[float, float, float, float, float, float],
    bool,
]
"""Fields of GridTables, TerrainPieces and LawNumbers, and whether the normal is the tire's own (thesis 2.22): as plain
tuples, which a call from Python hands over twice as fast as named ones."""
TOUCH = 10
"""Numbers kept of a touching point: gap, normal, curvature."""
EVERYWHERE = (0.0, 0.0, 0.0, 0.0)
"""A bound that excludes no point."""


@inlined
def named(constants: Constants) -> tuple[GridTables, TerrainPieces, LawNumbers, bool]:
    """The constants with their names."""
    grid, terrain, law, by_surface = constants
    return GridTables(*grid), TerrainPieces(*terrain), LawNumbers(*law), by_surface


@inlined
def _points(e: FloatArray, shape: FloatArray, r: FloatArray) -> None:
    """Positions r (3, LANES) from normalised plate coordinates e (16, 3) and functions (16, LANES)."""
    r[:] = 0.0
    for s in range(16):
        x, y, z = e[s, 0], e[s, 1], e[s, 2]
        for q in range(LANES):
            f = shape[s, q]
            r[0, q] += x * f
            r[1, q] += y * f
            r[2, q] += z * f


@inlined
def _box(r: FloatArray) -> tuple[Vector, Vector]:
    """Lowest and highest coordinates of the points r (3, LANES)."""
    x_low, y_low, z_low = r[0, 0], r[1, 0], r[2, 0]
    x_high, y_high, z_high = x_low, y_low, z_low
    for q in range(LANES):
        x_low, x_high = min(x_low, r[0, q]), max(x_high, r[0, q])
        y_low, y_high = min(y_low, r[1, q]), max(y_high, r[1, q])
        z_low, z_high = min(z_low, r[2, q]), max(z_high, r[2, q])
    return (x_low, y_low, z_low), (x_high, y_high, z_high)


@inlined
def _note(entry: FloatArray, gap: float, n: Vector, H: Symmetric) -> None:
    """Write an entry (10,) that `touch_at` reads."""
    entry[0], entry[1], entry[2], entry[3] = gap, n[0], n[1], n[2]
    entry[4], entry[5], entry[6], entry[7], entry[8], entry[9] = H


@compiled
def find_touching(
    p: FloatArray, grid: GridTables, terrain: TerrainPieces, search: bool, where: IntArray, touch: FloatArray
) -> int:
    """List the points with a gap below zero.

    Parameters
    ----------
    p : (n_nodes, 4, 3) float [m, -], structure coordinates in the world frame
    grid, terrain : tables
    search : whether plates and points surely clear are passed over; without it the list is the same
    where : (n, 2) int, carrier and point of each entry, written; n = carriers x points x pieces is enough
    touch : (n, 10) float, gap, normal, curvature (11, 22, 33, 23, 13, 12), written

    Returns
    -------
    count : entries of the list; minus one less than the number of points beside a height field, if there are any
    """
    e, hull, r = np.empty((16, 3)), np.empty((3, LANES)), np.empty((len(grid.shape), 3, LANES))
    count, outside, n_points = 0, 0, grid.interpolation.shape[1]
    for j in range(len(grid.nodes)):
        gather(p, grid.nodes[j], grid.frame[j], e)
        _points(e, grid.hull, hull)
        low, high = _box(hull)
        known = False
        for piece in terrain.rows:
            bound = piece_bound(piece, terrain, low, high) if search else EVERYWHERE
            if search and is_clear(bound, low, high):
                continue
            if not known:
                known = True
                for k in range(len(grid.shape)):
                    _points(e, grid.shape[k], r[k])
            for point in range(n_points):
                x, y, z = vector_at(r, point // LANES, point % LANES)
                if dot((bound[0], bound[1], bound[2]), (x, y, z)) > bound[3]:
                    continue
                gap, n, H = piece_gap(piece, terrain.knots, x, y, z)
                if gap < 0.0:
                    outside += is_outside(piece, terrain.knots, x, y)
                    where[count, 0], where[count, 1] = j, point
                    _note(touch[count], gap, n, H)
                    count += 1
    return count if outside == 0 else -1 - outside


@inlined
def touch_at(touch: FloatArray) -> tuple[float, Vector, Symmetric]:
    """Gap [m], normal [-] and curvature [1/m] of an entry."""
    H = touch[4], touch[5], touch[6], touch[7], touch[8], touch[9]
    return touch[0], (touch[1], touch[2], touch[3]), H


@inlined
def at_point(p: FloatArray, nodes: IntArray, functions: FloatArray) -> Vector:
    """Sum of the functions (16,) times the vectors of a plate's nodes."""
    x, y, z = 0.0, 0.0, 0.0
    for n in range(4):
        node = p[nodes[n]]
        for c in range(4):
            f = functions[4 * n + c]
            x, y, z = x + f * node[c, 0], y + f * node[c, 1], z + f * node[c, 2]
    return x, y, z
