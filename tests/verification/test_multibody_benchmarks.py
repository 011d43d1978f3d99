"""Claim: the IFToMM benchmarks A01 to A03 are met, far below the errors they allow, constraints at 1e-10 throughout.

Source: contracts/published/iftomm_pendulum.csv (closed form), iftomm_four_bar.csv (an equation of one angle),
andrews_squeezer.csv (Test Set for IVP Solvers). Tolerances: pendulum 1e-7 m over ten seconds, where steps are asked for
1e-9; the four-bar passes positions in which the number of freedoms rises from 1 to N + 1: 1e-5 m, a hundredth of the
"high precision" of A02 (1e-3), N = 40 against the same equation of one angle; Andrews' rates to 1e-6. Absolute
coordinates without a partition are not asked there: they may leave such a position by another of its motions, with the
same energy. Negative
controls: another gravity, crank mass or motor torque is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from contracts.published import published_table
from rover_dynamics.multibody.formulation import AbsoluteCoordinates, Formulation
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import Motion, StepControl, integrate
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.andrews import MOTOR, andrews_rates, andrews_squeezer
from rover_dynamics.multibody.verification.mechanisms import (
    constraint_defects,
    mechanical_energy,
    n_four_bar,
    pendulum,
    tip_of_four_bar,
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
    table = published_table("iftomm_pendulum")
    motion = run(make, model, table["t"], 1e-9)
    found = np.array([state.positions[0, :2] for state in motion.states])
    return float(np.max(np.abs(found - np.stack([table["x"], table["y"]], axis=1))))


@pytest.mark.parametrize("make", FORMULATIONS)
def test_pendulum(make: Make) -> None:
    assert pendulum_error(make, pendulum()) < 1e-7


def test_another_gravity_is_seen() -> None:
    """Negative control."""
    assert pendulum_error(TreeCoordinates, replace(pendulum(), gravity=(0.0, -9.82, 0.0))) > 1e-4


def four_bar_error(make: Make, model: MultibodyModel) -> float:
    table = published_table("iftomm_four_bar")
    motion = run(make, model, table["t"], 1e-9)
    found = np.array([tip_of_four_bar(state)[:2] for state in motion.states])
    return float(np.max(np.abs(found - np.stack([table["B0x"], table["B0y"]], axis=1))))


@pytest.mark.parametrize("make", [PartitionedCoordinates, TreeCoordinates])
def test_two_four_bars(make: Make) -> None:
    assert four_bar_error(make, n_four_bar(2)) < 1e-5


def test_a_heavier_crank_is_seen() -> None:
    """Negative control."""
    model = n_four_bar(2)
    heavier = replace(model.bodies[0], mass=1.01)
    assert four_bar_error(TreeCoordinates, replace(model, bodies=(heavier, *model.bodies[1:]))) > 1e-3


def test_forty_four_bars() -> None:
    """Past the first horizontal position: path of B0 as of one angle, and energy to 1e-5 of the start's."""
    n, model, end = 40, n_four_bar(40), 1.0
    heights, masses = (n + 1) / 2 + n, (n + 1) / 3 + n
    one_angle = solve_ivp(
        lambda _t, y: (y[1], 9.81 * heights / masses * np.sin(y[0])), (0, end), (0.0, 1.0), rtol=1e-11, atol=1e-12
    )
    motion = run(TreeCoordinates, model, np.array([0.0, 0.5, end]), 1e-7)
    expected = np.array([np.sin(one_angle.y[0, -1]), np.cos(one_angle.y[0, -1])])
    assert one_angle.y[0, -1] > np.pi / 2
    np.testing.assert_allclose(tip_of_four_bar(motion.states[-1])[:2], expected, atol=1e-5)
    first, last = (mechanical_energy(model, motion.states[k]) for k in (0, -1))
    assert abs(last - first) < 1e-5 * abs(first)


def andrews_error(make: Make, motor: float) -> float:
    table = published_table("andrews_squeezer")
    motion = run(make, andrews_squeezer(motor), np.array([0.0, 0.03]), 1e-10)
    rates = andrews_rates(motion.states[-1])
    found = np.array([rates[name] for name in table.text("name")])
    published = table["ydot_ref_t0.03"]
    return float(np.max(np.abs(found - published) / np.maximum(np.abs(published), 1.0)))


@pytest.mark.parametrize("make", [PartitionedCoordinates, TreeCoordinates])
def test_andrews_squeezer(make: Make) -> None:
    assert andrews_error(make, MOTOR) < 1e-6


def test_a_stronger_motor_is_seen() -> None:
    """Negative control."""
    assert andrews_error(TreeCoordinates, 1.0001 * MOTOR) > 1e-5
