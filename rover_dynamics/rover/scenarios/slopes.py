"""Slopes of 25 degrees up, down and across: driven at 70 m/h, and the steepest that is.

A slope is a tilt of gravity on level ground. It counts as driven if over the last 5 s the rover's velocity along the
ground differs from 70 m/h ahead by no more than a tenth (slip and drift together), every wheel carries at least a tenth
of its share of the weight all the time, and the body stays within 10 degrees of the ground's normal. The bounds are
choices; the mission names the angle only. No torque is limited: what the drives took is stated.

Verified by tests/unit/test_rover_scenarios.py and tests/verification/test_rover_statics.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from contracts.errors import ConvergenceError
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.level_ground import SPEED, drive_forward, straight_ahead
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.readings import largest_lean, stated
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, Tilt, run_scenario
from rover_dynamics.tires.brush_tire import Lever

__all__ = ["ALLOWED_LOSS", "SLOPES", "largest_passed", "moved_by_lever", "steady", "steepest", "velocity_loss"]

REQUIRED = math.radians(25.0)
ALLOWED_LOSS, LEAST_LOAD = 0.1, 0.1
"""Of the speed; of the mean static wheel load [-]."""
ALLOWED_LEAN = math.radians(10.0)


def velocity_loss(run: ScenarioRun) -> float:
    """Mean velocity of the last 5 s less 70 m/h ahead, in the ground's plane, by 70 m/h [-]."""
    times = run.motion.times
    begin = int(np.searchsorted(times, times[-1] - 5.0))
    velocity = (run.place[-1, :2] - run.place[begin, :2]) / (times[-1] - times[begin])
    return float(np.hypot(velocity[0] - SPEED, velocity[1]) / SPEED)


def largest_passed(passes: Callable[[float], bool], low: float, high: float, width: float) -> float:
    """By bisection, the largest value that passes, from below within ``width``; bounds and width are in its unit.

    ``low`` is taken to pass; where ``high`` passes too, it is the answer.
    """
    if passes(high):
        return high
    while high - low > width:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passes(middle) else (low, middle)
    return low


def steady(run: ScenarioRun) -> tuple[Outcome, ...]:
    """What every wheel must carry, and how far the body may lean."""
    least, limit = float(run.loads.min()), LEAST_LOAD * run.design.static_load
    return (
        Outcome(quantity="smallest wheel load on the way", value=least, unit="N", limit=limit),
        largest_lean(run, ALLOWED_LEAN),
    )


def _judge(run: ScenarioRun) -> tuple[Outcome, ...]:
    angle = math.degrees(run.scenario.tilt.angle)
    return (
        Outcome(
            quantity=f"slip and drift on {angle:g} degrees",
            value=velocity_loss(run),
            unit="-",
            limit=ALLOWED_LOSS,
            at_least=False,
        ),
        *steady(run),
        Outcome(quantity="speed ahead at the end", value=float(run.motion.velocities[-1, 0, 0]), unit="m/s"),
        Outcome(quantity="sideways drift", value=float(run.place[-1, 1] - run.place[0, 1]), unit="m"),
        *stated(run),
    )


def steepest(scenario: Scenario, design: RoverDesign, every: float, width: float) -> float:
    """The steepest slope on which a scenario meets what is required [deg], to ``width``; samples ``every`` [s]."""

    def passes(degrees: float) -> bool:
        tilt = replace(scenario.tilt, angle=math.radians(degrees))
        try:
            return run_scenario(replace(scenario, tilt=tilt, every=every), design).met
        except ConvergenceError:
            return False

    return largest_passed(passes, 0.0, 50.0, width)


def _steepest(scenario: Scenario, design: RoverDesign) -> tuple[Outcome, ...]:
    """The mission's requirement: the steepest slope that is driven, to a quarter of a degree."""
    value = steepest(scenario, design, every=1.0, width=0.2)
    return (Outcome(quantity="steepest slope driven", value=value, unit="deg", limit=math.degrees(REQUIRED)),)


def moved_by_lever(scenario: Scenario, design: RoverDesign) -> tuple[Outcome, ...]:
    """How far the lever of the tractive force, of which no source says what it is, moves a wheel's load at the end.

    Nothing on tires that have no such lever, and where one of the two runs stops.
    """
    levers: tuple[Lever, ...] = ("radius", "loaded")
    try:
        each = levers if scenario.on_brush_tires else ()
        runs = [run_scenario(replace(scenario, tire=replace(scenario.tire, lever=one)), design) for one in each]
    except ConvergenceError:
        return ()
    if not runs or any(run.stopped for run in runs):
        return ()
    by_radius, loaded = (run.loads[-1] for run in runs)
    wheel = int(np.abs(loaded - by_radius).argmax())
    name = design.legs[wheel].name.replace("_", " ")
    return (
        Outcome(quantity=f"wheel load at the end, {name}, lever R", value=float(by_radius[wheel]), unit="N"),
        Outcome(quantity=f"wheel load at the end, {name}, lever R - d", value=float(loaded[wheel]), unit="N"),
    )


def _slope(name: str, words: str, heading: float) -> Scenario:
    return Scenario(
        name=f"slope_{name}",
        title=f"slope of 25 degrees {words} at 70 m/h, as tilted gravity",
        source="mission requirements, section 1",
        lasts=20.0,
        actuators=drive_forward,
        path=straight_ahead(20.0 * SPEED),
        tilt=Tilt(angle=REQUIRED, heading=heading),
        judge=_judge,
        study=moved_by_lever,
        search=_steepest,
    )


SLOPES = (
    _slope("up", "upwards", math.pi),
    _slope("down", "downwards", 0.0),
    _slope("across", "across, uphill side on the left", -0.5 * math.pi),
)
