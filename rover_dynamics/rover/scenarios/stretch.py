"""A stretch of a long way over random rocks, driven until the rover is there or cannot go on.

A stretch starts at rest, straight ahead, on rocks of its own (`rover_dynamics.rover.scenarios.way`). Nothing steers
within it. The drive ends at the first sample at which the rover is there; leans more than `ALLOWED_LEAN`; has the
centre of a body but the wheels' on the ground; or has left the rocks sideways. Samples are 1 mm of the way apart, at
70 m/h a quarter of a wheel's swing of 5 Hz.

Verified by tests/unit/test_rover_stretch.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from rover_dynamics.multibody.implicit_steps import ImplicitSteps
from rover_dynamics.multibody.motion_law import SpeedTrapezoid
from rover_dynamics.rover.rover_design import RoverDesign
from rover_dynamics.rover.scenarios.ground import on_terrain
from rover_dynamics.rover.scenarios.level_ground import all_drives, straight_ahead
from rover_dynamics.rover.scenarios.obstacles import ALLOWED_LEAN, clearances
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, sampled
from rover_dynamics.rover.scenarios.way import ASIDE, Way, rocks
from rover_dynamics.vehicle.vehicle import VehicleMotion, drive_vehicle

__all__ = ["Cause", "cause_of", "stretch"]

Cause = Literal["wheel", "computation", "heading", "stability", "clearance", "friction"]
SAMPLED, LONGEST, RAMP = 0.001, 0.1, 5.0
"""Way between samples [m]; longest step, and time to reach the speed [s]."""


def stretch(way: Way, number: int, design: RoverDesign, turned: float = 1.04) -> Scenario:
    """Stretch ``number`` with wheels that turn by ``turned`` times its length [-], at most `way.LONGER`."""
    law = SpeedTrapezoid(speed=way.speed / design.wheel_radius, accelerates=RAMP)
    plain = Scenario(
        name="stretch",
        title=f"{way.length:g} m at {3600.0 * way.speed:g} m/h, stretch {number + 1}",
        source="mission requirements, section 1",
        lasts=turned * way.length / way.speed + RAMP,
        every=SAMPLED / way.speed,
        actuators=lambda design: all_drives(design, law),
        path=straight_ahead(way.length),
        judge=lambda _: (),
        ride=partial(_ride, way),
    )
    ground = rocks(way, number, design).terrain()
    return on_terrain(plain, design, ground, f"rocks, abundance {way.abundance:g}, seed {way.seed}")


def cause_of(run: ScenarioRun, way: Way) -> Cause | None:
    """What ends a run of `stretch` before the rover is there, None for one that gets there."""
    if run.stopped is not None:
        return "wheel" if "curves end" in run.stopped else "computation"
    ends: tuple[tuple[Cause | None, Callable[[], bool]], ...] = (
        (None, lambda: bool(_there(run.motion, way)[-1])),
        ("heading", lambda: bool(_aside(run.motion, way)[-1])),
        ("stability", lambda: bool(run.lean[-1] > ALLOWED_LEAN)),
        ("clearance", lambda: bool(clearances(run)[-1] <= 0.0)),
    )
    return next((cause for cause, seen in ends if seen()), "friction")


def _ride(way: Way, scenario: Scenario, design: RoverDesign) -> VehicleMotion:
    """The motion up to where it ends; what a run that broke down did behind that end does not count."""
    try:
        motion, broken = drive_vehicle(scenario.vehicle(design), scenario.times(), ImplicitSteps(longest=LONGEST)), None
    except ConvergenceError as error:
        if not isinstance(error.last_good, VehicleMotion) or error.last_good.times[-1] < 0.0:
            raise
        motion, broken = error.last_good, error
    ended = _first(_there(motion, way) | _aside(motion, way), motion)
    found = _first(_fallen(ScenarioRun(scenario=scenario, design=design, motion=ended)), ended)
    if broken is not None and len(found.times) == len(motion.times):
        raise broken
    return found


def _first(seen: NDArray[np.bool_], motion: VehicleMotion) -> VehicleMotion:
    """The motion up to the first sample seen, all of it where there is none."""
    last = int(np.argmax(seen)) + 1 if seen.any() else len(seen)
    return replace(motion, **{name: rows[:last] for name, rows in sampled(motion).items()})


def _there(motion: VehicleMotion, way: Way) -> NDArray[np.bool_]:
    ahead = motion.positions[:, 0, 0] - motion.positions[np.searchsorted(motion.times, 0.0), 0, 0]
    return np.asarray((ahead >= way.length) & (motion.times > 0.0))


def _aside(motion: VehicleMotion, way: Way) -> NDArray[np.bool_]:
    return np.asarray((np.abs(motion.positions[:, 0, 1]) > ASIDE * way.length) & (motion.times > 0.0))


def _fallen(run: ScenarioRun) -> NDArray[np.bool_]:
    """Leans too far, or a body came down to the ground; not while it settles."""
    return np.asarray(((run.lean > ALLOWED_LEAN) | (clearances(run) <= 0.0)) & (run.motion.times > 0.0))
