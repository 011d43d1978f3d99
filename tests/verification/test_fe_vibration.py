"""Claim: natural frequencies of solids are those of closed forms, with the order of quadratic cells, and prestress acts
with its sign, far beyond small strains too; ground that is touched holds by its penalty.

Sources: f_n = n c / (2 L) of a bar, exact; rings of Hoppe 1871 (Love, art. 293); Barton 1951 for the square cantilever
plate; the guided column, whose squared frequency falls in proportion to its load and is zero at Euler's. Tolerances:
the order within 0.3 of 4; ring 0.1 % on 32 cells (thickness 1 % of the radius: shear and rotary inertia below 0.02 %);
plate 2 % on 8 x 8 cells, from above; column 0.1 %. Negative controls: density twice, and the load's sign.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.material_laws import J2Plasticity
from contracts.materials import Material
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh
from reference_fe.verification.vibration import (
    bar,
    cantilever_plate,
    column,
    free_ring,
    stretched_bar,
    waves_on_ground,
)
from reference_fe.vibration.body import Support as Held
from reference_fe.vibration.body import natural_modes


def test_bar_converges_with_the_fourth_order() -> None:
    errors = np.array([bar(cells).error for cells in (4, 8, 16)])
    assert (errors > 0.0).all()  # a consistent mass and full integration: from above
    order = np.log2(errors[1, 0] / errors[2, 0])
    assert order == pytest.approx(4.0, abs=0.3)
    assert errors[2].max() < 1e-4
    linear = np.array([bar(cells, order=1).error[0] for cells in (8, 16)])
    assert np.log2(linear[0] / linear[1]) == pytest.approx(2.0, abs=0.2)


def test_six_rigid_motions_of_a_ring_are_told_apart_from_its_bending() -> None:
    coarse, fine = free_ring(16), free_ring(32)
    assert np.abs(fine.error).max() < 1e-3
    assert np.abs(fine.error).max() < 0.1 * np.abs(coarse.error).max()
    modes = fine.modes
    assert modes.rigid.tolist() == [True] * 6 + [False] * (len(modes.rigid) - 6)
    lowest = modes.eigenvalue[~modes.rigid].min()
    assert np.abs(modes.eigenvalue[modes.rigid]).max() < 1e-5 * lowest
    # All mass is in the rigid motions, each in one direction; elastic modes move no centre of mass and do not turn.
    effective = modes.effective_mass / modes.whole
    np.testing.assert_allclose(effective[:6], np.eye(6), atol=1e-9)
    np.testing.assert_allclose(effective[6:], 0.0, atol=1e-9)
    mass = 8000.0 * 2.0 * np.pi * 0.5 * 0.005**2
    np.testing.assert_allclose(modes.whole[:3], mass, rtol=1e-4)
    assert modes.whole[4] == pytest.approx(mass * 0.25, rel=1e-3)


def test_cantilever_plate() -> None:
    found = cantilever_plate(8)
    assert (found.error > 0.0).all()
    assert found.error.max() < 0.02
    sums = found.modes.effective_mass.sum(axis=0) / found.modes.moving
    assert 0.7 < sums[2] < 1.0  # across the plate; along it nothing moves
    assert sums[0] < 1e-9


def test_a_bar_that_flowed_vibrates_elastically() -> None:
    """Its points lie on the yield surface: as when they are unloaded a little, and in pairs, for it is square."""
    soft = Material(name="soft", young_modulus=1e7, poisson_ratio=0.3, density=1.0, yield_strength=1e5, source="test")
    mesh = block_mesh((4, 1, 1), lambda X: X * [1.0, 0.1, 0.1])
    ends = Support(faces=("x0",)), Support(faces=("x1",), components=(0,), value=(0.02,))
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": replace(soft, law=J2Plasticity())}, ends)
    held = np.unique(np.concatenate([bc.dof_indices()[0] for bc in problem.bcs[:3]])).astype(np.int64)
    path, found = iter([0.25, 0.5, 0.75, 1.0, 0.9999]), list[np.ndarray]()
    for state in solve_increments(NewtonSolver(problem, NewtonSettings()), lambda _: next(path, None), []):
        if state.control > 0.9:
            found.append(natural_modes(problem, {"body": 1.0}, Held(held=held), 4).frequency)
    pulled, unloaded = found
    np.testing.assert_allclose(pulled, unloaded, rtol=1e-3)
    np.testing.assert_allclose(pulled[::2], pulled[1::2], rtol=1e-6)


@pytest.mark.parametrize("share", [0.0, 0.5, 0.9, -1.0])
def test_squared_frequency_falls_in_proportion_to_the_load(share: float) -> None:
    found = column(share)
    assert abs(found.error[0]) < 1e-3
    assert found.modes.unstable == 0
    assert found.modes.rigid.sum() == 1  # it moves sideways as a whole


@pytest.mark.parametrize("stretch", [0.8, 1.3])
def test_a_bar_stretched_far_vibrates_with_the_slope_of_its_law(stretch: float) -> None:
    found = stretched_bar(stretch)
    assert (found.error > 0.0).all()
    assert found.error.max() < 1e-4


@pytest.mark.parametrize(("component", "grips"), [(2, False), (2, True), (0, False), (0, True)])
def test_the_ground_holds_a_bar_as_stiffly_as_it_is_pressed(component: int, grips: bool) -> None:
    """Normal to it by its penalty; along it as stiffly if it grips, else not at all."""
    error = waves_on_ground(component, grips=grips).error
    np.testing.assert_allclose(error, [0.0, 1e-4, 6.5e-4], atol=5e-5)  # of eight cells, with their fourth order


def test_beyond_eulers_load_a_mode_grows() -> None:
    found = column(1.1)
    assert found.modes.unstable == 1
    assert abs(found.error[0]) < 1e-3  # by the rate of growth
    assert found.modes.frequency[~found.modes.rigid][0] == 0.0


def test_negative_control_density_and_sign_of_the_load_are_seen() -> None:
    assert free_ring(32, density=16000.0).error == pytest.approx(1.0 / np.sqrt(2.0) - 1.0, abs=1e-3)
    assert abs(column(-0.5).found[0] / column(0.5).expected[0] - 1.0) > 0.5
