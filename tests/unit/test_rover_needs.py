"""What a requirement needs and what ends a run: searched torque and friction, causes of damaged motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.rover.rover_design import WheelDrive
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_friction
from rover_dynamics.rover.scenarios.needs import ending, smallest_friction, smallest_torque
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
    for share, met in ((1.0, True), (1.0 - 1.5 * 0.02 * largest / least, False)):
        drive = WheelDrive(motor=Motor(torque_limit=share * least))
        run = run_scenario(UP, replace(DESIGN, drive=drive))
        assert run.met is met
    end = ending(run)
    assert end is not None
    assert end.cause == "drives"


def test_the_smallest_friction_of_a_slope_is_its_tangent() -> None:
    """tan 25 degrees is 0.466; friction falls with slip, and rolling resistance adds to it."""
    found = smallest_friction(UP, DESIGN, 0.757)
    assert found == pytest.approx(0.466, abs=0.015)
    slipped = run_scenario(on_friction(UP, 0.4), DESIGN)
    end = ending(slipped)
    assert end is not None
    assert end.cause == "friction"
    assert smallest_friction(SCENARIOS["stability"], DESIGN, 0.757) is None
    assert smallest_friction(UP, DESIGN, 0.3) is None


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
