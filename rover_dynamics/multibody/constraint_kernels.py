"""Constraint equations of joints and drives, their Jacobian and the terms quadratic in the velocities, compiled.

Two primitives make every joint: the origin of the second frame does not leave the first along one of its axes a,
C = a . d, and an axis a of the first frame stays at right angles to an axis b of the second, C = a . b (2.24). A driven
angle adds C = angle - law(t). With velocities u = (v, w) of both bodies in world axes, C_u u = -C_t and
C_u u' = Q_c (2.25). Verified by tests/unit/test_multibody_constraints.py.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled, cross

__all__ = ["ConstraintTable", "Row", "constraint_rows"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Row(IntEnum):
    """Kinds of constraint equations."""

    TRANSLATION = 0
    RIGHT_ANGLE = 1
    ANGLE = 2


class ConstraintTable(NamedTuple):
    """All m constraint equations as arrays.

    Attributes
    ----------
    kinds : (m,) int, see `Row`
    axes : (m, 2) int, axis of the first frame, and of the second
    bodies : (m, 2) int, rows of the bodies; -1 for the ground
    points : (m, 2, 3) float, origins of the frames from the centres of mass, body axes [m]
    frames : (m, 2, 3, 3) float, axes of the frames in body axes
    """

    kinds: IntArray
    axes: IntArray
    bodies: IntArray
    points: FloatArray
    frames: FloatArray


_TRANSLATION, _RIGHT_ANGLE = int(Row.TRANSLATION), int(Row.RIGHT_ANGLE)


@compiled
def constraint_rows(
    table: ConstraintTable, r: FloatArray, R: FloatArray, u: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Defects without the drives' laws, Jacobian blocks, and right-hand sides of the accelerations.

    Parameters
    ----------
    table : the equations
    r, R, u : (n + 1, 3), (n + 1, 3, 3), (n + 1, 6) float, positions, rotations and velocities; the last row is the
        ground's

    Returns
    -------
    C : (m,) float [m or -]; for an angle the angle itself, in (-pi, pi] [rad]
    C_u : (m, 2, 6) float, by the velocities of the first and of the second body
    Q_c : (m,) float, minus the terms of the second time derivative that are quadratic in the velocities
    """
    m = len(table.kinds)
    C, C_u, Q_c = np.empty(m), np.empty((m, 2, 6)), np.empty(m)
    work = np.empty((8, 3))
    for k in range(m):
        P, Q = table.bodies[k]
        A, B = R[P] @ table.frames[k, 0], R[Q] @ table.frames[k, 1]
        i, j = table.axes[k]
        if table.kinds[k] == _TRANSLATION:
            s_P, s_Q = R[P] @ table.points[k, 0], R[Q] @ table.points[k, 1]
            d = r[Q] + s_Q - r[P] - s_P
            C[k], Q_c[k] = _translation(A[:, i].copy(), d, (s_P, s_Q), (u[P], u[Q]), work, C_u[k])
        elif table.kinds[k] == _RIGHT_ANGLE:
            C[k], Q_c[k] = _right_angle(A[:, i].copy(), B[:, j].copy(), u[P], u[Q], work, C_u[k])
        else:
            x = B[:, 0].copy()
            C[k] = np.arctan2(np.dot(A[:, 1].copy(), x), np.dot(A[:, 0].copy(), x))
            Q_c[k] = _angle(A[:, 2].copy(), u[P], u[Q], work, C_u[k])
    return C, C_u, Q_c


@compiled
def _translation(
    a: FloatArray,
    d: FloatArray,
    arms: tuple[FloatArray, FloatArray],
    motions: tuple[FloatArray, FloatArray],
    work: FloatArray,
    C_u: FloatArray,
) -> tuple[float, float]:
    """C = a . d, with a fixed to P and d between two points with the arms s on P and Q, which move with u."""
    (s_P, s_Q), (u_P, u_Q) = arms, motions
    turn_P, turn_Q, rate_a, second_a = work[0], work[1], work[2], work[3]
    centripetal_P, centripetal_Q, moment = work[4], work[5], work[6]
    w_P, w_Q = u_P[3:], u_Q[3:]
    cross(w_P, s_P, turn_P)
    cross(w_Q, s_Q, turn_Q)
    cross(w_P, turn_P, centripetal_P)
    cross(w_Q, turn_Q, centripetal_Q)
    cross(w_P, a, rate_a)
    cross(w_P, rate_a, second_a)
    quadratic = 0.0
    for n in range(3):
        rate_d = u_Q[n] + turn_Q[n] - u_P[n] - turn_P[n]
        quadratic += a[n] * (centripetal_Q[n] - centripetal_P[n]) + 2.0 * rate_a[n] * rate_d + second_a[n] * d[n]
        C_u[0, n], C_u[1, n] = -a[n], a[n]
        moment[n] = d[n] + s_P[n]
    cross(a, moment, C_u[0, 3:])
    cross(s_Q, a, C_u[1, 3:])
    return float(np.dot(a, d)), -quadratic


@compiled
def _right_angle(
    a: FloatArray, b: FloatArray, u_P: FloatArray, u_Q: FloatArray, work: FloatArray, C_u: FloatArray
) -> tuple[float, float]:
    """C = a . b, with a fixed to P and b to Q."""
    rate_a, rate_b, second_a, second_b = work[0], work[1], work[2], work[3]
    w_P, w_Q = u_P[3:], u_Q[3:]
    cross(w_P, a, rate_a)
    cross(w_Q, b, rate_b)
    cross(w_P, rate_a, second_a)
    cross(w_Q, rate_b, second_b)
    quadratic = np.dot(second_a, b) + 2.0 * np.dot(rate_a, rate_b) + np.dot(a, second_b)
    C_u[:, :3] = 0.0
    cross(a, b, C_u[0, 3:])
    cross(b, a, C_u[1, 3:])
    return float(np.dot(a, b)), -quadratic


@compiled
def _angle(a: FloatArray, u_P: FloatArray, u_Q: FloatArray, work: FloatArray, C_u: FloatArray) -> float:
    """Relative angle about a, fixed to P: its rate is a . (w_Q - w_P)."""
    rate_a = work[0]
    cross(u_P[3:], a, rate_a)
    C_u[:, :3] = 0.0
    quadratic = 0.0
    for n in range(3):
        C_u[0, 3 + n], C_u[1, 3 + n] = -a[n], a[n]
        quadratic += rate_a[n] * (u_Q[3 + n] - u_P[3 + n])
    return -quadratic
