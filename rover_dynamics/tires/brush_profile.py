"""Contact of a wheel with a sinusoid or a height field: what frees its rigid rim from the profile; compiled.

The profile is the section of the ground with the wheel's plane, x forward and y up from the wheel's centre. Ground may
touch the rim at several places, and penetration is not small against the radius. Of all displacements D of the rim that
free it from the profile, to first order

    D . u_k >= delta_k = R - d_k    for every point k of the profile, at the distance d_k in the direction -u_k,

the shortest one gives the contact: deflection |D| along D. With one place of contact it is the closest point's
deflection; a rim between two rocks rests on both; and D changes continuously where places of contact come and go. The
camber against the ground is that of the resultant, tan gamma = sum lambda_k tan gamma_k / |D|, D = sum lambda_k u_k.
The closest point is found by Newton, the others are samples across the wheel (9 mm apart), left where they are: a
second place of contact is met to about half a millimetre.

Verified by tests/unit/test_brush_contact.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, dot, hypotenuse, over_length
from rover_dynamics.tires.brush_edges import STILL, Facing
from rover_dynamics.tires.brush_graph import Graph, graph, graph_height

__all__ = ["SAMPLES", "profile_distance"]

FloatArray = NDArray[np.float64]
type Pair = tuple[float, float]
type Section = tuple[Vector, Vector, Vector, Vector]
SAMPLES = 33
"""Points of the profile across the wheel; the first row of the scratch holds the closest point."""
ITERATIONS, LEVEL, UPRIGHT, TOLERANCE, SLACK = 8, 0.1, 1e-9, 1e-11, 1e-3


@compiled
def profile_distance(
    piece: FloatArray, knots: FloatArray, p: Vector, e: Vector, radius: float, scratch: FloatArray
) -> Facing:
    """Distance phi = R - |D| [m], unit normal n of the ground in the contact, n . e, `STILL`: it is taken as a plane.

    Parameters
    ----------
    piece, knots : a sinusoid or height field, see `contracts.terrain`
    p, e : wheel centre [m] and unit vector of the axle
    radius : R [m]
    scratch : (34, 4) float: u_x, u_y, delta, x of each point
    """
    level = hypotenuse(e[0], e[1])
    if level < LEVEL:  # the wheel lies on its side
        return 2.0 * radius, (0.0, 0.0, 1.0), e[2], STILL
    f = e[1] / level, -e[0] / level, 0.0
    section = p, f, cross(f, e), e
    best = _sample(piece, knots, section, radius, scratch)
    tilt = _closest(piece, knots, section, radius, scratch, best)
    size = scratch[0, 2]
    x, y = scratch[0, 0], scratch[0, 1]
    if size > 0.0:
        D, first, second = _freeing((size * x, size * y), scratch)
        if first != 0:
            own = _tangent(_tilt(piece, knots, section, radius, scratch[first]))
            other = _tangent(tilt if second == 0 else _tilt(piece, knots, section, radius, scratch[second]))
            shares = _shares(D, scratch[first], scratch[second])
            tilt = _sine(shares[0] * own + shares[1] * other)
        size = hypotenuse(D[0], D[1])
        x, y = D[0] / size, D[1] / size
    q, g = math.sqrt(max(1.0 - tilt * tilt, 0.0)), section[2]
    n = q * (x * f[0] + y * g[0]), q * (x * f[1] + y * g[1]), q * y * g[2]
    return radius - size, along(n, tilt, e), tilt, STILL


@compiled
def _sample(piece: FloatArray, knots: FloatArray, section: Section, radius: float, scratch: FloatArray) -> int:
    """Fill rows 1.. of the scratch, delta = -1 where the rim is free; the row of the largest deflection."""
    best, nearest, height, (p, f, g, _) = 1, 1e300, 0.0, section
    upright = hypotenuse(g[0], g[1]) < UPRIGHT
    for k in range(1, SAMPLES + 1):
        x = radius * (2.0 * (k - 1) / (SAMPLES - 1) - 1.0)
        at = along(along(p, x, f), -math.sqrt(max(radius * radius - x * x, 0.0)), g)
        y = (graph_height(piece, knots, at[0], at[1]) - p[2]) / g[2]
        if not upright:  # the place below the rim is not that on the ground
            at = along(along(p, x, f), y, g)
            y = (graph_height(piece, knots, at[0], at[1]) - p[2]) / g[2]
        if x != 0.0:
            y = min(y, 0.0)  # below its top the ground is solid: at the axle's height stands its face
        square = x * x + y * y if y <= 0.0 else -y * y
        scratch[k, 2], scratch[k, 3] = -1.0, x
        if square < radius * radius:
            _put(scratch[k], x, y, radius)
        if square < nearest:
            best, nearest, height = k, square, y
    _put(scratch[best], scratch[best, 3], height, radius)
    return best


@compiled
def _put(row: FloatArray, x: float, y: float, radius: float) -> None:
    """A point of the profile as a row of the scratch."""
    distance = max(hypotenuse(x, y), 1e-9) * (1.0 if y <= 0.0 else -1.0)
    row[0], row[1], row[2], row[3] = -x / distance, -y / distance, radius - distance, x


@compiled
def _closest(
    piece: FloatArray, knots: FloatArray, section: Section, radius: float, scratch: FloatArray, best: int
) -> float:
    """Row 0 of the scratch: the closest point by Newton from the best sample, or that sample if it fails; its n . e."""
    start, (p, f, g, e) = scratch[best], section
    for m in range(4):
        scratch[0, m] = start[m]
    spacing, x, y, tilt = 2.0 * radius / (SAMPLES - 1), start[3], -start[1] * (radius - start[2]), 0.0
    for _ in range(ITERATIONS):
        at = along(along(p, x, f), y, g)
        z = graph(piece, knots, at[0], at[1])
        tilt = dot(over_length((-z[1], -z[2], 1.0)), e)
        w = max(g[2] - z[1] * g[0] - z[2] * g[1], 0.1)
        slope, off = (z[1] * f[0] + z[2] * f[1]) / w, (at[2] - z[0]) / w
        y -= off
        step = -(x + y * slope) / max(1.0 + slope * slope + y * _bend(z, f, g, slope) / w, 0.1)
        if abs(step) < TOLERANCE and abs(off) < TOLERANCE:
            break
        step = max(-spacing, min(spacing, step))
        x, y = x + step, y + slope * step
    distance = hypotenuse(x, y)
    if y < 0.0 and abs(x - start[3]) <= 2.0 * spacing and radius - distance >= start[2] - SLACK:
        _put(scratch[0], x, y, radius)
        return tilt
    return _tilt(piece, knots, section, radius, start)


@compiled
def _tilt(piece: FloatArray, knots: FloatArray, section: Section, radius: float, row: FloatArray) -> float:
    """n . e at a sample."""
    p, f, g, e = section
    at = along(along(p, row[3], f), -math.sqrt(max(radius * radius - row[3] * row[3], 0.0)), g)
    z = graph(piece, knots, at[0], at[1])
    return dot(over_length((-z[1], -z[2], 1.0)), e)


@compiled
def _bend(z: Graph, f: Vector, g: Vector, slope: float) -> float:
    """Second derivative of the height along the profile."""
    t = f[0] + slope * g[0], f[1] + slope * g[1]
    return z[3] * t[0] * t[0] + 2.0 * z[4] * t[0] * t[1] + z[5] * t[1] * t[1]


@compiled
def _freeing(D: Pair, scratch: FloatArray) -> tuple[Pair, int, int]:
    """Shortest D with D . u_k >= delta_k, and the two rows that hold it; one row twice where it holds D alone.

    One constraint after the other (Seidel 1991): where row k is violated, D lies on its line,
    D = delta_k u_k + t (-u_ky, u_kx), with t as near to zero as the rows before k allow. The row that keeps t from zero
    is the other one: D is a sum of both directions with shares >= 0.
    """
    first, second = 0, 0
    for k in range(1, SAMPLES + 1):
        a, b, deflection = scratch[k, 0], scratch[k, 1], scratch[k, 2]
        if deflection <= 0.0 or D[0] * a + D[1] * b >= deflection - TOLERANCE:
            continue
        low, high, below, above = -1e3, 1e3, k, k
        for j in range(k):
            if scratch[j, 2] > 0.0:
                turn = scratch[j, 1] * a - scratch[j, 0] * b
                need = scratch[j, 2] - deflection * (scratch[j, 0] * a + scratch[j, 1] * b)
                if turn > 1e-9 and need / turn > low:
                    low, below = need / turn, j
                elif turn < -1e-9 and need / turn < high:
                    high, above = need / turn, j
        t = max(low, min(high, 0.0)) if low <= high else 0.5 * (low + high)
        first, second = k, k if low > high or t == 0.0 else below if t == low else above
        D = deflection * a - t * b, deflection * b + t * a
    return D, first, second


@compiled
def _shares(D: Pair, a: FloatArray, b: FloatArray) -> Pair:
    """Components of D along two directions over its length, not below zero."""
    det = a[0] * b[1] - a[1] * b[0]
    if abs(det) < 1e-9:
        return 1.0, 0.0
    first, other = max((D[0] * b[1] - D[1] * b[0]) / det, 0.0), max((D[1] * a[0] - D[0] * a[1]) / det, 0.0)
    size = max(hypotenuse(D[0], D[1]), 1e-12)
    return first / size, other / size


@compiled
def _tangent(sine: float) -> float:
    """Tangent of an angle from its sine."""
    return sine / math.sqrt(max(1.0 - sine * sine, 1e-6))


@compiled
def _sine(tangent: float) -> float:
    """Sine of an angle from its tangent."""
    return tangent / math.sqrt(1.0 + tangent * tangent)
