"""Claim: on 25 degrees the lever of the tractive force moves wheel loads by as much as statics by hand says.

Source: balance of moments of a lateral bogie about its pivot, which the body exerts no moment about: weights of its
seven bodies where the motion has them, loads N and tractive forces F of its two wheels, each with the moment F l of the
lever and f N r of rolling resistance. With the lever of the run what is left is below 2e-4 N m (the motion is nearly
steady); with the other lever, the negative control, it is F d, 2.4 N m or more. The thesis does not say which lever its
tire has: of 68 N a front wheel carries uphill 5 N hang on it, of 308 N downhill 8 N.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.slopes import moved_by_lever
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, Lever
from rover_dynamics.vehicle.vehicle import VehicleMotion

DESIGN = read_rover()
LEVERS: tuple[Lever, ...] = ("radius", "loaded")


def driven(name: str, lever: Lever) -> ScenarioRun:
    scenario = SCENARIOS[f"slope_{name}"]
    return run_scenario(replace(scenario, tire=replace(scenario.tire, lever=lever)), DESIGN)


def left_over(run: ScenarioRun, lever: Lever) -> float:
    """Moment about the left pivot's axis, by hand [N m]."""
    model, place = run.scenario.vehicle(DESIGN).model, run.motion.positions[-1]
    names = [body.name for body in model.bodies]
    pivot, moment = place[names.index("pivot_left")], 0.0
    gravity = np.array(model.gravity)
    for leg in ("front_left", "center_left"):
        for part in ("arm", "spindle", "wheel"):
            k = names.index(f"{part}_{leg}")
            moment += np.cross(place[k] - pivot, model.bodies[k].mass * gravity)[1]
        k = [one.name for one in DESIGN.legs].index(leg)
        hub, load, pull = run.wheels[-1, k], run.loads[-1, k], run.tractive[-1, k]
        loaded = DESIGN.wheel_radius - run.deflections[-1, k]
        moment += np.cross(hub - pivot, [pull, 0.0, load])[1]
        moment -= pull * (DESIGN.wheel_radius if lever == "radius" else loaded)
        moment -= THESIS_BRUSH.rolling_resistance * load * loaded
    return float(moment)


@pytest.mark.parametrize("name", ["up", "down"])
@pytest.mark.parametrize("lever", LEVERS)
def test_the_bogie_is_in_balance_with_the_lever_of_its_tires_alone(name: str, lever: Lever) -> None:
    run = driven(name, lever)
    other = LEVERS[1 - LEVERS.index(lever)]
    assert abs(left_over(run, lever)) < 2e-4
    assert abs(left_over(run, other)) > 2.4


def test_the_scenario_says_how_far_it_moves_a_load() -> None:
    for name, least, most in (("up", 4.5, 5.5), ("down", -9.0, -8.0), ("across", -0.1, 0.1)):
        by_radius, loaded = moved_by_lever(SCENARIOS[f"slope_{name}"], DESIGN)
        assert least < loaded.value - by_radius.value < most
        assert by_radius.value in driven(name, "radius").loads[-1]


def test_nothing_is_said_of_tires_without_such_a_lever() -> None:
    """Flexible tires have a ride of their own, which takes minutes."""

    def refused(scenario: Scenario, design: RoverDesign) -> VehicleMotion:
        raise AssertionError("must not be driven")

    assert moved_by_lever(replace(SCENARIOS["slope_up"], ride=refused), DESIGN) == ()
