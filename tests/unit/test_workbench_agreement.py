"""Verdicts: who agrees, by how much, how surely."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import ModelCurves, RunNumbers, UserCurve
from workbench.questions.models.agreement import Agreement, agreements, noted, verdict
from workbench.questions.models.metrics import compare_curves


@pytest.mark.parametrize(
    ("distance", "uncertainty", "expected"),
    [
        (0.05, 0.01, "agrees"),
        (0.095, 0.01, "undecided"),
        (0.105, 0.01, "undecided"),
        (0.12, 0.01, "differs"),
        (0.12, None, "not known"),
        (0.009, 0.01, "no difference"),
        (0.15, 0.20, "no difference"),
    ],
)
def test_a_difference_smaller_than_its_uncertainty_is_none(
    distance: float, uncertainty: float | None, expected: str
) -> None:
    assert verdict(distance, uncertainty, 0.10) == expected


def _check(name: str) -> Check:
    return Check(
        id=name,
        title="t",
        quantity="relative L2 difference",
        unit="-",
        value=0.12,
        reference=0.1,
        tolerance="at most 10 %",
        status="fail",
        role="finding",
        source="s",
        claim="It holds.",
        why="ours",
    )


def test_the_tolerance_names_uncertainty_and_verdict() -> None:
    known = Agreement(pair="brush", distance=0.12, uncertainty=0.0123, limit=0.1, verdict="differs")
    unknown = Agreement(pair="user_0", distance=0.12, uncertainty=None, limit=0.1, verdict="not known")
    names = ("brush_vs_fe.relative_l2", "user_0.relative_l2", "fe.reach")
    found = noted([_check(name) for name in names], {"brush": known, "user_0": unknown})
    assert [check.tolerance for check in found] == [
        "at most 10 %; numerical uncertainty ±1.2 %: differs",
        "at most 10 %; numerical uncertainty not known",
        "at most 10 %",
    ]
    assert {check.status for check in found} == {"fail"}


def _line(slope: float, orientation: float | None = None) -> StiffnessCurve:
    d = np.linspace(0.0, 0.03, 31)
    return StiffnessCurve(model="x", orientation_deg=orientation, deflection=d, load=slope * d)


@pytest.mark.parametrize(
    ("slope", "own", "mesh", "status"),
    [
        (8000.0, 0.03, 0.02, "pass"),  # 5 % off where 10 % are allowed
        (8000.0, 0.04, 0.04, "undecided"),  # 5.7 % together; each by itself would decide
        (8000.0, 0.04, None, "pass"),
        (8000.0, 0.06, None, "undecided"),
        (8000.0, 0.0, 0.06, "undecided"),
        (7200.0, 0.03, 0.02, "fail"),  # 16.7 % off, known to 3.8 %
        (7400.0, 0.03, 0.02, "undecided"),  # 13.5 %
        (9500.0, 0.30, 0.02, "undecided"),  # no difference that could be told, and none that could be excluded
    ],
)
def test_a_measured_curve_decides_as_far_as_both_are_known(
    slope: float, own: float, mesh: float | None, status: str
) -> None:
    reference, expected = _line(slope, 15.0), abs(8400.0 / slope - 1.0)
    curve = _line(8400.0, 15.0)
    fe = ModelCurves(
        model="fe",
        by_orientation={0.0: _line(1.0, 0.0), 15.0: curve},
        average=_line(4200.5),
        runs={0.0: RunNumbers(), 15.0: RunNumbers()},
    )
    user = UserCurve(
        label="rig", kind="measured", curve=reference, orientation_deg=15.0, uncertainty=own * reference.load
    )
    study = SimpleNamespace(relative_uncertainty=lambda d: np.full_like(d, mesh))
    known = None if mesh is None else cast(MeshStudy, study)
    judged = agreements({"user_0": compare_curves(curve, reference)}, fe, known, 0.10, [user])["user_0"]
    assert judged.distance == pytest.approx(expected)
    assert judged.own == pytest.approx(own)
    if mesh is not None:
        both = np.hypot(own, mesh * curve.load[-1] / reference.load[-1])
        assert judged.uncertainty == pytest.approx(both)
    found = replace(_check("user_0.relative_l2"), status="pass" if expected <= 0.10 else "fail", value=expected)
    (noted_check,) = noted([found], {"user_0": judged})
    assert noted_check.status == status
    assert "of the reference" in noted_check.tolerance


@pytest.mark.parametrize(("end", "status"), [(0.012, "undecided"), (0.018, "pass")])
def test_a_sliver_of_a_reference_judges_nothing(end: float, status: str) -> None:
    """Of a measured curve to 30 mm."""
    d = np.linspace(0.0, end, 31)
    curve = StiffnessCurve(model="fe", orientation_deg=None, deflection=d, load=8200.0 * d)
    reference = _line(8200.0)
    fe = ModelCurves(model="fe", by_orientation={}, average=curve, runs={})
    user = UserCurve(
        label="rig", kind="measured", curve=reference, orientation_deg=None, uncertainty=0 * reference.load
    )
    judged = agreements({"user_0": compare_curves(curve, reference)}, fe, None, 0.10, [user])
    (found,) = noted([replace(_check("user_0.relative_l2"), status="pass")], judged)
    assert found.status == status
    assert ("less than half of the reference" in found.tolerance) == (status == "undecided")
