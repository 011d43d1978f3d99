"""Static stability: gravity tilted in 24 directions until a wheel is unloaded, and until the rover overturns.

Drives are held, and the friction is raised to 10 so that the rover tips before it slides (the tire's own would let it
slide near atan 0.757 = 37 degrees). Each tilt is a motion of its own that settles from the level stance for 8 s (the
radial damper's time constant is 1 s). How braked wheels share the pull along the ground is settled by the tires'
bristles, not by statics alone.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from contracts.errors import ConvergenceError
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.level_ground import all_drives
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, Tilt, run_scenario

__all__ = ["DIRECTIONS", "STABILITY", "overturned", "smallest_tilt", "wheel_lifted"]

Fails = Callable[[Scenario, RoverDesign, float, float], bool]
REQUIRED, STEEPEST, WIDTH = 40.0, 60.0, 0.25
"""Required tilt, end of the search, and its accuracy [deg]."""
DIRECTIONS = 24
OVERTURNED = math.radians(20.0)
"""Lean of the body against the ground at which the rover counts as overturned; its tires alone allow some 5 degrees."""


def _settled(scenario: Scenario, design: RoverDesign, degrees: float, heading: float) -> ScenarioRun | None:
    """The rover after 8 s on a tilt; None if its motion cannot be followed, as in a fall."""
    tilt = Tilt(angle=math.radians(degrees), heading=math.radians(heading))
    try:
        run = run_scenario(replace(scenario, tilt=tilt, lasts=0.1, every=0.1), design)
    except ConvergenceError:
        return None
    return None if run.stopped else run


def overturned(scenario: Scenario, design: RoverDesign, degrees: float, heading: float) -> bool:
    """Whether the rover falls within 8 s on a tilt towards a heading [deg]."""
    run = _settled(scenario, design, degrees, heading)
    return run is None or bool(run.lean[-1] > OVERTURNED)


def wheel_lifted(scenario: Scenario, design: RoverDesign, degrees: float, heading: float) -> bool:
    """Whether a wheel carries nothing after 8 s on a tilt towards a heading [deg]."""
    run = _settled(scenario, design, degrees, heading)
    return run is None or bool(run.loads[-1].min() <= 0.0)


def smallest_tilt(scenario: Scenario, design: RoverDesign, fails: Fails) -> tuple[float, float]:
    """Smallest tilt at which ``fails`` in any direction, from below, and that direction [deg].

    A direction that holds at the smallest tilt so far needs no search of its own.
    """
    smallest, worst = STEEPEST, 0.0
    for heading in _headings():
        if not fails(scenario, design, smallest, heading):
            continue
        low, high = 0.0, smallest
        while high - low > WIDTH:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if fails(scenario, design, middle, heading) else (middle, high)
        smallest, worst = low, heading
    return smallest, worst


def _judge(run: ScenarioRun) -> tuple[Outcome, ...]:
    return (
        Outcome(quantity="smallest wheel load at the end", value=float(run.loads[-1].min()), unit="N"),
        Outcome(quantity="largest wheel load at the end", value=float(run.loads[-1].max()), unit="N"),
        Outcome(quantity="lean of the body at the end", value=math.degrees(float(run.lean[-1])), unit="deg"),
    )


def _headings() -> list[float]:
    return [float(heading) for heading in np.arange(DIRECTIONS) * (360.0 / DIRECTIONS)]


def _at_the_required_tilt(scenario: Scenario, design: RoverDesign) -> tuple[Outcome, ...]:
    """In how many directions it fails at 40 degrees."""
    runs = [_settled(scenario, design, REQUIRED, heading) for heading in _headings()]
    lifted = sum(run is None or bool(run.loads[-1].min() <= 0.0) for run in runs)
    fallen = sum(run is None or bool(run.lean[-1] > OVERTURNED) for run in runs)
    words = f"directions of {DIRECTIONS} in which at 40 degrees"
    return tuple(
        Outcome(quantity=f"{words} {what}", value=float(count), unit="-", limit=0.0, at_least=False)
        for what, count in (("a wheel is unloaded", lifted), ("the rover overturns", fallen))
    )


def _all_directions(scenario: Scenario, design: RoverDesign) -> tuple[Outcome, ...]:
    found: list[Outcome] = []
    for words, fails in (("a wheel is unloaded", wheel_lifted), ("the rover overturns", overturned)):
        tilt, heading = smallest_tilt(scenario, design, fails)
        found.append(Outcome(quantity=f"smallest tilt before {words}", value=tilt, unit="deg", limit=REQUIRED))
        found.append(Outcome(quantity=f"its direction when {words}, from ahead to the left", value=heading, unit="deg"))
    return tuple(found)


STABILITY = Scenario(
    name="stability",
    title="tilt of 40 degrees towards the front left, drives held, friction 10; then all directions",
    source="mission requirements, section 1",
    settles=8.0,
    lasts=2.0,
    actuators=lambda design: all_drives(design, Hold()),
    friction=10.0,
    holds_fast=True,
    tilt=Tilt(angle=math.radians(REQUIRED), heading=math.radians(45.0)),
    judge=_judge,
    study=_at_the_required_tilt,
    search=_all_directions,
)
