"""What a requirement needs and what ends a run: searched torque and friction, causes of damaged motions."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.rover.rover_design import WheelDrive
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios import needs
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_friction
from rover_dynamics.rover.scenarios.needs import (
    FRICTION_WIDTH,
    TORQUE_WIDTH,
    ending,
    smallest_friction,
    smallest_torque,
)
from rover_dynamics.rover.scenarios.outcome import LEAST_FRICTION
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario
from rover_dynamics.vehicle.motors import Motor

DESIGN = read_rover()
UP = SCENARIOS["slope_up"]


@pytest.fixture(scope="module")
def climbed() -> ScenarioRun:
    return run_scenario(UP, DESIGN)


def test_a_run_that_is_met_has_no_ending(climbed: ScenarioRun) -> None:
    assert climbed.met
    assert ending(climbed) is None


def test_the_smallest_torque_is_a_boundary(climbed: ScenarioRun) -> None:
    """A sixth of what the slope takes is less: the heavier wheels give more as long as they can."""
    largest = float(np.abs(climbed.torques("drive")).max())
    least = smallest_torque(UP, DESIGN, largest)
    assert least is not None
    mean = float(climbed.torques("drive")[-1].mean())
    assert mean < least < largest
    for share, met in ((1.0, True), (1.0 - 1.5 * TORQUE_WIDTH, False)):
        drive = WheelDrive(motor=Motor(torque_limit=share * least))
        run = run_scenario(UP, replace(DESIGN, drive=drive))
        assert run.met is met
    end = ending(run)
    assert end is not None
    assert end.cause == "drives"


def test_the_smallest_friction_of_a_slope_is_its_tangent() -> None:
    """Every wheel then slides: rolling resistance is the drives', and asks the ground for nothing."""
    found = smallest_friction(UP, DESIGN, 0.757)
    assert found is not None
    assert -1e-3 < found - math.tan(math.radians(25.0)) < 1.2 * FRICTION_WIDTH
    slipped = run_scenario(on_friction(UP, 0.4), DESIGN)
    end = ending(slipped)
    assert end is not None
    assert end.cause == "friction"
    assert smallest_friction(SCENARIOS["stability"], DESIGN, 0.757) is None
    assert smallest_friction(UP, DESIGN, 0.3) is None


def test_torques_are_searched_to_their_own_share(monkeypatch: pytest.MonkeyPatch) -> None:
    """However much more the drives take that have no limits."""
    monkeypatch.setattr(needs, "_met", lambda _, design: design.drive.motor.torque_limit >= 0.3)
    least = smallest_torque(UP, DESIGN, 6.0)
    assert least is not None
    assert 0.3 <= least <= 0.3 * (1.0 + 1.1 * TORQUE_WIDTH)
    monkeypatch.setattr(needs, "_met", lambda _, design: design.drive.motor.torque_limit >= 1.5 * 6.0)
    assert smallest_torque(UP, DESIGN, 6.0) == pytest.approx(9.0, rel=TORQUE_WIDTH)
    monkeypatch.setattr(needs, "_met", lambda *_: False)
    assert smallest_torque(UP, DESIGN, 6.0) is None


@pytest.mark.parametrize(("needed", "found"), [(0.0, LEAST_FRICTION), (0.0205, 0.0229), (0.3, 0.302)])
def test_the_least_friction_tried_is_found_only_where_it_is_met(
    monkeypatch: pytest.MonkeyPatch, needed: float, found: float
) -> None:
    monkeypatch.setattr(needs, "_met", lambda scenario, _: scenario.friction >= needed)
    assert smallest_friction(UP, DESIGN, 0.757) == pytest.approx(found, abs=1e-3)


def test_what_ends_a_damaged_run_at_the_step() -> None:
    """A body on the ground; a wheel without load behind the step, where nothing else is amiss."""
    run = run_scenario(replace(SCENARIOS["step"], lasts=0.4), DESIGN)
    end = ending(run)
    assert end is not None
    assert end.cause == "friction"  # it did not get there
    sunk = run.motion.positions.copy()
    sunk[1:, 0, 2] = -0.1
    end = ending(replace(run, motion=replace(run.motion, positions=sunk)))
    assert end is not None
    assert (end.cause, end.time) == ("clearance", pytest.approx(run.motion.times[1]))
    behind, lifted = run.motion.positions + np.array([3.0, 0.0, 0.25]), run.motion.tires.copy()
    assert ending(replace(run, motion=replace(run.motion, positions=behind))) is None
    lifted[-1, 3, 1] = 0.0
    end = ending(replace(run, motion=replace(run.motion, positions=behind, tires=lifted)))
    assert end is not None
    assert (end.cause, end.time) == ("stability", pytest.approx(run.motion.times[-1]))


def test_what_ends_a_damaged_run(climbed: ScenarioRun) -> None:
    motion = climbed.motion
    rotations = motion.rotations.copy()
    c, s = np.cos(0.5), np.sin(0.5)
    rotations[200:, 0] = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    lifted = motion.tires.copy()
    lifted[100:, 3, 1] = 0.0
    for damaged, cause, row in (
        (replace(climbed, motion=replace(motion, rotations=rotations)), "stability", 200),
        (replace(climbed, motion=replace(motion, tires=lifted)), "stability", 100),
        (replace(climbed, stopped="a tire folds at t = 3 s"), "wheel", len(motion.times) - 1),
        (replace(climbed, stopped="pressed deep: its curves end at 3 mm"), "wheel", len(motion.times) - 1),
        (replace(climbed, stopped="no step converges"), "computation", len(motion.times) - 1),
    ):
        end = ending(damaged)
        assert end is not None
        assert (end.cause, end.time) == (cause, pytest.approx(motion.times[row]))
