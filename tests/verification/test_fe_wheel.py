"""Claim: the wheel's stiffness obeys the symmetries of its design, and its bookkeeping balances.

Source: the design itself (mirror planes, three-fold rotation). Tolerances: the meshes are equal up to rotation, so that
only round-off and the Newton tolerance (1e-8) separate the results: 1e-6 relative.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import ConvergenceError
from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact.obstacle import ObstacleTerm
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.solver.newton import NewtonOutcome, NewtonSolver
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel

DEFLECTIONS = (0.002, 0.005)


@functools.cache
def coarse_wheel(orientation_deg: float, *, half_width: bool = True) -> WheelResult:
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=half_width)
    case = WheelLoadCase(
        orientation_deg=orientation_deg, deflections=DEFLECTIONS, snapshot_loads=(20.0,), keep_points=True
    )
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)


def test_half_and_full_width_carry_the_same_load() -> None:
    half, full = coarse_wheel(0.0).curve, coarse_wheel(0.0, half_width=False).curve
    np.testing.assert_allclose(half.load, full.load, rtol=1e-6, atol=1e-9)
    for name in ("contact_area_m2", "contact_length_m", "max_von_mises_springs_outer_Pa", "spring_rim_gap_m"):
        np.testing.assert_allclose(half.columns[name], full.columns[name], rtol=1e-4, atol=1e-9, err_msg=name)


def test_a_grouser_tip_is_the_contact_area() -> None:
    """Standing on one grouser the patch is its tip, 1 mm x 120 mm, flanks excluded."""
    assert coarse_wheel(0.0).curve.columns["contact_area_m2"][-1] == pytest.approx(120e-6, rel=0.02)


def test_parts_keep_their_own_material_and_stress() -> None:
    """Stress by part differs; with springs twice as stiff the load rises, by less than twice."""
    curve = coarse_wheel(0.0).curve
    largest = [curve.columns[f"max_von_mises_{part}_Pa"][-1] for part in ("tire", "springs_outer", "springs_inner")]
    assert len(set(largest)) == 3
    assert largest[1] > 1.5 * largest[2]  # the outer springs stand over the ground
    stiff = replace(TI_6AL_4V, young_modulus=2.0 * TI_6AL_4V.young_modulus)
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    materials = dict.fromkeys(mesh.parts, TI_6AL_4V) | {"springs_outer": stiff, "springs_inner": stiff}
    other = solve_wheel(mesh, materials, WheelLoadCase(orientation_deg=0.0, deflections=DEFLECTIONS)).curve
    assert 1.1 < other.load[-1] / curve.load[-1] < 1.9


def test_the_run_ends_at_its_maximum_load() -> None:
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=0.0, deflections=(0.001, 0.002, 0.003, 0.006), maximum_load=15.0)
    result = solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
    assert result.curve.load[-2] < 15.0 <= result.curve.load[-1]
    assert result.curve.deflection[-1] < 0.006


def test_force_balance_is_measured_not_assumed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control of the balance: a contact force that is one per cent off shows as one per cent."""
    measured = StaticProblem.contact_force
    monkeypatch.setattr(StaticProblem, "contact_force", lambda self: 1.01 * measured(self))
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=0.0, deflections=(0.002,))
    result = solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
    assert result.curve.columns["force_imbalance"][-1] == pytest.approx(0.01 / 1.01, rel=0.01)


def test_moment_balance_is_measured_not_assumed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: a contact moment that is one per cent off shows."""
    measured = ObstacleTerm.moment
    monkeypatch.setattr(ObstacleTerm, "moment", lambda self: 1.01 * measured(self))
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=0.0, deflections=(0.002,))
    result = solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
    assert result.curve.columns["moment_imbalance"][-1] > 1e-4


@pytest.mark.parametrize("equal", [-15.0, 135.0])
def test_mirrored_and_rotated_orientations_are_equal(equal: float) -> None:
    np.testing.assert_allclose(coarse_wheel(15.0).curve.load, coarse_wheel(equal).curve.load, rtol=1e-6, atol=1e-9)


def test_other_orientations_differ() -> None:
    """Negative control: between a grouser under a spring and the gap beside it the load differs by far more."""
    assert abs(coarse_wheel(15.0).curve.load[-1] / coarse_wheel(0.0).curve.load[-1] - 1.0) > 0.02


def test_every_increment_converged_and_balances() -> None:
    curve = coarse_wheel(15.0).curve
    assert (curve.columns["relative_residual"][1:] <= 1e-8).all()
    assert (curve.columns["force_imbalance"] < 1e-6).all()
    assert (curve.columns["moment_imbalance"] < 1e-6).all()
    assert (np.diff(curve.load) > 0.0).all()
    assert (curve.columns["contact_area_m2"][1:] > 0.0).all()


def test_a_snapshot_is_taken_at_its_load() -> None:
    (snapshot,) = coarse_wheel(0.0).snapshots
    assert snapshot.load == pytest.approx(20.0, rel=0.02)
    lowest = np.argmin(snapshot.displacement[:, 2])
    assert np.abs(snapshot.displacement).max() < 2.0 * snapshot.deflection
    assert snapshot.displacement[lowest, 2] < 0.0 < snapshot.deflection
    curve = coarse_wheel(0.0).curve
    largest = np.max([curve.columns[f"max_von_mises_{part}_Pa"] for part in ("tire", "springs_outer")], axis=0)
    assert snapshot.von_mises.max() == pytest.approx(np.interp(20.0, curve.load, largest), rel=0.15)


def test_a_snapshot_leaves_the_curve_as_it_is() -> None:
    """Springs and rim touch; what the terms of contact found at the kept load belongs to no point of the curve."""
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=True)
    plain = WheelLoadCase(orientation_deg=15.0, deflections=(0.011, 0.019))
    without, kept = (
        solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
        for case in (plain, replace(plain, snapshot_loads=(110.0,)))
    )
    assert len(kept.snapshots) == 1
    assert without.curve.columns["inner_penetration_m"][-1] > 0.0
    for name, column in without.curve.columns.items():
        np.testing.assert_array_equal(kept.curve.columns[name], column, err_msg=name)


def test_fields_are_kept_at_every_point_of_the_curve() -> None:
    result = coarse_wheel(0.0)
    curve, points = result.curve, result.points
    np.testing.assert_array_equal([one.load for one in points], curve.load[1:])
    np.testing.assert_array_equal([one.deflection for one in points], curve.deflection[1:])
    lowest = [one.displacement[:, 2].min() for one in points]
    np.testing.assert_array_less(-np.array(DEFLECTIONS) * 1.5, lowest)
    assert lowest[1] < lowest[0] < 0.0
    (snapshot,) = result.snapshots
    assert points[0].load < snapshot.load < points[1].load
    assert points[0].von_mises.max() < snapshot.von_mises.max() < points[1].von_mises.max()


def test_a_run_that_does_not_converge_keeps_its_partial_curve(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver that gives up beyond 3 mm: the error carries the point at 2 mm, marked partial, and the history."""
    solve = NewtonSolver.solve

    def give_up(self: NewtonSolver, rise: float = 0.0) -> NewtonOutcome:
        outcome = solve(self, rise) if rise < 3e-3 and not limit_reached else None
        limit_reached.append(outcome is not None)
        return outcome or NewtonOutcome(converged=False, residuals=(1.0, 2.0), residual=np.zeros(1))

    limit_reached: list[bool] = []
    monkeypatch.setattr(NewtonSolver, "solve", give_up)
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=15.0, deflections=(2e-3, 5e-3))
    with pytest.raises(ConvergenceError, match=r"orientation 15 deg.*does not converge") as caught:
        solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
    partial = caught.value.last_good
    assert isinstance(partial, WheelResult)
    assert partial.curve.partial
    np.testing.assert_allclose(partial.curve.deflection, [0.0, 2e-3])
    assert sum(not record.converged for record in caught.value.history) > 5
