"""Heights of sinusoids and height fields with their derivatives; compiled.

The height field is interpolated by Keys' cubic convolution (`contracts.height_field`); beyond its grid the end cells go
on, and `is_beside` tells so.

Verified by tests/unit/test_brush_contact.py (against the terrain's own heights and their differences).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import PieceKind
from rover_dynamics.tires.brush_compiled import compiled

__all__ = ["Graph", "graph", "graph_height", "is_beside"]

FloatArray = NDArray[np.float64]
type Graph = tuple[float, float, float, float, float, float]
type Four = tuple[float, float, float, float]
SINUSOID, HEIGHT_FIELD = int(PieceKind.SINUSOID), int(PieceKind.HEIGHT_FIELD)


@compiled
def graph_height(piece: FloatArray, knots: FloatArray, x: float, y: float) -> float:
    """Height [m] of a sinusoid or height field at (x, y) [m]."""
    if int(piece[0]) == SINUSOID:
        return float(piece[4] + piece[5] * math.sin(piece[6] * (piece[1] * x + piece[2] * y - piece[3])))
    u, v = (x - piece[1]) / piece[3], (y - piece[2]) / piece[4]
    i, j = _cell(u, knots.shape[0]), _cell(v, knots.shape[1])
    a, b = _value_weights(u - i), _value_weights(v - j)
    return (
        a[0] * _across(knots, i, j, b)
        + a[1] * _across(knots, i + 1, j, b)
        + a[2] * _across(knots, i + 2, j, b)
        + a[3] * _across(knots, i + 3, j, b)
    )


@compiled
def graph(piece: FloatArray, knots: FloatArray, x: float, y: float) -> Graph:
    """Height and derivatives h, h_x, h_y, h_xx, h_xy, h_yy [m, -, 1/m]."""
    if int(piece[0]) == SINUSOID:
        c, s, k = piece[1], piece[2], piece[6]
        phase = k * (c * x + s * y - piece[3])
        wave, slope = piece[5] * math.sin(phase), piece[5] * k * math.cos(phase)
        bend = -k * k * wave
        return piece[4] + wave, c * slope, s * slope, c * c * bend, c * s * bend, s * s * bend
    u, v = (x - piece[1]) / piece[3], (y - piece[2]) / piece[4]
    i, j = _cell(u, knots.shape[0]), _cell(v, knots.shape[1])
    a, b = _value_weights(u - i), _value_weights(v - j)
    a1, b1 = _slope_weights(u - i), _slope_weights(v - j)
    a2, b2 = _bend_weights(u - i), _bend_weights(v - j)
    h, h_x, h_y, h_xx, h_xy, h_yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for m in range(4):
        f, f_y = _across(knots, i + m, j, b), _across(knots, i + m, j, b1)
        h, h_x, h_xx = h + a[m] * f, h_x + a1[m] * f, h_xx + a2[m] * f
        h_y, h_xy = h_y + a[m] * f_y, h_xy + a1[m] * f_y
        h_yy += a[m] * _across(knots, i + m, j, b2)
    dx, dy = piece[3], piece[4]
    return h, h_x / dx, h_y / dy, h_xx / (dx * dx), h_xy / (dx * dy), h_yy / (dy * dy)


@compiled
def is_beside(piece: FloatArray, knots: FloatArray, x: float, y: float) -> bool:
    """Whether the point (x, y) [m] lies beside a height field."""
    if int(piece[0]) != HEIGHT_FIELD:
        return False
    u, v = (x - piece[1]) / piece[3], (y - piece[2]) / piece[4]
    return bool(min(u, v) < -1e-9 or u > knots.shape[0] - 3 + 1e-9 or v > knots.shape[1] - 3 + 1e-9)


@compiled
def _cell(u: float, knots: int) -> int:
    """Cell of a place in grid units."""
    return max(0, min(knots - 4, math.floor(u)))


@compiled
def _across(knots: FloatArray, i: int, j: int, w: Four) -> float:
    """Weighted sum of four knots of a row."""
    return float(knots[i, j] * w[0] + knots[i, j + 1] * w[1] + knots[i, j + 2] * w[2] + knots[i, j + 3] * w[3])


@compiled
def _value_weights(t: float) -> Four:
    """Weights of the four knots around a cell (Keys 1981, eq. 4 with a = -1/2)."""
    return (
        0.5 * t * ((2.0 - t) * t - 1.0),
        0.5 * ((3.0 * t - 5.0) * t * t + 2.0),
        0.5 * t * ((4.0 - 3.0 * t) * t + 1.0),
        0.5 * t * t * (t - 1.0),
    )


@compiled
def _slope_weights(t: float) -> Four:
    """Their first derivatives."""
    return (
        0.5 * ((4.0 - 3.0 * t) * t - 1.0),
        0.5 * t * (9.0 * t - 10.0),
        0.5 * ((8.0 - 9.0 * t) * t + 1.0),
        0.5 * t * (3.0 * t - 2.0),
    )


@compiled
def _bend_weights(t: float) -> Four:
    """Their second derivatives."""
    return 2.0 - 3.0 * t, 9.0 * t - 5.0, 4.0 - 9.0 * t, 3.0 * t - 1.0
