"""Derivatives of the brush tires' wrenches and state rates for implicit integration, in one compiled call.

Central differences inside the loop, with the steps chosen in `STEPS`: of second order in a step far below every length
and speed of the laws, rounding about 1e-8 of the largest entry. Contacts are sought again for the hub's position and
rotation only. The laws are continuous and piecewise smooth: at a kink (first touch, sliding sets in, no speed of
transport) the difference lies between the two one-sided derivatives.

Verified by tests/unit/test_brush_derivatives.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import TerrainPieces
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, over_length, vector
from rover_dynamics.tires.brush_contact import find_contacts
from rover_dynamics.tires.brush_force import (
    BrushResult,
    BrushScratch,
    HubMotions,
    brush_result,
    contact_size,
    hub_axes,
    wheel_answer,
)
from rover_dynamics.tires.brush_settings import WheelNumbers

__all__ = ["STEPS", "brush_derivatives", "derivative_result"]

FloatArray = NDArray[np.float64]
STEPS = (1e-7, 1e-7, 1e-7, 1e-6, 1e-9)
"""Steps for position [m], rotation [rad], velocity [m/s], angular velocity [rad/s] and state [m]."""
MOTION = 12
"""Columns before those of the state."""


def derivative_result(terrain: TerrainPieces) -> BrushResult:
    """Working memory for the two sides of a difference."""
    return brush_result(2, terrain)


@compiled
def brush_derivatives(
    motions: HubMotions,
    state: FloatArray,
    numbers: WheelNumbers,
    terrain: TerrainPieces,
    jacobian: FloatArray,
    scratch: tuple[BrushScratch, BrushResult],
) -> None:
    """Fill the derivatives of every wheel's wrench and state rate; allocates nothing.

    Parameters
    ----------
    motions, state, numbers, terrain : as for `rover_dynamics.tires.brush_force.brush_forces`; the state is left as it
        was
    jacobian : (n, 6 + s, 12 + s) float, s = 2 n_pieces, written: rows wrench and state rate; columns hub position,
        small rotation theta (R becomes exp(theta x) R, world), velocity, angular velocity, state
    scratch : of `brush_scratch` and `derivative_result`
    """
    work, pair = scratch
    for i in range(motions.position.shape[0]):
        p, v, omega = vector(motions.position[i]), vector(motions.velocity[i]), vector(motions.angular_velocity[i])
        e, ahead = hub_axes(motions.rotation[i])
        for column in range(2 * 3):
            for side in range(2):
                step = STEPS[column // 3] * (1.0 - 2.0 * side)
                moved_p = _shifted(p, column, step)
                moved_e, moved_ahead = _turned(e, column - 3, step), _turned(ahead, column - 3, step)
                find_contacts(moved_p, moved_e, contact_size(numbers), terrain, work.contacts, work.samples)
                wheel_answer((moved_e, v, omega, moved_ahead), state[i], numbers, work.contacts, pair, side)
            _difference(pair, jacobian[i], column, STEPS[column // 3])
        find_contacts(p, e, contact_size(numbers), terrain, work.contacts, work.samples)
        for column in range(2 * 3, MOTION):
            for side in range(2):
                step = STEPS[column // 3] * (1.0 - 2.0 * side)
                moved_v, moved_omega = (_shifted(v, column - 6, step), _shifted(omega, column - 9, step))
                wheel_answer((e, moved_v, moved_omega, ahead), state[i], numbers, work.contacts, pair, side)
            _difference(pair, jacobian[i], column, STEPS[column // 3])
        _by_state((e, v, omega, ahead), state[i], numbers, jacobian[i], work, pair)


@compiled
def _by_state(
    motion: tuple[Vector, Vector, Vector, Vector],
    state: FloatArray,
    numbers: WheelNumbers,
    jacobian: FloatArray,
    work: BrushScratch,
    pair: BrushResult,
) -> None:
    """Columns of the state."""
    for m in range(state.shape[0]):
        kept = state[m]
        for side in range(2):
            state[m] = kept + STEPS[4] * (1.0 - 2.0 * side)
            wheel_answer(motion, state, numbers, work.contacts, pair, side)
        state[m] = kept
        _difference(pair, jacobian, MOTION + m, STEPS[4])


@compiled
def _turned(axis: Vector, m: int, step: float) -> Vector:
    """A unit vector after a small rotation about world axis m, unchanged for another m."""
    return over_length(along(axis, 1.0, cross(_shifted((0.0, 0.0, 0.0), m, math.tan(step)), axis)))


@compiled
def _shifted(a: Vector, m: int, step: float) -> Vector:
    """A vector with its component m moved, unchanged for another m."""
    return (
        a[0] + (step if m == 0 else 0.0),
        a[1] + (step if m == 1 else 0.0),
        a[2] + (step if m == 2 else 0.0),
    )


@compiled
def _difference(pair: BrushResult, jacobian: FloatArray, column: int, step: float) -> None:
    """One column from the two sides."""
    for m in range(6):
        jacobian[m, column] = (pair.wrench[0, m] - pair.wrench[1, m]) / (2.0 * step)
    for m in range(pair.rate.shape[1]):
        jacobian[6 + m, column] = (pair.rate[0, m] - pair.rate[1, m]) / (2.0 * step)
