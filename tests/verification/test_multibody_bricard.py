"""Claim: Bricard's mechanism moves as it should, though the equation that is redundant changes along the motion.

Source: contracts/published/iftomm_bricard.csv (IFToMM A04, another code), and joint coordinates. Tolerances: 1e-6 m in
ten seconds with 1e-8 a step (measured 1.2e-7, 9e-9 and 2e-8 m), 5e-9 m with 1e-10; all equations, redundant ones too,
to 1e-10. Implicit steps: their errors add up, so that the motion errs by what the record's sum says, within a factor of
ten, and by the power 2/3 of the error allowed. Negative controls: with the equations of the start kept for good the
motion ends where they turn dependent; a position where the mechanism gains a freedom is named; a rod's mass is seen.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from contracts.errors import ConvergenceError
from contracts.published import published_table
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.independent_rows import IndependentRows
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import ImplicitSteps, Motion, StepControl, integrate
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.bricard import bricard, hinges_of_bricard
from rover_dynamics.multibody.verification.mechanisms import constraint_defects, n_four_bar

TABLE = published_table("iftomm_bricard")
TIMES = np.asarray(TABLE["t"])
HINGES = np.array([[TABLE[f"J{k}{axis}"] for axis in "xyz"] for k in range(2, 6)]).transpose(2, 0, 1)
Make = type[AbsoluteCoordinates] | type[TreeCoordinates]


def error(motion: Motion) -> float:
    found = np.array([hinges_of_bricard(state) for state in motion.states])
    return float(np.max(np.abs(found - HINGES[: len(found)])))


def run(make: Make, allowed: float, model: MultibodyModel | None = None) -> Motion:
    return integrate(make(model or bricard()), TIMES, StepControl(relative=allowed, absolute=allowed))


@pytest.mark.parametrize("make", [AbsoluteCoordinates, PartitionedCoordinates, TreeCoordinates])
def test_ten_seconds_in_each_formulation(make: Make) -> None:
    motion = run(make, 1e-8)
    assert error(motion) < 1e-6
    for t, state in zip(motion.times, motion.states, strict=True):
        assert max(constraint_defects(bricard(), t, state)) < 1e-10


def test_absolute_coordinates_follow_joint_coordinates() -> None:
    formulation = AbsoluteCoordinates(bricard())
    at_start = formulation.equations.redundant
    motion = integrate(formulation, TIMES, StepControl(relative=1e-10, absolute=1e-10))
    tree = run(TreeCoordinates, 1e-10)
    assert error(motion) < 5e-9
    away = [np.abs(a.positions - b.positions).max() for a, b in zip(motion.states, tree.states, strict=True)]
    assert max(away) < 5e-9
    assert len(at_start) == len(formulation.equations.redundant) == 1
    assert formulation.equations.redundant != at_start


def test_negative_control_equations_of_the_start_kept_for_good(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 1.25 s those kept are dependent, though all together have full rank."""
    monkeypatch.setattr(IndependentRows, "_choose", lambda *_: None)
    with pytest.raises(ConvergenceError, match=r"stopped at t = 1.2\d* s of 10 s: .*singular position"):
        run(AbsoluteCoordinates, 1e-8)


def test_negative_control_a_heavier_rod_is_seen() -> None:
    model = bricard()
    heavier = replace(model.bodies[0], mass=1.01)
    assert error(run(TreeCoordinates, 1e-8, replace(model, bodies=(heavier, *model.bodies[1:])))) > 1e-3


def test_a_position_where_the_mechanism_gains_a_freedom_is_named() -> None:
    """All bars of the four-bars in line: no choice of equations is independent, and absolute coordinates end there."""
    times = np.array([0.0, 0.5, 1.0])
    with pytest.raises(ConvergenceError, match=r"stopped at t = 0.71\d* s of 1 s: singular position") as found:
        integrate(AbsoluteCoordinates(n_four_bar(2)), times, StepControl(relative=1e-9, absolute=1e-9))
    assert isinstance(found.value.last_good, Motion)
    assert found.value.last_good.times[-1] == pytest.approx(0.5)


@cache
def implicit(allowed: float) -> Motion:
    return integrate(TreeCoordinates(bricard()), TIMES, ImplicitSteps(tolerance=allowed))


@pytest.mark.parametrize("allowed", [1e-5, 1e-6])
def test_implicit_steps_err_by_the_sum_of_their_errors(allowed: float) -> None:
    motion = implicit(allowed)
    assert motion.summed_error is not None
    assert 0.1 * motion.summed_error < error(motion) < motion.summed_error
    assert error(motion) > 30.0 * allowed  # of a step: it is not the error of the motion


def test_errors_of_implicit_steps_fall_with_the_power_two_thirds_of_the_error_allowed() -> None:
    assert np.log10(error(implicit(1e-5)) / error(implicit(1e-6))) == pytest.approx(2.0 / 3.0, abs=0.15)


def test_explicit_and_fixed_steps_have_no_sum_of_errors() -> None:
    times = np.array([0.0, 0.01])
    for control in (StepControl(), ImplicitSteps(fixed=0.005)):
        assert integrate(TreeCoordinates(bricard()), times, control).summed_error is None
