"""Compiled terrain: gap, normal and curvature of one piece at one point, and the coarse search.

The gap g is the distance from the surface, open > 0; its gradient is the unit normal n out of the ground, its second
derivative H the curvature of the parallel surface, H n = 0. Planes, corners, cleats and half-rounds have them in closed
form. Below a graph z = h(x, y) the nearest point is found by Newton; with its tangents a_1, a_2, metric A = a . a,
second form b and M = A - g b,
    n_,r = H = -(A^-1 b M^-1)^{cd} a_c (x) a_d.
This holds as long as the point lies less deep than a crest's radius of curvature, M positive definite. Over a graph the
gap is that of the tangent plane below the point, without curvature: an open gap presses nothing.

Verified by tests/unit/test_ancf_terrain.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import Symmetric, Vector, compiled
from contracts.height_field import TILE
from contracts.terrain import PieceKind, TerrainPieces

__all__ = ["is_clear", "is_outside", "piece_bound", "piece_gap"]

FloatArray = NDArray[np.float64]
Gap = tuple[float, Vector, Symmetric]
Bound = tuple[float, float, float, float]
Graph = tuple[float, float, float, float, float, float]
PLANE, CORNER, HALF_ROUND = int(PieceKind.PLANE), int(PieceKind.CORNER), int(PieceKind.HALF_ROUND)
SINUSOID, HEIGHT_FIELD, CLEAT = int(PieceKind.SINUSOID), int(PieceKind.HEIGHT_FIELD), int(PieceKind.CLEAT)
ITERATIONS = 20
FLAT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@compiled
def piece_gap(piece: FloatArray, knots: FloatArray, x: float, y: float, z: float) -> Gap:
    """Gap [m], unit normal [-] and curvature H [1/m] (11, 22, 33, 23, 13, 12) of one piece at a point.

    Parameters
    ----------
    piece : (7,) float, see `contracts.terrain.PieceKind`
    knots : of the height field, see `contracts.terrain.TerrainPieces`
    x, y, z : the point [m]
    """
    kind = int(piece[0])
    if kind == PLANE:
        n = piece[1], piece[2], piece[3]
        return n[0] * x + n[1] * y + n[2] * z - piece[4], n, FLAT
    if kind in (SINUSOID, HEIGHT_FIELD):
        return _graph_gap(piece, knots, x, y, z)
    c, s = piece[1], piece[2]
    u, w, r = c * x + s * y - piece[3], z - piece[4], piece[5]
    if kind == CLEAT:  # the corner of its nearer side
        c, s, u = (-c, -s, piece[6] - u) if u > 0.0 else (c, s, piece[6] + u)
    if kind in (CORNER, CLEAT):
        u, w = u - r, w + r  # from the centre of the edge's arc
        if u >= 0.0 or w <= 0.0:  # above the top, before the face, or inside: the nearer of the two
            if w >= -u:
                return w - r, (0.0, 0.0, 1.0), FLAT
            return -u - r, (-c, -s, 0.0), FLAT
    elif w <= 0.0:  # below the axis a half-round has upright sides
        side = 1.0 if u >= 0.0 else -1.0
        return side * u - r, (side * c, side * s, 0.0), FLAT
    distance = max(math.hypot(u, w), 1e-300)
    a, b, k = u / distance, w / distance, 1.0 / distance
    t = c * b, s * b, -a
    H = k * t[0] * t[0], k * t[1] * t[1], k * t[2] * t[2], k * t[1] * t[2], k * t[0] * t[2], k * t[0] * t[1]
    return distance - r, (c * a, s * a, b), H


@compiled
def _graph(piece: FloatArray, knots: FloatArray, x: float, y: float) -> Graph:
    """Height and its derivatives h, h_x, h_y, h_xx, h_xy, h_yy of a sinusoid or a height field."""
    if int(piece[0]) == SINUSOID:
        c, s, k = piece[1], piece[2], piece[6]
        phase = k * (c * x + s * y - piece[3])
        wave, slope = piece[5] * math.sin(phase), piece[5] * k * math.cos(phase)
        return (
            piece[4] + wave,
            c * slope,
            s * slope,
            -k * k * c * c * wave,
            -k * k * c * s * wave,
            -k * k * s * s * wave,
        )
    u, v = (x - piece[1]) / piece[3], (y - piece[2]) / piece[4]
    i, j = _cell(u, len(knots)), _cell(v, knots.shape[1])
    a, b = _cubic(u - i), _cubic(v - j)
    h, h_x, h_y, h_xx, h_xy, h_yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for m in range(4):
        row = knots[i + m]
        f0, f1, f2, f3 = row[j], row[j + 1], row[j + 2], row[j + 3]
        f = f0 * b[0][0] + f1 * b[0][1] + f2 * b[0][2] + f3 * b[0][3]
        f_y = f0 * b[1][0] + f1 * b[1][1] + f2 * b[1][2] + f3 * b[1][3]
        f_yy = f0 * b[2][0] + f1 * b[2][1] + f2 * b[2][2] + f3 * b[2][3]
        h, h_y, h_yy = h + a[0][m] * f, h_y + a[0][m] * f_y, h_yy + a[0][m] * f_yy
        h_x, h_xy, h_xx = h_x + a[1][m] * f, h_xy + a[1][m] * f_y, h_xx + a[2][m] * f
    dx, dy = piece[3], piece[4]
    return h, h_x / dx, h_y / dy, h_xx / (dx * dx), h_xy / (dx * dy), h_yy / (dy * dy)


@compiled
def _cell(u: float, knots: int) -> int:
    """Cell of a place in grid units; the end cells go on beyond the grid."""
    return max(0, min(knots - 4, math.floor(u)))


@compiled
def _cubic(t: float) -> tuple[tuple[float, float, float, float], ...]:
    """Weights of cubic convolution, their first and second derivatives (Keys 1981)."""
    return (
        (
            0.5 * t * ((2.0 - t) * t - 1.0),
            0.5 * ((3.0 * t - 5.0) * t * t + 2.0),
            0.5 * t * ((4.0 - 3.0 * t) * t + 1.0),
            0.5 * t * t * (t - 1.0),
        ),
        (
            0.5 * ((4.0 - 3.0 * t) * t - 1.0),
            0.5 * t * (9.0 * t - 10.0),
            0.5 * ((8.0 - 9.0 * t) * t + 1.0),
            0.5 * t * (3.0 * t - 2.0),
        ),
        (2.0 - 3.0 * t, 9.0 * t - 5.0, 4.0 - 9.0 * t, 3.0 * t - 1.0),
    )


@compiled
def _graph_gap(piece: FloatArray, knots: FloatArray, x: float, y: float, z: float) -> Gap:
    """As `piece_gap`, for a graph."""
    u, v = x, y
    h, p, q, h_xx, h_xy, h_yy = _graph(piece, knots, u, v)
    scale = 1.0 / math.sqrt(1.0 + p * p + q * q)
    if z >= h:
        return (z - h) * scale, (-p * scale, -q * scale, scale), FLAT
    for _ in range(ITERATIONS):
        i11, i12, i22 = _inverse_foot_matrix(p, q, h_xx, h_xy, h_yy, z - h)
        r, s = x - u + p * (z - h), y - v + q * (z - h)
        du, dv = i11 * r + i12 * s, i12 * r + i22 * s
        u, v = u + du, v + dv
        h, p, q, h_xx, h_xy, h_yy = _graph(piece, knots, u, v)
        if du * du + dv * dv < 1e-20:  # [m^2]; what is left is its square
            break
    scale = 1.0 / math.sqrt(1.0 + p * p + q * q)
    n = -p * scale, -q * scale, scale
    gap = n[0] * (x - u) + n[1] * (y - v) + n[2] * (z - h)
    # C = A^-1 b M^-1, symmetric
    m11, m12, m22 = _inverse_foot_matrix(p, q, h_xx, h_xy, h_yy, gap * scale)
    b11, b12, b22 = scale * h_xx, scale * h_xy, scale * h_yy
    t11, t12 = b11 * m11 + b12 * m12, b11 * m12 + b12 * m22
    t21, t22 = b12 * m11 + b22 * m12, b12 * m12 + b22 * m22
    area = scale * scale
    c11 = -area * ((1.0 + q * q) * t11 - p * q * t21)
    c12 = -area * ((1.0 + q * q) * t12 - p * q * t22)
    c22 = -area * ((1.0 + p * p) * t22 - p * q * t12)
    by_1, by_2 = c11 * p + c12 * q, c12 * p + c22 * q
    return gap, n, (c11, c22, by_1 * p + by_2 * q, by_2, by_1, c12)


@compiled
def _inverse_foot_matrix(
    p: float, q: float, xx: float, xy: float, yy: float, drop: float
) -> tuple[float, float, float]:
    """Inverse of M = A - drop h_,ab as 11, 12, 22; of the metric A alone where M is not positive definite."""
    a, b, c = 1.0 + p * p - drop * xx, p * q - drop * xy, 1.0 + q * q - drop * yy
    det = a * c - b * b
    if not (a > 0.0 and det > 1e-6):
        a, b, c = 1.0 + p * p, p * q, 1.0 + q * q
        det = a * c - b * b
    return c / det, -b / det, a / det


@compiled
def is_outside(piece: FloatArray, knots: FloatArray, x: float, y: float) -> bool:
    """Whether x, y [m] lie beside a height field, where its end cells are only continued; piece (7,) as `piece_gap`."""
    if int(piece[0]) != HEIGHT_FIELD:
        return False
    u, v = (x - piece[1]) / piece[3], (y - piece[2]) / piece[4]
    return bool(min(u, v) < -1e-9 or u > len(knots) - 3 + 1e-9 or v > knots.shape[1] - 3 + 1e-9)


@compiled
def piece_bound(piece: FloatArray, terrain: TerrainPieces, low: Vector, high: Vector) -> Bound:
    """Half space n . r < d that holds all of a piece that lies in a box: n_x, n_y, n_z, d.

    A plane itself, else all below a height; d is minus infinity if none of the piece is above, in or below the box.

    Parameters
    ----------
    piece, terrain : one of the terrain's rows, and the terrain
    low, high : corners of the box [m]
    """
    kind, d = int(piece[0]), -np.inf
    if kind == PLANE:
        return piece[1], piece[2], piece[3], piece[4]
    if kind == HEIGHT_FIELD:
        return 0.0, 0.0, 1.0, _ceiling(piece, terrain, low, high)
    c, s = piece[1], piece[2]
    first = least(c, low[0], high[0]) + least(s, low[1], high[1]) - piece[3]
    last = -least(-c, low[0], high[0]) - least(-s, low[1], high[1]) - piece[3]
    if kind == SINUSOID:
        d = piece[4] + _highest_wave(piece[5], piece[6] * first, piece[6] * last)
    elif (kind == CORNER and last >= 0.0) or (kind == CLEAT and first <= piece[6] and last >= -piece[6]):
        d = piece[4]
    elif kind == HALF_ROUND and first <= piece[5] and last >= -piece[5]:
        d = piece[4] + piece[5]
    return 0.0, 0.0, 1.0, d


@compiled
def is_clear(bound: Bound, low: Vector, high: Vector) -> bool:
    """Whether a box, corners (x, y, z) [m], lies outside the half space (n_x, n_y, n_z, d) [-, m] of `piece_bound`."""
    return (
        least(bound[0], low[0], high[0]) + least(bound[1], low[1], high[1]) + least(bound[2], low[2], high[2])
        > bound[3]
    )


@compiled
def _highest_wave(amplitude: float, first: float, last: float) -> float:
    """Largest amplitude sin(phase) from the first to the last phase."""
    crest = 0.5 * math.pi + 2.0 * math.pi * math.ceil((first - 0.5 * math.pi) / (2.0 * math.pi))
    return amplitude * (1.0 if crest <= last else max(math.sin(first), math.sin(last)))


@compiled
def least(a: float, low: float, high: float) -> float:
    """Smallest a x [m] over x in low..high [m], a [-]."""
    return a * low if a > 0.0 else a * high


@compiled
def _ceiling(piece: FloatArray, terrain: TerrainPieces, low: Vector, high: Vector) -> float:
    """Upper bound of a height field below a box; infinite where the box overhangs the field."""
    knots, (x, y, dx, dy) = terrain.knots, (piece[1], piece[2], piece[3], piece[4])
    if is_outside(piece, knots, low[0], low[1]) or is_outside(piece, knots, high[0], high[1]):
        return np.inf
    ceilings, top = terrain.ceilings, -np.inf
    for i in range(_tile(low[0] - x, dx, len(ceilings)), _tile(high[0] - x, dx, len(ceilings)) + 1):
        for j in range(_tile(low[1] - y, dy, ceilings.shape[1]), _tile(high[1] - y, dy, ceilings.shape[1]) + 1):
            top = max(top, ceilings[i, j])
    return top


@compiled
def _tile(offset: float, spacing: float, tiles: int) -> int:
    """Tile of a place on the grid."""
    return max(0, min(tiles - 1, math.floor(offset / (TILE * spacing))))
