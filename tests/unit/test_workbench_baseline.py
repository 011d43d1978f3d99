"""What counts as a change since the accepted report, and which changes make the gate fail.

Source: the rules of workbench/verdict/baseline.py and docs/ci_gate.md. Negative control: a report held against
itself has no change.
"""

from __future__ import annotations

import json
from dataclasses import replace
from math import nan
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from contracts.records import Check
from workbench.commands.accept import run_accept
from workbench.report.evidence import Evidence
from workbench.report.outputs import summary, to_json
from workbench.verdict.baseline import Baseline, changes_since, read_baseline


def _check(**changed: Any) -> Check:
    made = Check(
        id="fe.balance",
        title="t",
        quantity="q",
        unit="N",
        value=100.0,
        reference=100.0,
        tolerance="10 %",
        status="pass",
        role="gate",
        source="s",
        claim="Forces balance.",
        why="ours",
    )
    return replace(made, **changed)


def _kept(folder: Path, *checks: Check, study: str = "s") -> Baseline:
    evidence = [Evidence(check=check, section="fe", tasks={}, files=()) for check in checks]
    text = to_json(summary(study, evidence, [], {"commit": "abc", "created": "2026-11-22T01:00:00+00:00"}, {}))
    (folder / "summary.json").write_text(text, encoding="utf-8")
    return read_baseline(folder, study)


MOST = {"reference": 10.0, "tolerance": "at most 10 N", "value": 5.0}
LEAST = {"reference": 10.0, "tolerance": "at least 10 N", "value": 50.0}
BAND = {"reference": (90.0, 110.0), "tolerance": "inside the band"}


@pytest.mark.parametrize(
    ("before", "now", "kind", "fails"),
    [
        ({}, {"value": 120.0, "status": "fail"}, "broken", True),
        ({}, {"value": None, "status": "error"}, "broken", True),
        ({}, {"role": "finding"}, "no gate any more", True),
        ({}, {"unit": "kN"}, "measures something else", True),
        ({}, {"tolerance": "at most 100 N"}, "measures something else", True),
        ({}, {"tolerance": "12 %"}, "looser limit", True),
        ({}, {"reference": 111.0}, "looser limit", True),
        (MOST, {**MOST, "reference": 11.0}, "looser limit", True),
        (LEAST, {**LEAST, "reference": 9.0}, "looser limit", True),
        (BAND, {**BAND, "reference": (88.0, 110.0)}, "looser limit", True),
        ({}, {"value": 100.2}, "moved", False),
        (MOST, {**MOST, "value": 5.2}, "moved", False),
        (BAND, {**BAND, "value": 100.2}, "moved", False),
        ({"role": "finding"}, {"role": "finding", "value": 120.0, "status": "fail"}, "status", False),
        ({"status": "fail", "value": 120.0}, {}, "status", False),
    ],
)
def test_each_kind_of_change(
    tmp_path: Path, before: dict[str, Any], now: dict[str, Any], kind: str, fails: bool
) -> None:
    (change,) = changes_since(_kept(tmp_path, _check(**before)), [_check(**now)])
    assert (change.kind, change.fails) == (kind, fails)
    assert change.check.claim == "Forces balance."


@pytest.mark.parametrize(
    ("before", "now"),
    [
        ({}, {}),
        ({}, {"value": 100.09}),
        ({}, {"tolerance": "5 %"}),
        (MOST, {**MOST, "reference": 10.4}),
        (MOST, {**MOST, "reference": 5.5}),
        (LEAST, {**LEAST, "reference": 20.0}),
        (BAND, {**BAND, "reference": (95.0, 105.0)}),
    ],
)
def test_noise_and_stricter_limits_are_no_change(tmp_path: Path, before: dict[str, Any], now: dict[str, Any]) -> None:
    assert changes_since(_kept(tmp_path, _check(**before)), [_check(**now)]) == ()


def test_gone_and_new_and_their_order(tmp_path: Path) -> None:
    accepted = _kept(tmp_path, _check(), _check(id="a"), _check(id="b", role="finding"), _check(id="c"))
    found = changes_since(accepted, [_check(value=105.0), _check(id="c", value=103.0), _check(id="d")])
    assert [(c.check.id, c.kind, c.fails) for c in found] == [
        ("a", "gone", True),
        ("fe.balance", "moved", False),
        ("c", "moved", False),
        ("b", "gone", False),
        ("d", "new", False),
    ]
    assert [c.shift for c in found][1:3] == [pytest.approx(0.5), pytest.approx(0.3)]


def test_a_baseline_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"workbench accept"):
        read_baseline(tmp_path, "s")
    _kept(tmp_path, _check())
    with pytest.raises(InputError, match=r"is of study 's', not 'other'"):
        read_baseline(tmp_path, "other")
    path = tmp_path / "summary.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    for broken in ("[]", "{", "{}", json.dumps(content | {"checks": [{"id": "a"}]})):
        path.write_text(broken, encoding="utf-8")
        with pytest.raises(InputError, match=r"is no summary of a report|JSON"):
            read_baseline(tmp_path, "s")
    (row,) = content["checks"]
    damaged = [
        content | {"schema": 99},
        *(content | {"checks": [row | change]} for change in ({"role": "gaet"}, {"status": "passed"}, {"value": nan})),
        content | {"checks": [row, row]},
        *(content | {"checks": [row | {"reference": ends}]} for ends in ([nan, 1], ["1", "2"], [2, 1], [1, 2, 3])),
        *(content | {"checks": [row | {"tolerance": words}]} for words in ("1.2.3 %", "e %", "... %")),
        *(content | {"provenance": content["provenance"] | {"commit": commit}} for commit in (5, True, {"a": 1})),
        *(content | {"schema": schema} for schema in (True, 1.0, "2")),
        content | {"study": 5},
    ]
    for one in damaged:
        path.write_text(json.dumps(one), encoding="utf-8")
        with pytest.raises(InputError, match=r"^report .*(is no summary of a report|not finite|NaN)"):
            read_baseline(tmp_path, "s", "report")


def test_a_summary_of_earlier_versions_has_titles_for_claims(tmp_path: Path) -> None:
    _kept(tmp_path, _check())
    path = tmp_path / "summary.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    del content["checks"][0]["claim"]
    path.write_text(json.dumps(content), encoding="utf-8")
    assert read_baseline(tmp_path, "s").checks["fe.balance"].claim == "t"


def test_a_report_with_a_broken_gate_or_none_at_all_is_not_accepted(tmp_path: Path) -> None:
    """Whatever the summary says of itself: it may have been edited, or written by an earlier version."""
    report, baseline = tmp_path / "report", tmp_path / "baseline"
    report.mkdir()
    _kept(report, _check(), _check(id="fe.energy", status="error", value=None))
    text = (report / "summary.json").read_text(encoding="utf-8")
    (report / "summary.json").write_text(json.dumps(json.loads(text) | {"status": "pass"}), encoding="utf-8")
    with pytest.raises(InputError, match=r"\(fe\.energy\): must have passed its gates"):
        run_accept(report, baseline)
    _kept(report)
    with pytest.raises(InputError, match="holds no checks"):
        run_accept(report, baseline)
    assert not baseline.exists()
    _kept(report, _check(), _check(id="fe.mass", role="finding", status="fail"))
    assert run_accept(report, baseline) == 0
    assert (baseline / "summary.json").read_bytes() == (report / "summary.json").read_bytes()
