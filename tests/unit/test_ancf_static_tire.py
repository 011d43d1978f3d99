"""Static tire: balance, symmetry, both deformations, errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.motion.equilibrium import NewtonControls
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import TireEquilibria, solve_near, solve_tire, stiffness_curve
from contracts.errors import ConvergenceError, InputError

TIRE = build_tire(thesis_preset())
DEFLECTIONS = [0.0, 0.008, 0.016]


@pytest.fixture(scope="module")
def states() -> TireEquilibria:
    return solve_tire(TIRE, 0.3, DEFLECTIONS)


def test_hub_reaction_balances_the_contact_force(states: TireEquilibria) -> None:
    np.testing.assert_allclose(states.load, states.contact_load, atol=1e-7)
    assert states.load[1] > 10.0
    assert all(record.residuals[-1] <= 1e-10 for record in states.history)


def test_residual_falls_quadratically_at_the_end(states: TireEquilibria) -> None:
    last = states.history[-1].residuals
    assert last[-1] < 10.0 * last[-2] ** 1.5


def test_a_phase_turns_the_tire(states: TireEquilibria) -> None:
    turned = build_tire(replace(thesis_preset(), phase=0.25))
    np.testing.assert_allclose(solve_tire(turned, 0.55, DEFLECTIONS).load, states.load, atol=1e-7)


def test_deflection_counts_from_the_datum() -> None:
    """A face 2 mm farther out with the old datum: at 8 mm the new tire is 10 mm deep by its own radius."""
    large = replace(thesis_preset(), outer_radius=0.1445)
    moved = solve_tire(build_tire(replace(large, datum_radius=0.1425)), 0.3, [0.008])
    np.testing.assert_allclose(moved.load, solve_tire(build_tire(large), 0.3, [0.010]).load, atol=1e-7)


def test_from_a_neighbour_no_path_is_needed(states: TireEquilibria) -> None:
    other = build_tire(replace(thesis_preset(), young_modulus=290e3, rim_thickness=0.0245))
    near, path = solve_near(other, states), solve_tire(other, 0.3, DEFLECTIONS)
    np.testing.assert_allclose(near.load, path.load, atol=1e-6)
    assert not near.history


def test_a_neighbour_too_far_away_means_the_path(states: TireEquilibria) -> None:
    """Coordinates of no equilibrium at all: Newton does not arrive from there, and the path is followed."""
    broken = replace(states, coordinates=-5.0 * states.coordinates)
    found = solve_near(TIRE, broken)
    np.testing.assert_allclose(found.load, states.load, atol=1e-6)
    assert found.history


def test_coordinates_are_kept_at_each_deflection(states: TireEquilibria) -> None:
    np.testing.assert_array_equal(states.at(0.008), states.coordinates[1])
    np.testing.assert_allclose(states.at(0.0), TIRE.mesh.reference_coordinates(), atol=1e-12)
    with pytest.raises(InputError, match="was not solved"):
        states.at(0.009)


def test_curve_has_both_deformations(states: TireEquilibria) -> None:
    curve = states.curve(source="test")
    columns = curve.columns
    np.testing.assert_allclose(columns["tire_deformation_m"] + columns["penetration_m"], DEFLECTIONS, atol=1e-15)
    assert np.all(columns["penetration_m"] <= columns["penetration_max_m"])
    assert 0.0 < columns["penetration_m"][2] < DEFLECTIONS[2]
    assert columns["newton_iterations"].sum() == sum(len(r.residuals) - 1 for r in states.history)
    assert curve.orientation_deg == pytest.approx(np.degrees(0.3))


@pytest.mark.parametrize("phi_deg", [30.0, 60.0, 120.0, -30.0])
def test_curve_repeats_every_spoke_and_mirrors(phi_deg: float) -> None:
    expected = solve_tire(TIRE, np.radians(30.0), DEFLECTIONS).load
    np.testing.assert_allclose(solve_tire(TIRE, np.radians(phi_deg), DEFLECTIONS).load, expected, atol=1e-7)


def test_result_does_not_depend_on_the_increments() -> None:
    assert solve_tire(TIRE, 0.0, [0.016]).load[0] == pytest.approx(
        solve_tire(TIRE, 0.0, np.arange(1, 17) * 1e-3).load[-1], rel=1e-9
    )


def test_source_states_mesh_and_contact_grid() -> None:
    source = stiffness_curve(thesis_preset(), 0.0, [0.0, 0.001]).source
    assert "4 circumferential + 4 radial plates" in source
    assert "edges included" in source


@pytest.mark.parametrize("deflections", [[], [0.01, 0.01], [-0.001, 0.01], [0.01, 0.0925], [np.nan]])
def test_bad_deflections_are_refused(deflections: list[float]) -> None:
    with pytest.raises(InputError, match="deflections"):
        solve_tire(TIRE, 0.0, deflections)


def test_bad_orientation_is_refused() -> None:
    with pytest.raises(InputError, match="orientation"):
        solve_tire(TIRE, np.inf, DEFLECTIONS)


def test_failure_carries_history_and_last_good_state() -> None:
    controls = NewtonControls(max_iterations=1, smallest_step=1e-3)
    with pytest.raises(ConvergenceError, match="phi = 0 deg") as caught:
        solve_tire(TIRE, 0.0, [0.0, 0.02], controls)
    assert not caught.value.history[-1].converged
    assert caught.value.last_good.deflection.tolist() == [0.0]


def test_collapse_of_a_spoke_is_an_error_not_a_curve() -> None:
    """Near 58 mm a plate turns inside out: the run stops there with what it had."""
    with pytest.raises(ConvergenceError, match="inverted") as caught:
        solve_tire(TIRE, 0.0, np.arange(5, 90, 5) * 1e-3, NewtonControls(smallest_step=1e-3))
    assert caught.value.last_good.deflection[-1] == pytest.approx(0.055)
