"""One wheel that is driven over a soil's cells at a slip, each step at rest under its load."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.soil.cells import keep_step, soil_derivatives, soil_forces
from rover_dynamics.soil.field import SoilBed, SoilGround
from rover_dynamics.tires.brush_force import BrushResult, HubMotions, empty_result

FloatArray = NDArray[np.float64]
SPEED = 0.02
"""Of the hub ahead [m/s]."""


class Drive(NamedTuple):
    """Way, height of the hub, pull, torque and side force at each step; the ground and the wheel at the end."""

    way: FloatArray
    height: FloatArray
    pull: FloatArray
    torque: FloatArray
    aside: FloatArray
    ground: SoilGround
    state: FloatArray


def moving(
    place: tuple[float, float, float], heading: float, spin: float, velocity: tuple[float, float, float]
) -> HubMotions:
    """A wheel at a place that rolls towards a heading [rad]."""
    c, s = np.cos(heading), np.sin(heading)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return HubMotions(np.array([place]), R[None].copy(), np.array([velocity]), spin * R[None, :, 1].copy())


def turned(hub: HubMotions, R: FloatArray) -> HubMotions:
    """The same wheel turned about the origin."""
    return HubMotions(
        hub.position @ R.T, (R @ hub.rotation[0])[None].copy(), hub.velocity @ R.T, hub.angular_velocity @ R.T
    )


def driven(
    bed: SoilBed,
    slip: float,
    *,
    way: float = 0.35,
    heading: float = 0.0,
    drift: float = 0.0,
    start: tuple[float, float] = (0.0, 0.0),
    ground: SoilGround | None = None,
    turn: FloatArray | None = None,
) -> Drive:
    """Drive a wheel; ``drift`` is its speed to the left over that ahead [-], ``ground`` one that was driven on.

    With ``turn`` (3, 3) the ground is level ground turned about the origin, and so is the wheel; what is told
    is told in axes that turn with it.
    """
    ground = bed.ground(1) if ground is None else ground
    states, load = ground.states, bed.load
    height, state = bed.standing()[0], bed.standing()[1][None].copy()
    state[0, -2:] = max(slip, 0.0), 1.0
    found, pair, D = empty_result(1, states), empty_result(2, states), np.zeros((1, 6 + states, 12 + states))
    step, free = bed.cell / 8.0, states - 2
    spin = SPEED / (1.0 - slip) / bed.wheel.radius
    ahead, left = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
    ground.field.clock[0] = step / SPEED
    rows = []
    for k in range(1, round(way / step) + 1):
        x, y = np.array(start) + k * step * (ahead + drift * left)
        for _ in range(60):
            hub = moving((x, y, height), heading, spin, (*(SPEED * (ahead + drift * left)), 0.0))
            if turn is not None:
                hub = turned(hub, turn)
            soil_forces(hub, state, ground, found)
            if turn is not None:
                found.wrench[0] = np.concatenate([turn.T @ found.wrench[0, :3], turn.T @ found.wrench[0, 3:]])
            residual = np.concatenate([[found.wrench[0, 2] - load], found.rate[0, :free]])
            if abs(residual[0]) < 1e-6 * load and np.abs(residual[1:]).max() * bed.settling < 1e-9:
                break
            if found.wrench[0, 2] == 0.0:  # over a rut
                height -= 5e-4
                continue
            soil_derivatives(hub, state, ground, D, pair)
            if turn is not None:
                D[0, :3] = turn.T @ D[0, :3]
                D[0, :, :3] = D[0, :, :3] @ turn
            rows_of, columns = [2, *range(6, 6 + free)], [2, *range(12, 12 + free)]
            change = -np.linalg.solve(D[0][np.ix_(rows_of, columns)], residual)
            change *= min(1.0, 0.003 / np.abs(change).max())
            height += change[0]
            state[0, :free] += change[1:]
        keep_step(hub, state, ground, found)
        force, moment = found.wrench[0, :3], found.wrench[0, 3:]
        if turn is not None:
            force, moment = turn.T @ force, turn.T @ moment
        rows.append((k * step, height, force[:2] @ ahead, -moment[:2] @ left, force[:2] @ left))
    ground.field.clock[0] = 0.0
    return Drive(*np.array(rows).T, ground, state[0])


def answer(bed: SoilBed, ground: SoilGround, hub: HubMotions, state: FloatArray) -> BrushResult:
    """What a wheel feels."""
    found = empty_result(1, ground.states)
    soil_forces(hub, state[None].copy(), ground, found)
    return found
