"""Claim: the IFToMM benchmarks A01 to A03 are met, far below the errors they allow, constraints at 1e-10 throughout.

Source: contracts/published/iftomm_pendulum.csv (closed form), iftomm_four_bar.csv (an equation of one angle),
andrews_squeezer.csv (Test Set for IVP Solvers). Tolerances: pendulum 1e-7 m over ten seconds, where steps are asked for
1e-9; the four-bar passes positions in which the number of freedoms rises from 1 to N + 1: 1e-5 m, a hundredth of the
"high precision" of A02 (1e-3), N = 40 against the same equation of one angle to 1e-2 m and energy to 1e-4, with 1e-6 a
step; Andrews' rates to 1e-6. Absolute
coordinates without a partition are not asked there: they may leave such a position by another of its motions, with the
same energy. Negative
controls: another gravity, crank mass or motor torque is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.published import published_table
from rover_dynamics.multibody.formulation import AbsoluteCoordinates, Formulation
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import Motion, StepControl, integrate
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.andrews import MOTOR, andrews_squeezer
from rover_dynamics.multibody.verification.mechanisms import constraint_defects, n_four_bar, pendulum
from rover_dynamics.multibody.verification.work_precision import (
    PROBLEMS,
    control_for,
    one_angle,
    one_angle_error,
    work,
)

FORMULATIONS = [AbsoluteCoordinates, PartitionedCoordinates, TreeCoordinates]
Make = type[AbsoluteCoordinates] | type[TreeCoordinates]


def run(make: Make, model: MultibodyModel, times: np.ndarray, error: float) -> Motion:
    formulation: Formulation = make(model)
    motion = integrate(formulation, times, StepControl(relative=error, absolute=error))
    for t, state in zip(motion.times, motion.states, strict=True):
        assert max(constraint_defects(model, t, state)) < 1e-10
    return motion


def pendulum_error(make: Make, model: MultibodyModel) -> float:
    problem = PROBLEMS["pendulum"]
    return problem.error(run(make, model, np.array(problem.times), 1e-9))


@pytest.mark.parametrize("make", FORMULATIONS)
def test_pendulum(make: Make) -> None:
    assert pendulum_error(make, pendulum()) < 1e-7


def test_another_gravity_is_seen() -> None:
    """Negative control."""
    assert pendulum_error(TreeCoordinates, replace(pendulum(), gravity=(0.0, -9.82, 0.0))) > 1e-4


def four_bar_error(make: Make, model: MultibodyModel) -> float:
    problem = PROBLEMS["four_bar_2"]
    return problem.error(run(make, model, np.array(problem.times), 1e-9))


def test_the_equation_of_one_angle_is_the_published_table() -> None:
    table = published_table("iftomm_four_bar")
    found = one_angle(2, np.asarray(table["t"]))
    np.testing.assert_allclose(found, np.stack([table["B0x"], table["B0y"]], axis=1), atol=1e-10)


@pytest.mark.parametrize("make", [PartitionedCoordinates, TreeCoordinates])
def test_two_four_bars(make: Make) -> None:
    assert four_bar_error(make, n_four_bar(2)) < 1e-5


@pytest.mark.parametrize("allowed", [2e-8, 1.4e-8, 1e-8, 8e-9, 4e-10])
def test_a_stage_next_to_a_singular_position_spoils_no_step(allowed: float) -> None:
    """At 1e-8 and 4e-10 there is one: unseen by the estimate of the error it spoiled the motion by 240 and 0.26 um."""
    found = work(PROBLEMS["four_bar_2"], control_for("explicit", allowed))
    assert found.error < max(500.0 * allowed, 1e-7)


def test_a_heavier_crank_is_seen() -> None:
    """Negative control."""
    model = n_four_bar(2)
    heavier = replace(model.bodies[0], mass=1.01)
    assert four_bar_error(TreeCoordinates, replace(model, bodies=(heavier, *model.bodies[1:]))) > 1e-3


def test_forty_four_bars() -> None:
    """Over ten seconds, five turns, with 1e-6 a step: path of B0 as of one angle, and energy."""
    found = work(PROBLEMS["four_bar_40"], control_for("explicit", 1e-6))
    assert found.error < 1e-2
    assert found.energy is not None
    assert found.energy < 1e-4


def test_loose_steps_err_as_much_on_the_equation_of_one_angle() -> None:
    """With 1e-4 and 1e-6 a step: what is lost is the problem's own doing, not that of singular positions."""
    for allowed in (1e-4, 1e-6):
        found = work(PROBLEMS["four_bar_2"], control_for("explicit", allowed))
        assert found.error < 3.0 * one_angle_error(2, allowed)


def andrews_error(make: Make, motor: float) -> float:
    problem = PROBLEMS["andrews"]
    return problem.error(run(make, andrews_squeezer(motor), np.array(problem.times), 1e-10))


@pytest.mark.parametrize("make", [PartitionedCoordinates, TreeCoordinates])
def test_andrews_squeezer(make: Make) -> None:
    assert andrews_error(make, MOTOR) < 1e-6


def test_a_stronger_motor_is_seen() -> None:
    """Negative control."""
    assert andrews_error(TreeCoordinates, 1.0001 * MOTOR) > 1e-5
