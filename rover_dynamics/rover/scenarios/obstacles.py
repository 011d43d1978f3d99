"""The mission's step and crevasse at 70 m/h.

An obstacle counts as passed if at the end every wheel lies behind it with its whole rim, half a radius or more above
the ground there, and carries at least half of its share of the weight; if the body never leaned by 30 degrees, which is
less than it stands statically, and the centre of no body but the wheels came down to the ground. Drives, deployment and
steering follow their laws whatever the ground does: no controller helps, no torque is limited; what they took is
stated. Only wheels touch the ground: belly and arms would pass through it.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from contracts.errors import ConvergenceError
from contracts.terrain_ridges import Crevasse, Step
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.level_ground import drive_forward
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.readings import largest_lean, stated
from rover_dynamics.rover.scenarios.scenario import FloatArray, Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.slopes import largest_passed

__all__ = ["OBSTACLES", "clearances", "crevasse", "step", "wheels_passed"]

STEP_HEIGHT, CREVASSE_WIDTH, EDGE, LARGEST = 0.25, 0.15, 0.005, 0.49
DEPTH = 0.4
"""Of the crevasse [m]: deeper than a wheel's diameter."""
ALLOWED_LEAN = math.radians(30.0)
SOURCE = "mission requirements, section 1"


def _first_edge(design: RoverDesign) -> float:
    """Place of the obstacle: 60 mm ahead of the front wheels [m]."""
    return max(leg.drive[0] for leg in design.legs) + design.wheel_radius + 0.06


def wheels_passed(run: ScenarioRun, width: float) -> int:
    """How many wheels end with their whole rim behind an obstacle of that width [m]."""
    ends, radius = run.wheels[-1], run.design.wheel_radius
    ground = run.scenario.terrain(run.design).height(ends[:, 0], ends[:, 1])
    return int(np.sum((ends[:, 2] >= ground + 0.5 * radius) & (ends[:, 0] - radius >= _first_edge(run.design) + width)))


def clearances(run: ScenarioRun) -> FloatArray:
    """Height of the lowest body's centre over the ground below it, wheels apart (n,) [m]."""
    others = np.delete(run.motion.positions, run.wheel_bodies, axis=1)
    ground = run.scenario.terrain(run.design).height(others[..., 0], others[..., 1])
    return np.asarray(np.min(others[..., 2] - ground, axis=1))


def _judge(run: ScenarioRun, width: float) -> tuple[Outcome, ...]:
    behind = run.wheels[-1, :, 0].min() - run.design.wheel_radius - _first_edge(run.design) - width
    count, share = float(wheels_passed(run, width)), 0.5 * run.design.static_load
    lowest = float(clearances(run).min())
    return (
        Outcome(quantity="wheels behind the obstacle", value=count, unit="-", limit=float(len(run.design.legs))),
        Outcome(quantity="last wheel's rim behind the obstacle", value=float(behind), unit="m", limit=0.0),
        Outcome(quantity="smallest wheel load at the end", value=float(run.loads[-1].min()), unit="N", limit=share),
        Outcome(quantity="lowest centre of a body over the ground", value=lowest, unit="m", limit=0.0),
        largest_lean(run, ALLOWED_LEAN),
        *stated(run),
    )


def step(height: float) -> Scenario:
    """A step of that height [m]."""
    return Scenario(
        name="step",
        title=f"step of {height:g} m at 70 m/h",
        source=SOURCE,
        lasts=150.0,
        every=0.2,
        actuators=drive_forward,
        terrain=lambda design: Step(rise=height, edge_radius=EDGE, position=_first_edge(design)),
        judge=partial(_judge, width=0.0),
        search=partial(_largest, make=step, quantity="highest step climbed", limit=STEP_HEIGHT),
    )


def crevasse(width: float) -> Scenario:
    """A crevasse of that width [m]."""
    return Scenario(
        name="crevasse",
        title=f"crevasse of {width:g} m at 70 m/h",
        source=SOURCE,
        lasts=120.0,
        every=0.2,
        actuators=drive_forward,
        terrain=lambda design: Crevasse(width=width, depth=DEPTH, edge_radius=EDGE, position=_first_edge(design)),
        judge=partial(_judge, width=width),
        search=partial(_largest, make=crevasse, quantity="widest crevasse crossed", limit=CREVASSE_WIDTH),
    )


def _largest(
    scenario: Scenario, design: RoverDesign, *, make: Callable[[float], Scenario], quantity: str, limit: float
) -> tuple[Outcome, ...]:
    """The largest obstacle that is passed, by bisection from 10 to 490 mm, to 16 mm."""

    def passes(size: float) -> bool:
        try:
            sized = make(size)
            return run_scenario(replace(scenario, terrain=sized.terrain, judge=sized.judge), design).met
        except ConvergenceError:
            return False

    return (
        Outcome(
            quantity=f"{quantity} (search ends at {LARGEST:g} m)",
            value=largest_passed(passes, 0.01, LARGEST, 0.016),
            unit="m",
            limit=limit,
        ),
    )


OBSTACLES = (step(STEP_HEIGHT), crevasse(CREVASSE_WIDTH))
