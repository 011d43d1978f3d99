"""A scenario walked instead of driven: the same ground, about the same way, legs and drives in a gait.

What is required of the driven scenario is required of the walked one; of a slope, that the way is no more than a tenth
behind what the wheels turn. The driven run stands beside the walked one. Both follow their laws with whatever torque
that takes; energies of drives and of deployment joints are what they give, nothing where they would take back.

Verified by tests/unit/test_walking.py and tests/verification/test_rover_walking.py.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.rover.rover_design import RoverDesign
from rover_dynamics.rover.scenarios.level_ground import SPEED, straight_ahead
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.readings import energy_of_drives
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.slopes import ALLOWED_LOSS, steady, steepest
from rover_dynamics.rover.walking import Gait, walking_actuators

__all__ = ["WALKED", "WALKS", "deployment_speeds", "walked"]

FloatArray = NDArray[np.float64]
SLOPES = ("slope_up", "slope_down", "slope_across")
WALKS = ("straight", *SLOPES, "step", "crevasse")
"""What can be walked: what is driven straight ahead."""
RAMP = 2.5
"""Half the time in which the driven rover reaches its speed [s]: what it is behind 70 m/h."""
WALKED = "_walk"
"""Behind the name of a scenario that is walked."""


def walked(scenario: Scenario, gait: Gait | None = None) -> Scenario:
    """The same walked, in as many whole cycles as the way takes that it is driven at 70 m/h.

    Parameters
    ----------
    scenario : as driven, on any tires
    gait : `Gait()` if left out

    Raises
    ------
    InputError
        For a scenario that is not driven straight ahead.
    """
    if scenario.name not in WALKS:
        rule, hint = "is not driven straight ahead", f"walk one of {', '.join(WALKS)}"
        raise InputError("scenario to walk", repr(scenario.name), rule, hint)
    gait = gait or Gait()
    cycles = math.ceil(SPEED * scenario.lasts / gait.stride)
    on_slope = scenario.name in SLOPES
    return replace(
        scenario,
        name=f"{scenario.name}{WALKED}",
        title=f"{scenario.title}; walked instead, {gait.stride:g} m in {gait.period:g} s",
        lasts=cycles * gait.period,
        every=0.1,
        actuators=lambda design: walking_actuators(design, gait, cycles),
        path=None if scenario.path is None else straight_ahead(cycles * gait.stride),
        judge=partial(_judge, driven=scenario, turned=cycles * gait.stride * (1.0 + gait.overdrive)),
        study=partial(_driven_instead, driven=scenario),
        search=partial(_steepest, driven=scenario, gait=gait) if on_slope else None,
    )


def deployment_speeds(run: ScenarioRun) -> FloatArray:
    """Of the deployment joints (n, n_w) [rad/s]: of the arms against what carries them, about its y."""
    names, arms = [body.name for body in run.design.bodies], run.wheel_bodies.start - 2
    carriers = [names.index(leg.carrier) for leg in run.design.legs]
    turning = run.motion.velocities[:, arms::3, 3:] - run.motion.velocities[:, carriers, 3:]
    return np.asarray(np.sum(run.motion.rotations[:, carriers][..., 1] * turning, axis=-1))


def _judge(run: ScenarioRun, driven: Scenario, turned: float) -> tuple[Outcome, ...]:
    """What is required, and what it took."""
    slip = _slip(run, turned)
    if driven.name in SLOPES:
        required: tuple[Outcome, ...] = (replace(slip, limit=ALLOWED_LOSS, at_least=False), *steady(run))
    else:
        required = (slip, *(one for one in driven.judge(run) if one.limit is not None))
    return (*required, *_took(run))


def _slip(run: ScenarioRun, turned: float, words: str = "") -> Outcome:
    """1 - way / what the wheels turn, over the whole run."""
    return Outcome(quantity=f"{words}slip over the whole way", value=1.0 - _way(run) / turned, unit="-")


def _way(run: ScenarioRun) -> float:
    return float(run.place[-1, 0] - run.place[0, 0])


def _took(run: ScenarioRun, words: str = "") -> tuple[Outcome, ...]:
    """Way, torques and energy."""
    way, drives = _way(run), energy_of_drives(run)
    given = np.maximum(run.torques("deploy") * deployment_speeds(run), 0.0).sum(axis=1)
    legs = float(np.trapezoid(given, run.motion.times))
    numbers = [
        ("way ahead", way, "m"),
        ("largest torque of a drive", float(np.abs(run.torques("drive")).max()), "N m"),
        ("largest torque of a deployment joint", float(np.abs(run.torques("deploy")).max()), "N m"),
        ("largest load of a wheel", float(run.loads.max()), "N"),
        ("smallest load of a wheel", float(run.loads.min()), "N"),
        ("energy of the drives", drives, "J"),
        ("energy of the deployment joints", legs, "J"),
    ]
    if way > 0.0:
        numbers.append(("energy of both by way", (drives + legs) / way, "J/m"))
    return tuple(Outcome(quantity=words + quantity, value=value, unit=unit) for quantity, value, unit in numbers)


def _driven_instead(_: Scenario, design: RoverDesign, driven: Scenario) -> tuple[Outcome, ...]:
    """The same numbers of the driven run, on the same ground and tires."""
    run = run_scenario(driven, design)
    if run.stopped is not None:
        raise ConvergenceError(f"driven instead: {run.stopped}", [])
    words = "driven instead: "
    stops = RAMP if driven.name == "straight" else 0.0
    missed = [one for one in driven.judge(run) if one.met is False]
    return (
        _slip(run, SPEED * (driven.lasts - RAMP - stops), words),
        *_took(run, words),
        Outcome(quantity=f"{words}requirements not met", value=float(len(missed)), unit="-"),
    )


def _steepest(_: Scenario, design: RoverDesign, driven: Scenario, gait: Gait) -> tuple[Outcome, ...]:
    """The steepest slope that is walked, to half a degree, beside the steepest that is driven."""
    ways = (("steepest slope walked", walked(driven, gait)), ("driven instead: steepest slope", driven))
    return tuple(
        Outcome(quantity=words, value=steepest(one, design, every=0.5, width=0.5), unit="deg") for words, one in ways
    )
