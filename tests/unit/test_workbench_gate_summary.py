"""The gate's words: what broke comes first, with its claim and numbers; what a page cannot take is escaped."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

from tests.unit.test_workbench_baseline import _check, _kept
from workbench.report.gate_summary import Gate, gate_lines, gate_markdown, gate_rows
from workbench.report.outputs import junit
from workbench.verdict.baseline import changes_since


def _gate(tmp_path: Path) -> Gate:
    """One gate broke, one is gone, a finding lies outside, one value moved."""
    accepted = _kept(tmp_path, _check(), _check(id="gone.gate"), _check(id="x.moved"))
    outside = _check(id="f", role="finding", status="fail", claim="A | holds.")
    checks = [_check(value=120.0, status="fail"), replace(outside), _check(id="x.moved", value=104.0)]
    changes = changes_since(accepted, checks)
    return Gate(study="s", verdict="1 of 2 gates did not pass.", checks=checks, baseline=accepted, changes=changes)


def test_markdown_names_what_broke_what_is_given_up_and_what_moved(tmp_path: Path) -> None:
    text = gate_markdown(_gate(tmp_path))
    assert text.startswith("## ❌ Wheel workbench, s\n\n1 given up of what was accepted. 1 of 2 gates did not pass.\n")
    assert "| `fe.balance` | Forces balance. | 120 N | 100 N, 10 % | pass, 100 N |" in text
    assert "| `gone.gate` | Forces balance. | gone | | pass, 100 N |" in text
    assert "| `f` | A \\| holds. |" in text
    assert "| `x.moved` | moved | pass, 100 N | pass, 104 N | 40 % |" in text
    assert "2026-11-22 01:00 UTC, commit abc" in text


def test_lines_and_rows_say_the_same(tmp_path: Path) -> None:
    gate = _gate(tmp_path)
    assert gate_lines(gate) == [
        "BROKEN fe.balance: Forces balance. [q 120 N; 100 N, 10 %]",
        "GIVEN UP gone.gate: gone: Forces balance.",
        "gate FAILED: 1 given up of what was accepted. 1 of 2 gates did not pass.",
    ]
    rows = gate_rows(gate)["changes"]
    assert [(row["id"], row["kind"], row["fails"]) for row in rows][:2] == [
        ("fe.balance", "broken", True),
        ("gone.gate", "gone", True),
    ]
    suite = ElementTree.fromstring(junit("s", gate.checks, gate.given_up))
    assert suite.get("failures") == "2"
    assert [case.get("name") for case in suite.iter("testcase") if case.find("failure") is not None] == [
        "fe.balance",
        "gone.gate",
    ]


def test_without_a_baseline_gates_alone_decide() -> None:
    gate = Gate(study="s", verdict="All 1 gates passed.", checks=[_check()])
    assert gate.holds
    assert gate_rows(gate) == {}
    assert gate_markdown(gate) == "## ✅ Wheel workbench, s\n\nAll 1 gates passed.\n"
    assert gate_lines(gate) == ["gate passed: All 1 gates passed."]
