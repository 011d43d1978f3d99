"""Distance of a wheel's centre from planes, steps and half-rounds, in the wheel's plane; compiled.

All three are convex. The distance of a point from a convex body is the largest of its distances from the body's tangent
planes; within the wheel's plane (unit normal e, the axle) the distance from the plane with the normal n is divided by
the cosine of the camber against it, q = sqrt(1 - (n . e)^2). A rounded edge of radius r has the normals
n(psi) = cos psi d + sin psi z, d the horizontal direction across the edge, so that with the centre at (a, b) from the
edge's axis

    phi = max over psi of (a cos psi + b sin psi - r) / q(psi),

in closed form for a wheel that drives at right angles to the edge, else by Newton. The edge's ends psi are its
adjoining planes: the face and the top of a step, the two sides of a half-round. Faces may be upright, edges higher than
the axle, and phi < 0 within the body.

On the rounding psi moves with the hub and with the axle. There the residual R = dphi/dpsi q^3 stays zero, so that

    dpsi = -(R_a da + R_b db + R_e . de) / R_psi,

and the contact turns in the wheel's plane, about the axle, by e . (d x z) / q^2 dpsi: not at all as the hub goes along
the edge.

Verified by tests/unit/test_brush_contact.py and tests/unit/test_wheel_potential.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import PieceKind
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, dot

__all__ = ["STILL", "Facing", "convex_distance", "facing"]

FloatArray = NDArray[np.float64]
type Facing = tuple[float, Vector, float, tuple[Vector, Vector]]
PLANE, CORNER = int(PieceKind.PLANE), int(PieceKind.CORNER)
ITERATIONS, TOLERANCE, FLATTEST = 20, 1e-12, 1e-6
STILL = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
"""Of a contact whose normal stays: that of a plane."""


@compiled
def convex_distance(piece: FloatArray, p: Vector, e: Vector) -> Facing:
    """Distance phi [m] in the wheel's plane, unit normal n of the piece at the closest point, n . e, and how n turns.

    The last are the gradients of the angle by which the contact turns about the axle because its normal does: over the
    hub's way [rad/m] and over its rotation [-]. They are zero over a plane.

    Parameters
    ----------
    piece : (7,) float, a plane, corner or half-round, see `contracts.terrain.PieceKind`
    p : wheel centre [m]
    e : unit vector of the axle
    """
    if int(piece[0]) == PLANE:
        n = piece[1], piece[2], piece[3]
        return facing(dot(n, p) - piece[4], n, e, STILL)
    c, s, r = piece[1], piece[2], piece[5]
    a, b, tilt = c * p[0] + s * p[1] - piece[3], p[2] - piece[4], (c * e[0] + s * e[1], e[2])
    first = 0.0
    if int(piece[0]) == CORNER:
        a, b, first = a - r, b + r, 0.5 * math.pi
    psi, turning = _best_angle(a, b, r, tilt), STILL
    if first <= psi <= math.pi:
        turning = _turning(psi, (a, b, r), (c, s), e)
    else:
        psi = math.pi if _distance(math.pi, a, b, r, tilt) > _distance(first, a, b, r, tilt) else first
    n = c * math.cos(psi), s * math.cos(psi), math.sin(psi)
    return facing(a * math.cos(psi) + b * math.sin(psi) - r, n, e, turning)


@compiled
def facing(gap: float, n: Vector, e: Vector, turning: tuple[Vector, Vector]) -> Facing:
    """From the gap [m] along a unit normal n to that in the wheel's plane; with n, n . e [-] and how it turns."""
    tilt = dot(n, e)
    q = max(math.sqrt(max(1.0 - tilt * tilt, 0.0)), FLATTEST)
    return gap / q, n, tilt, turning


@compiled
def _turning(psi: float, at: tuple[float, float, float], d: tuple[float, float], e: Vector) -> tuple[Vector, Vector]:
    """Gradients of the contact's turn about the axle over the hub's way [rad/m] and its rotation [-].

    Parameters
    ----------
    psi : angle of the normal [rad]
    at : a, b and the edge's radius r [m]
    d : horizontal direction across the edge
    e : unit vector of the axle
    """
    cosine, sine = math.cos(psi), math.sin(psi)
    n, across = (d[0] * cosine, d[1] * cosine, sine), (-d[0] * sine, -d[1] * sine, cosine)
    w, turn = dot(n, e), dot(across, e)
    rest = max(1.0 - w * w, FLATTEST)
    D, slope = at[0] * cosine + at[1] * sine - at[2], at[1] * cosine - at[0] * sine
    tangent = -(D + at[2]) * rest - slope * w * turn + D * (turn * turn - w * w)
    by_psi = (e[0] * d[1] - e[1] * d[0]) / rest / min(tangent, -FLATTEST)
    over_a, over_b = -sine * rest + cosine * w * turn, cosine * rest + sine * w * turn
    way = (-by_psi * over_a * d[0], -by_psi * over_a * d[1], -by_psi * over_b)
    over_e = along((0.0, 0.0, 0.0), D * turn - 2.0 * w * slope, n)
    return way, along((0.0, 0.0, 0.0), -by_psi, cross(e, along(over_e, D * w, across)))


@compiled
def _distance(psi: float, a: float, b: float, r: float, tilt: tuple[float, float]) -> float:
    """Distance from the tangent plane at psi, in the wheel's plane."""
    w = tilt[0] * math.cos(psi) + tilt[1] * math.sin(psi)
    return (a * math.cos(psi) + b * math.sin(psi) - r) / max(math.sqrt(max(1.0 - w * w, 0.0)), FLATTEST)


@compiled
def _best_angle(a: float, b: float, r: float, tilt: tuple[float, float]) -> float:
    """Angle psi of the largest distance on the full circle: a sharp edge's, then Newton for the rounding."""
    c, s = tilt
    lean = (c * a + s * b) / max(1.0 - c * c - s * s, FLATTEST)
    psi = math.atan2(b + s * lean, a + c * lean)
    if r == 0.0 or c * c + s * s < TOLERANCE:
        return psi
    for _ in range(ITERATIONS):
        cosine, sine = math.cos(psi), math.sin(psi)
        D, slope = a * cosine + b * sine - r, b * cosine - a * sine
        w, turn = c * cosine + s * sine, s * cosine - c * sine
        residual = slope * (1.0 - w * w) + D * w * turn
        tangent = -(D + r) * (1.0 - w * w) - slope * w * turn + D * (turn * turn - w * w)
        step = residual / tangent if tangent < 0.0 else -0.1 * math.copysign(1.0, residual)
        psi -= max(-0.2, min(0.2, step))
        if abs(step) < TOLERANCE:
            break
    return psi
