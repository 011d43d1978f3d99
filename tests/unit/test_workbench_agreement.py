"""Verdicts: who agrees, by how much, how surely."""

from __future__ import annotations

import pytest

from contracts.records import Check
from workbench.questions.models.agreement import Agreement, noted, verdict


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
