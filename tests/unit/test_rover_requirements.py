"""What counts as met: an obstacle really passed, a slope really driven; each bound is missed by a damaged motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.obstacles import clearances, wheels_passed
from rover_dynamics.rover.scenarios.readings import stated
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario

WIDTH = 0.15


@pytest.fixture(scope="module")
def behind() -> ScenarioRun:
    """The rover at rest before the crevasse, moved 3 m ahead: behind it."""
    return moved(run_scenario(replace(SCENARIOS["crevasse"], lasts=0.1), read_rover()), (3.0, 0.0, 0.0))


def moved(run: ScenarioRun, by: tuple[float, float, float], bodies: object = slice(None)) -> ScenarioRun:
    positions = run.motion.positions.copy()
    positions[:, bodies] += by  # type: ignore[index]
    return replace(run, motion=replace(run.motion, positions=positions))


def missed(run: ScenarioRun) -> set[str]:
    return {one.quantity for one in run.scenario.judge(run) if one.met is False}


def test_a_rover_that_stands_behind_the_obstacle_has_passed(behind: ScenarioRun) -> None:
    assert missed(behind) == set()
    assert behind.met
    assert wheels_passed(behind, WIDTH) == 6
    assert not replace(behind, stopped="a step failed").met


def test_a_rim_over_the_edge_has_not_passed(behind: ScenarioRun) -> None:
    """Last wheel's rim 10 mm ahead of the far edge, then 10 mm behind it."""
    rear = behind.wheels[-1, :, 0].min() - behind.design.wheel_radius
    edge = 0.64 + 2.0 * 0.1425 - 0.1425 + 0.06 + WIDTH
    for gap, count in ((0.01, 6), (-0.01, 4)):
        run = moved(behind, (edge - rear + gap, 0.0, 0.0))
        assert wheels_passed(run, WIDTH) == count
        assert ("last wheel's rim behind the obstacle" in missed(run)) == (count < 6)


def test_wheels_in_the_trench_have_not_passed(behind: ScenarioRun) -> None:
    assert wheels_passed(moved(behind, (0.0, 0.0, -0.1)), WIDTH) == 0


def test_a_belly_on_the_ground_is_seen(behind: ScenarioRun) -> None:
    sunk = moved(behind, (0.0, 0.0, -0.7), bodies=0)
    assert clearances(sunk).min() < 0.0 < clearances(behind).min()
    assert missed(sunk) == {"lowest centre of a body over the ground"}


def test_an_unloaded_wheel_at_the_end_is_seen(behind: ScenarioRun) -> None:
    tires = behind.motion.tires.copy()
    tires[-1, 2, 1] = 0.4 * behind.loads[-1].mean()
    assert missed(replace(behind, motion=replace(behind.motion, tires=tires))) == {"smallest wheel load at the end"}


def test_a_rover_that_overturned_on_the_way_has_not_passed(behind: ScenarioRun) -> None:
    rotations, angle = behind.motion.rotations.copy(), np.radians(31.0)
    c, s = np.cos(angle), np.sin(angle)
    rotations[0, 0] = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
    assert missed(replace(behind, motion=replace(behind.motion, rotations=rotations))) == {"largest lean of the body"}


def test_a_slope_needs_its_speed_and_all_wheels() -> None:
    run = run_scenario(replace(SCENARIOS["slope_across"], lasts=12.0, every=0.5), read_rover())
    assert missed(run) == set()
    tires = run.motion.tires.copy()
    tires[3, 5, 1] = 10.0
    light = replace(run, motion=replace(run.motion, tires=tires))
    assert missed(light) == {"smallest wheel load on the way"}
    slow = run.motion.positions.copy()
    slow[:, 0, 0] *= 0.85
    late = replace(run, motion=replace(run.motion, positions=slow))
    assert missed(late) == {"slip and drift on 25 degrees"}


def test_what_it_took_is_stated() -> None:
    run = run_scenario(replace(SCENARIOS["slope_up"], lasts=8.0, every=0.5), read_rover())
    found = {one.quantity: one for one in stated(run)}
    torque = found["largest torque of a drive"]
    pull = run.design.mass * run.design.gravity * np.sin(np.radians(25.0)) / 6.0
    assert torque.unit == "N m"
    assert torque.value > pull * run.design.wheel_radius
    assert torque.value == np.abs(run.torques("drive")).max()
    assert run.torques("drive").shape == run.torques("steer").shape == (len(run.motion.times), 6)
    assert 0.0 < found["largest longitudinal slip of a wheel"].value < 0.1
    assert run.spins[-1] == pytest.approx(np.full(6, 70.0 / 3600.0 / run.design.wheel_radius), rel=0.02)
