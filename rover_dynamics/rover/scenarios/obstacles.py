"""The mission's step and crevasse at 70 m/h.

A wheel has passed if its centre ends behind the obstacle and half a radius or more above the ground there. An obstacle
counts as passed if all wheels have, and the body never leaned by 45 degrees. Drives, deployment and steering follow
their laws whatever the ground does: no controller helps. Only wheels touch the ground: belly and arms pass through it.

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
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.slopes import largest_passed

__all__ = ["OBSTACLES", "crevasse", "step", "wheels_passed"]

STEP_HEIGHT, CREVASSE_WIDTH, EDGE, LARGEST = 0.25, 0.15, 0.005, 0.49
DEPTH = 0.4
"""Of the crevasse [m]: deeper than a wheel's diameter."""
ALLOWED_LEAN = math.radians(45.0)
SOURCE = "mission requirements, section 1"


def _first_edge(design: RoverDesign) -> float:
    """Place of the obstacle: 60 mm ahead of the front wheels [m]."""
    return max(leg.drive[0] for leg in design.legs) + design.wheel_radius + 0.06


def wheels_passed(run: ScenarioRun, width: float) -> int:
    """How many wheels end behind an obstacle of that width [m]; none if the body leaned too far."""
    if run.lean.max() > ALLOWED_LEAN:
        return 0
    ends = run.wheels[-1]
    ground = run.scenario.terrain(run.design).height(ends[:, 0], ends[:, 1])
    above = ends[:, 2] >= ground + 0.5 * run.design.wheel_radius
    return int(np.sum(above & (ends[:, 0] >= _first_edge(run.design) + width)))


def _judge(run: ScenarioRun, width: float) -> tuple[Outcome, ...]:
    count = Outcome(
        quantity="wheels behind the obstacle",
        value=float(wheels_passed(run, width)),
        unit="-",
        limit=float(len(run.design.legs)),
    )
    return (
        count,
        Outcome(quantity="largest lean of the body", value=math.degrees(float(run.lean.max())), unit="deg"),
        Outcome(quantity="largest wheel load", value=float(run.loads.max()), unit="N"),
        Outcome(quantity="smallest wheel load", value=float(run.loads.min()), unit="N"),
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
            run = run_scenario(replace(scenario, terrain=sized.terrain, judge=sized.judge), design)
        except ConvergenceError:
            return False
        return run.stopped is None and all(outcome.met is not False for outcome in run.scenario.judge(run))

    return (
        Outcome(
            quantity=f"{quantity} (search ends at {LARGEST:g} m)",
            value=largest_passed(passes, 0.01, LARGEST, 0.016),
            unit="m",
            limit=limit,
        ),
    )


OBSTACLES = (step(STEP_HEIGHT), crevasse(CREVASSE_WIDTH))
