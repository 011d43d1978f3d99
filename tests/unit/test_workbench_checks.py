"""Checks on synthetic curves: each passes on a sound set and fails on a damaged one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, average_curve
from contracts.errors import IncrementRecord
from contracts.records import Check
from geometry.measures import MeshQuality
from workbench.questions.ancf.preset_table import preset_table
from workbench.questions.ancf.question import ancf_checks, preset_error
from workbench.questions.fe.checks import reach_check, spread_checks
from workbench.questions.model_curves import ModelCurves, RunNumbers, UserCurve
from workbench.questions.models.metrics import CurveMetrics
from workbench.questions.models.question import agreement_checks, user_checks
from workbench.questions.strength.question import yield_check
from workbench.questions.wheel.question import MeshNumbers, mesh_checks
from workbench.study.sections import ToleranceSection
from workbench.verdict.status import exit_status, overall_status

TOLERANCES = ToleranceSection()
D = np.linspace(0.0, 0.036, 37)


def _fe_curve(orientation: float, slope: float, **columns: float) -> StiffnessCurve:
    shape = D - 2.0 * D**2
    values = {"force_imbalance": 1e-9, "moment_imbalance": 1e-9, "max_von_mises_tire_Pa": 4e8} | columns
    return StiffnessCurve(
        model="fe",
        orientation_deg=orientation,
        deflection=D,
        load=slope * shape,
        columns={name: np.full_like(D, value) for name, value in values.items()},
    )


def _fe(slopes: tuple[float, ...] = (8600.0, 8000.0), residual: float = 1e-9, **columns: float) -> ModelCurves:
    curves = {float(i): _fe_curve(float(i), slope, **columns) for i, slope in enumerate(slopes)}
    record = IncrementRecord(target=0.01, step=0.01, converged=True, residuals=(1.0, residual))
    failed = IncrementRecord(target=0.02, step=0.01, converged=False, residuals=(1.0, 0.5))
    runs = dict.fromkeys(curves, RunNumbers(increments=(failed, record)))
    return ModelCurves(model="fe", by_orientation=curves, average=average_curve(list(curves.values())), runs=runs)


def _by_id(checks: list[Check]) -> dict[str, Check]:
    assert len({c.id for c in checks}) == len(checks)
    return {c.id: c for c in checks}


def test_reach_fails_for_a_run_that_stopped_early() -> None:
    check = reach_check(_fe(), ToleranceSection(reach_deflection="40 mm", reach_load="400 N"))
    assert (check.status, check.role) == ("fail", "finding")
    assert check.value == pytest.approx(0.9)
    assert reach_check(_fe(), TOLERANCES).role == "finding"


def test_spread_and_yield_are_findings() -> None:
    spread = _by_id(spread_checks(_fe((9000.0, 4000.0)), TOLERANCES, 0.036))
    assert [c.status for c in spread.values()] == ["fail"] * 3
    assert spread["fe.spread_20mm"].value == pytest.approx(5000.0 / 6500.0)
    assert yield_check(_fe(), {"tire": 880e6}, 250.0).status == "pass"
    over = yield_check(_fe(max_von_mises_tire_Pa=9e8), {"tire": 880e6}, 250.0)
    assert (over.status, over.role) == ("fail", "finding")


@pytest.mark.parametrize(
    ("stress", "uncertainty", "status"),
    [(8e8, 0.09, "pass"), (8e8, 0.11, "undecided"), (9.5e8, 0.07, "fail"), (9.5e8, 0.09, "undecided"),
     (9.7e8, 0.09, "fail")],
)  # fmt: skip
def test_yield_is_undecided_where_the_mesh_could_turn_it_round(stress: float, uncertainty: float, status: str) -> None:
    check = yield_check(_fe(max_von_mises_tire_Pa=stress), {"tire": 880e6}, 250.0, uncertainty)
    assert check.status == status
    assert f"±{100.0 * uncertainty:.2g} %" in check.tolerance


def test_a_spread_is_asked_of_several_orientations_and_where_the_study_goes() -> None:
    fe = _fe()
    one = replace(fe, by_orientation={0.0: fe.by_orientation[0.0]})
    assert spread_checks(one, ToleranceSection(), 0.036) == []
    assert {c.status for c in spread_checks(one, ToleranceSection(), 0.036, of_the_thesis=True)} == {"error"}
    assert [c.id for c in spread_checks(fe, TOLERANCES, 0.020)] == ["fe.spread_5mm", "fe.spread_20mm"]


def test_yield_of_a_curve_too_short_is_not_evaluated() -> None:
    short = _fe((8600.0, 7000.0))  # 234 N at 36 mm
    assert yield_check(short, {"tire": 880e6}, 250.0).status == "error"
    assert yield_check(short, {"tire": 880e6}, 230.0).status == "pass"


def _quality(smallest: float) -> MeshQuality:
    return MeshQuality(
        n_points=8,
        n_cells=1,
        order=1,
        min_scaled_jacobian=smallest,
        mean_scaled_jacobian=0.95,
        min_edge=1e-3,
        max_edge=1e-3,
        max_aspect_ratio=1.0,
    )


def test_mesh_checks_catch_lost_mass_and_bad_cells() -> None:
    whole = MeshNumbers(
        quality=_quality(0.9),
        parts={},
        volume=1.0,
        volume_closed_form=1.0005,
        mass=1.0,
        mass_closed_form=1.0005,
        hash="",
    )
    assert {c.status for c in mesh_checks(whole, whole, TOLERANCES)} == {"pass"}
    damaged = replace(whole, mass=0.998, quality=_quality(-0.1))
    failing = {c.id for c in mesh_checks(whole, damaged, TOLERANCES) if c.status == "fail"}
    assert failing == {"mesh.mass", "mesh.min_scaled_jacobian"}


def _ancf(scale: float = 1.0, mass: float = 4.426) -> ModelCurves:
    """The table itself, times a factor."""
    table = preset_table()
    curves = {
        o: StiffnessCurve(model="ancf", orientation_deg=o, deflection=table[:, 0], load=scale * table[:, 1 + i])
        for i, o in enumerate((0.0, 45.0))
    }
    average = average_curve(list(curves.values()))
    runs = dict.fromkeys(curves, RunNumbers(flexible_mass=mass))
    return ModelCurves(model="ancf", by_orientation=curves, average=average, runs=runs)


def test_ancf_preset_is_held_against_its_table() -> None:
    assert {c.status for c in ancf_checks(_ancf(), TOLERANCES)} == {"pass"}
    assert preset_error(_ancf(1.02), 0.0) == pytest.approx(0.02, rel=1e-9)
    for row, off, error in ((0, 0.06, 0.012), (1, 0.073, 0.01)):  # 0 N counts absolutely, 7.3 N relative to itself
        ancf = _ancf()
        ancf.by_orientation[45.0].load[row] += off
        assert preset_error(ancf, 45.0) == pytest.approx(error, rel=1e-6)
    failing = {c.id for c in ancf_checks(_ancf(1.02, mass=4.0), TOLERANCES) if c.status == "fail"}
    assert failing == {"ancf.preset_phi000", "ancf.preset_phi045", "ancf.flexible_mass"}


def test_ancf_preset_without_its_orientations_cannot_be_evaluated() -> None:
    ancf = _ancf()
    one = ModelCurves(
        model="ancf",
        by_orientation={0.0: ancf.by_orientation[0.0]},
        average=ancf.by_orientation[0.0],
        runs=ancf.runs,
    )
    assert _by_id(ancf_checks(one, TOLERANCES))["ancf.preset_phi045"].status == "error"


def test_agreement_and_user_checks_are_findings() -> None:
    numbers = CurveMetrics(
        start=0.0,
        end=0.03,
        relative_l2=0.2,
        max_error=10.0,
        max_error_at=0.03,
        tangent=9000.0,
        tangent_reference=8250.0,
        reference_load=231.0,
    )
    metrics = {"ancf_average": numbers, "brush": numbers, "user_0": replace(numbers, relative_l2=0.05)}
    checks = _by_id(agreement_checks(["ancf", "brush"], metrics, TOLERANCES))
    assert {c.role for c in checks.values()} == {"finding"}
    assert {c.id for c in checks.values() if c.status == "fail"} == {
        "ancf_vs_fe.relative_l2",
        "brush_vs_fe.relative_l2",
    }
    assert all("0.0 to 30.0 mm" in c.title and "up to 231 N" in c.source for c in checks.values())
    curve = replace(_fe_curve(0.0, 8000.0), source="a paper")
    user = UserCurve(label="paper", kind="published", curve=curve, orientation_deg=None, uncertainty=np.zeros_like(D))
    (check,) = user_checks([user], metrics, TOLERANCES)
    assert check.source == "published: a paper"
    assert (check.status, check.role) == ("pass", "finding")


def _check(role: str, status: str) -> Check:
    return Check(
        id=f"{role}.{status}",
        title="t",
        quantity="q",
        unit="-",
        value=None if status == "error" else 1.0,
        reference=1.0,
        tolerance="1 %",
        status=status,  # type: ignore[arg-type]
        role=role,  # type: ignore[arg-type]
        source="s",
        claim="It holds.",
        why="ours",
    )


@pytest.mark.parametrize(
    ("checks", "status", "exit_code"),
    [
        ([("gate", "pass"), ("finding", "fail"), ("finding", "error")], "pass", 0),
        ([("gate", "pass"), ("gate", "fail"), ("gate", "error")], "fail", 1),
        ([("gate", "pass"), ("gate", "error")], "error", 1),
    ],
)
def test_only_gates_decide_the_verdict(checks: list[tuple[str, str]], status: str, exit_code: int) -> None:
    made = [_check(*pair) for pair in checks]
    assert overall_status(made) == status
    assert exit_status(made) == exit_code
