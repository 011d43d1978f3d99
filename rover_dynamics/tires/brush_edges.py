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

Verified by tests/unit/test_brush_contact.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import PieceKind
from rover_dynamics.tires.brush_compiled import Vector, compiled, dot

__all__ = ["Facing", "convex_distance", "facing"]

FloatArray = NDArray[np.float64]
type Facing = tuple[float, Vector, float, float]
PLANE, CORNER = int(PieceKind.PLANE), int(PieceKind.CORNER)
ITERATIONS, TOLERANCE, FLATTEST = 20, 1e-12, 1e-6


@compiled
def convex_distance(piece: FloatArray, p: Vector, e: Vector) -> Facing:
    """Distance phi [m] in the wheel's plane, unit normal n of the piece at the closest point, n . e, and how n turns.

    The last is the angle by which the contact turns about the hub as that moves along the ground [rad/m]: none over a
    plane, one over the distance from the axis of an edge or rock.

    Parameters
    ----------
    piece : (7,) float, a plane, corner or half-round, see `contracts.terrain.PieceKind`
    p : wheel centre [m]
    e : unit vector of the axle
    """
    if int(piece[0]) == PLANE:
        n = piece[1], piece[2], piece[3]
        return facing(dot(n, p) - piece[4], n, e, 0.0)
    c, s, r = piece[1], piece[2], piece[5]
    a, b, tilt = c * p[0] + s * p[1] - piece[3], p[2] - piece[4], (c * e[0] + s * e[1], e[2])
    first = 0.0
    if int(piece[0]) == CORNER:
        a, b, first = a - r, b + r, 0.5 * math.pi
    psi, turning = _best_angle(a, b, r, tilt), 1.0
    if not first <= psi <= math.pi:
        psi = math.pi if _distance(math.pi, a, b, r, tilt) > _distance(first, a, b, r, tilt) else first
        turning = 0.0
    n = c * math.cos(psi), s * math.cos(psi), math.sin(psi)
    reach = a * math.cos(psi) + b * math.sin(psi)
    return facing(reach - r, n, e, turning / max(reach, FLATTEST))


@compiled
def facing(gap: float, n: Vector, e: Vector, turning: float) -> Facing:
    """From gap [m] and turning [rad/m] along a unit normal n to those in the wheel's plane; with n, and n . e [-]."""
    tilt = dot(n, e)
    q = max(math.sqrt(max(1.0 - tilt * tilt, 0.0)), FLATTEST)
    return gap / q, n, tilt, turning * q


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
