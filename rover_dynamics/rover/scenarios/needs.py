"""What a requirement needs, and what ends a run that does not meet it.

The smallest torque of the drives and the smallest friction of the ground are found by bisection over whole runs, each
judged as its scenario judges it. Runs need not be monotone in either: what is found is a boundary, below which the next
run tried failed; where even `LEAST_FRICTION` is met, that is found, and nothing below is tried. Torques are those of
motors with a speed controller, no line and no loss (`rover_dynamics.vehicle.motors`).

Verified by tests/unit/test_rover_needs.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from rover_dynamics.rover.rover_design import RoverDesign, WheelDrive
from rover_dynamics.rover.scenarios.ground import on_friction
from rover_dynamics.rover.scenarios.level_ground import SPEED
from rover_dynamics.rover.scenarios.obstacles import clearances
from rover_dynamics.rover.scenarios.outcome import LEAST_FRICTION
from rover_dynamics.rover.scenarios.readings import STARTED
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.vehicle.motors import Motor, used_of_limits

__all__ = ["Cause", "Ending", "ending", "smallest_friction", "smallest_torque"]

Cause = Literal["friction", "drives", "stability", "clearance", "wheel", "computation"]
BoolArray = NDArray[np.bool_]
TORQUE_WIDTH, FRICTION_WIDTH = 0.02, 0.005
"""Of the search: share of the torque found; friction [-]."""
SPINS = 0.5
"""Slip speed over 70 m/h from which on a wheel counts as spinning or sliding [-]."""
AT_LIMIT = 0.999
"""Share of what limit and line allow from which on a drive counts as at its limit [-]."""
_FOLDS = "folds"
_DEEP = "its curves end"
_LEAN, _LOAD, _LOAD_AT_END = (
    "largest lean of the body",
    "smallest wheel load on the way",
    "smallest wheel load at the end",
)
_CLEARANCE = "lowest centre of a body over the ground"


@dataclass(frozen=True, slots=True, kw_only=True)
class Ending:
    """Why a run does not meet what is required, the time [s] of it, and the way ahead there [m]."""

    cause: Cause
    time: float
    way: float


def ending(run: ScenarioRun) -> Ending | None:
    """What ends a run that is not met, None for one that is.

    A motion that stopped ended by the wheel, where it folds or is pressed beyond its curves, else by the computation:
    either way its model says nothing beyond. Of one that came to its end the first that applies: the body leaned or a
    wheel lost its load further than is allowed, on the way or, with nothing else amiss, at the end (stability); a body
    came down to the ground (clearance); the drives stood at their torque limit (drives); wheels ran ahead of or behind
    the ground, or the rover did not get there (friction).
    """
    if run.met:
        return None
    times, way = run.motion.times, run.place[:, 0] - run.place[0, 0]

    def at(cause: Cause, seen: BoolArray) -> Ending:
        k = int(np.argmax(seen)) if seen.any() else len(times) - 1
        return Ending(cause=cause, time=float(times[k]), way=float(way[k]))

    nowhere = np.zeros(len(times), dtype=bool)
    if run.stopped is not None:
        return at("wheel" if _FOLDS in run.stopped or _DEEP in run.stopped else "computation", nowhere)
    missed = {one.quantity: one.limit for one in run.scenario.judge(run) if one.met is False and one.limit is not None}
    if _LEAN in missed:
        return at("stability", np.degrees(run.lean) > missed[_LEAN])
    if _LOAD in missed:
        return at("stability", run.loads.min(axis=1) < missed[_LOAD])
    if set(missed) == {_LOAD_AT_END}:
        return at("stability", nowhere)
    if _CLEARANCE in missed:
        return at("clearance", clearances(run) < missed[_CLEARANCE])
    if run.design.drive is not None:
        used = used_of_limits(run.design.drive.motor, run.torques("drive"), run.drive_speeds)
        at_limit = np.any(used >= AT_LIMIT, axis=1) & (times > 0.0)
        if at_limit[times >= times[-1] - STARTED].mean() > 0.5:
            return at("drives", at_limit)
    slipping = np.abs(run.drive_speeds * run.design.wheel_radius - _hub_speeds(run)) > SPINS * SPEED
    return at("friction", slipping.any(axis=1) & (times > STARTED))


def _hub_speeds(run: ScenarioRun) -> NDArray[np.float64]:
    """Of the wheels' centres ahead in their planes (n, n_w) [m/s], with the sign of rolling forward."""
    axles = run.motion.rotations[:, run.wheel_bodies, :, 1]
    velocities = run.motion.velocities[:, run.wheel_bodies, :3]
    across = np.sum(velocities * axles, axis=-1, keepdims=True) * axles
    ahead = np.cross(axles, np.array([0.0, 0.0, 1.0]))
    speeds = np.linalg.norm(velocities - across, axis=-1)
    return np.asarray(speeds * np.where(np.sum(velocities * ahead, axis=-1) < 0.0, -1.0, 1.0))


def smallest_torque(scenario: Scenario, design: RoverDesign, unlimited: float) -> float | None:
    """Smallest torque limit of every drive with which the scenario is met, to `TORQUE_WIDTH` of it [N m].

    Parameters
    ----------
    unlimited : largest torque that drives without limits took [N m]

    Returns
    -------
    None where not even twice that meets it.
    """

    def passes(limit: float) -> bool:
        drive = WheelDrive(motor=Motor(torque_limit=limit))
        return _met(scenario, replace(design, drive=drive))

    for high in (1.05 * unlimited, 2.0 * unlimited):
        if passes(high):
            return _boundary(passes, high, 0.0, lambda found: TORQUE_WIDTH * found)
    return None


def smallest_friction(scenario: Scenario, design: RoverDesign, own: float) -> float | None:
    """Smallest coefficient of friction of the ground at which a scenario is met that is met at its own [-].

    Returns
    -------
    None for a scenario that keeps its own, or that another run says is not met there.
    """
    if scenario.holds_fast or not _met(on_friction(scenario, own), design):
        return None

    def passes(friction: float) -> bool:
        return _met(on_friction(scenario, friction), design)

    found = _boundary(passes, own, LEAST_FRICTION, lambda _: FRICTION_WIDTH)
    return LEAST_FRICTION if found - LEAST_FRICTION <= FRICTION_WIDTH and passes(LEAST_FRICTION) else found


def _met(scenario: Scenario, design: RoverDesign) -> bool:
    try:
        return run_scenario(scenario, design).met
    except ConvergenceError:
        return False


def _boundary(passes: Callable[[float], bool], high: float, low: float, width: Callable[[float], float]) -> float:
    """By bisection a value that passes, at most its ``width`` above one that does not, or above ``low``."""
    while high - low > width(high):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if passes(middle) else (middle, high)
    return high
