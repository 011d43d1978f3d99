"""Where a wheel's motion begins: standing under its weight, or at rest above level ground.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.static import Equilibrium, Mixed, press
from ancf_reduced.wheel_motion.bordered import HUB
from ancf_reduced.wheel_motion.newton import Factored
from ancf_reduced.wheel_motion.rolling import Motion, RollingWheel
from contracts.errors import ConvergenceError, InputError

__all__ = ["above", "standing"]

Array = NDArray[np.float64]
_INCREMENT = 5e-3
_TRIES = 30
_CLOSE = 1e-4
"""Difference of load and weight from which the whole wheel is settled [-]."""


def above(rolling: RollingWheel, height: float) -> Motion:
    """Undeformed and at rest with x = 0, at a height [m] above first touch, on the orientation of the problem."""
    if not (np.isfinite(height) and height >= 0.0):
        raise InputError("height", f"{height:g} m", "must be finite and >= 0", "0 is first touch")
    zeros = np.zeros(rolling.basis.shape[1]), np.zeros(sum(rolling.problem.counts))
    return _still(rolling, zeros, -height)


def standing(rolling: RollingWheel, tolerance: float = 1e-9) -> Motion:
    """In equilibrium under the weight of hub and plates with x = 0, held on the orientation of the problem.

    tolerance : of places, over the deflection [-]

    Raises
    ------
    InputError
        For a wheel that its weight would press onto the hub.
    ConvergenceError
        If statics finds no equilibrium on the way.
    """
    problem, weight = rolling.problem, rolling.mass * rolling.gravity
    if not weight > 0.0:
        raise InputError("gravity", f"{rolling.gravity:g} m/s^2", "must be > 0 for a wheel that stands", "")
    low, high = problem.unloaded(), problem.unloaded()
    room = -float(problem.ground.risen(0.0)[1][2]) - problem.wheel.hub[0]
    deflections = np.arange(_INCREMENT, room, _INCREMENT)
    for high in press(problem, deflections.tolist()):
        if high.load >= weight:
            break
        low = high
    if high.load < weight:
        told = f"{rolling.hub.mass:g} kg"
        rule = f"presses the wheel by more than {1e3 * high.deflection:.4g} mm, where it bears {high.load:.4g} N"
        raise InputError("hub mass", told, rule, "take a lighter rover")
    for k in range(_TRIES):
        share = 0.5 if k % 4 == 3 else (weight - low.load) / (high.load - low.load)
        goal = low.deflection + share * (high.deflection - low.deflection)
        found = problem.solve(goal, low if share < 0.5 else high)
        if not isinstance(found, Equilibrium):
            raise ConvergenceError(f"no equilibrium found at {1e3 * goal:.4g} mm", [], low)
        if abs(found.load - weight) < _CLOSE * weight:
            return _settled(rolling, found, tolerance)
        low, high = (found, high) if found.load < weight else (low, found)
    raise ConvergenceError(f"weight of {weight:.4g} N is not met", [], low)


def _settled(rolling: RollingWheel, near: Equilibrium, tolerance: float) -> Motion:
    """From the equilibrium of plates without weight to that of the whole."""
    problem = rolling.problem
    here = _still(rolling, (near.free, np.concatenate([near.pressed, near.inner])), near.deflection)
    mixed: Mixed = *problem.extrapolated(near.free, 0.0 * near.free), here.pressed
    for _ in range(_TRIES):
        found = rolling.linearised(here, mixed, rolling.damping(here.y))
        factored = Factored.of(found, mixed[2][found.system.near] > 0.0, (0.0, 0.0), (0, 2))
        done = None if factored is None else factored.step()
        if done is None:
            break
        step, forces = done
        pressed = np.zeros_like(here.pressed)
        pressed[found.system.near] = forces
        mixed = *problem.extrapolated(here.y[:-HUB], step[:-HUB]), pressed
        here = replace(here, y=here.y + step, pressed=pressed)
        if np.abs(problem.wheel.basis @ step[:-HUB]).reshape(-1, 4, 3)[:, 0].max() < tolerance * near.deflection:
            return here
    raise ConvergenceError("no equilibrium found under the weight of the plates", [], near)


def _still(rolling: RollingWheel, state: tuple[Array, Array], deflection: float) -> Motion:
    free, pressed = state
    _, origin = rolling.problem.ground.risen(deflection)
    still = np.zeros(rolling.size)
    y = np.concatenate([free, [0.0, -float(origin[2]), rolling.problem.orientation]])
    return Motion(time=0.0, y=y, v=still, a=still, pressed=pressed)
