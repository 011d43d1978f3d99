"""Claim: the walking rover goes ahead by a stride a cycle on wheels that stand, and walking is no help on firm slopes.

Source: what the gait plans; the work of rolling resistance, f times the load times the way of wheels that roll; the
weight's component along a slope. Tolerances: on rigid wheels the way to 1e-4 of itself and standing wheels to 20
micrometres, which is what their bristles yield; the work to 1 %. Negative control: with drives that leave out the legs'
turn, wheels that should stand roll by centimetres.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.rover.rover import Actuators
from rover_dynamics.rover.rover_design import RoverDesign
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_friction, on_rigid_tires
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.walking import deployment_speeds, walked
from rover_dynamics.rover.walking import Gait, repeated, walking_actuators

DESIGN, GAIT = read_rover(), Gait()
LEVEL = on_rigid_tires(walked(replace(SCENARIOS["straight"], lasts=5.0)))
"""One cycle."""


def slides(run: ScenarioRun) -> float:
    """Furthest way of a wheel's centre while it should stand [m]."""
    stands = np.repeat(GAIT.stands(run.motion.times, 3), 2, axis=1)
    moved = np.diff(run.wheels[:, :, 0], axis=0) * (stands[1:] & stands[:-1])
    return float(np.abs(np.cumsum(moved, axis=0)).max())


def work(run: ScenarioRun) -> float:
    """Of drives and deployment joints, what they take back counted [J]."""
    power = run.torques("drive") * run.drive_speeds + run.torques("deploy") * deployment_speeds(run)
    return float(np.trapezoid(power.sum(axis=1), run.motion.times))


@pytest.fixture(scope="module")
def level() -> ScenarioRun:
    return run_scenario(LEVEL, DESIGN)


def test_a_stride_a_cycle_on_wheels_that_stand(level: ScenarioRun) -> None:
    assert LEVEL.lasts == GAIT.period
    assert level.place[-1, 0] - level.place[0, 0] == pytest.approx(GAIT.stride, rel=1e-4)
    assert slides(level) < 20e-6
    assert np.ptp(level.wheels[:, :, 0], axis=0) == pytest.approx(GAIT.stride, rel=1e-3)
    assert np.abs(level.place[:, 1]).max() < 1e-6


def test_legs_and_drives_do_the_work_of_rolling_resistance(level: ScenarioRun) -> None:
    ways = np.abs(np.diff(level.wheels[:, :, 0], axis=0))
    loads = 0.5 * (level.loads[1:] + level.loads[:-1])
    assert work(level) == pytest.approx(LEVEL.tire.rolling_resistance * float(np.sum(loads * ways)), rel=0.01)


def test_drives_that_forget_the_legs_move_what_should_stand() -> None:
    def without(design: RoverDesign) -> Actuators:
        laws = dict(walking_actuators(design, GAIT, 1).laws)
        ways = GAIT.ways(np.linspace(0.0, GAIT.period, 161), 3)[1] / design.wheel_radius
        for k, axle in enumerate(("front", "center", "rear")):
            law = repeated(ways[:, k], GAIT.period, 1)
            laws |= {f"drive_{axle}_{side}": law for side in ("left", "right")}
        return Actuators(laws=laws)

    assert slides(run_scenario(replace(LEVEL, actuators=without), DESIGN)) > 0.01


def test_on_a_firm_slope_walking_slips_more_and_takes_more_than_twice_the_energy() -> None:
    """25 degrees on friction 0.5: four wheels hold what six do in driving; both climb, and pay for the weight."""
    up: Scenario = on_friction(SCENARIOS["slope_up"], 0.5)
    walk = walked(up)
    run = run_scenario(walk, DESIGN)
    assert walk.study is not None
    found = {one.quantity: one.value for one in (*walk.judge(run), *walk.study(walk, DESIGN))}
    both = found["energy of both by way"], found["driven instead: energy of both by way"]
    slip = found["slip over the whole way"], found["driven instead: slip over the whole way"]
    weight = DESIGN.mass * DESIGN.gravity * np.sin(up.tilt.angle)
    assert weight < both[1] < 1.2 * weight
    assert 2.0 * both[1] < both[0]
    assert slip[1] < 0.04 < slip[0]
    assert work(run) > weight * found["way ahead"]
    assert found["driven instead: energy of the deployment joints"] == 0.0
    assert found["largest torque of a deployment joint"] > found["driven instead: largest torque of a deployment joint"]
