"""The gate in words: a short Markdown summary for the page of a pull request or a job, and lines for a log.

Verified by tests/unit/test_workbench_gate_summary.py and tests/end_to_end/test_ci_gate.py.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from contracts.records import Check
from contracts.text import for_markdown
from workbench.verdict.baseline import NOISE, Baseline, Change, Kept
from workbench.verdict.number_format import displayed, displayed_reference

__all__ = ["Gate", "gate_lines", "gate_markdown", "gate_rows"]

_MOST = 15
"""Changes listed; more are counted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gate:
    """What a run says: its checks, and what changed since the report accepted last, if one was given."""

    study: str
    verdict: str
    checks: Sequence[Check]
    baseline: Baseline | None = None
    changes: Sequence[Change] = ()

    @property
    def failed(self) -> list[Check]:
        """Gates that did not pass."""
        return [check for check in self.checks if check.role == "gate" and check.status != "pass"]

    @property
    def given_up(self) -> list[Change]:
        """Changes that make the gate fail though no gate of this run does."""
        failed = {check.id for check in self.failed}
        return [change for change in self.changes if change.fails and change.check.id not in failed]

    @property
    def verdict_now(self) -> str:
        """The report's verdict, behind what the gate fails for though every gate of the run passed."""
        if not self.given_up:
            return self.verdict
        return f"{len(self.given_up)} given up of what was accepted. {self.verdict}"

    @property
    def holds(self) -> bool:
        """Whether nothing makes it fail."""
        return not self.failed and not self.given_up


def gate_lines(gate: Gate) -> list[str]:
    """Plain lines: every gate that did not pass, everything given up, and the verdict last."""
    lines = [f"BROKEN {c.id}: {c.claim} {_numbers(c)}" for c in gate.failed]
    lines += [f"GIVEN UP {c.check.id}: {c.kind}: {c.check.claim}" for c in gate.given_up]
    return [*lines, f"gate {'passed' if gate.holds else 'FAILED'}: {gate.verdict_now}"]


def gate_rows(gate: Gate) -> dict[str, Any]:
    """What ``summary.json`` holds beside the checks if a report was given to hold them against."""
    if gate.baseline is None:
        return {}
    rows = [
        {
            "id": change.check.id,
            "kind": change.kind,
            "fails": change.fails,
            "before": None if change.before is None else change.before.value,
            "now": None if change.now is None else change.now.value,
            "shift": change.shift,
        }
        for change in gate.changes
    ]
    return {"baseline": {"commit": gate.baseline.commit, "created": gate.baseline.created}, "changes": rows}


def gate_markdown(gate: Gate) -> str:
    """The summary: verdict, what broke with its claim and numbers, findings outside, what changed."""
    blocks = [f"## {'✅' if gate.holds else '❌'} Wheel workbench, {_cell(gate.study)}", gate.verdict_now]
    blocks += _failures(gate)
    outside = [c for c in gate.checks if c.role == "finding" and c.status != "pass"]
    if outside:
        rows = [f"| {_id(c.id)} | {_cell(c.claim)} | {_cell(_value(c))} | {_cell(_limit(c))} |" for c in outside]
        title = f"{len(outside)} findings outside their limits or not evaluated (no failure)"
        table = "\n".join(["| check | claim that does not hold | value | limit |", "|---|---|---|---|", *rows])
        blocks.append(f"<details><summary>{title}</summary>\n\n{table}\n\n</details>")
    return "\n\n".join([*blocks, *_since(gate)]) + "\n"


def _failures(gate: Gate) -> list[str]:
    if gate.holds:
        return []
    accepted = {} if gate.baseline is None else gate.baseline.checks
    rows = [
        f"| {_id(c.id)} | {_cell(c.claim)} | {_cell(_value(c))} | {_cell(_limit(c))} | {_before(accepted.get(c.id))} |"
        for c in gate.failed
    ]
    rows += [
        f"| {_id(c.check.id)} | {_cell(c.check.claim)} | {c.kind} | | {_before(c.before)} |" for c in gate.given_up
    ]
    return [
        "### Broken claims",
        "\n".join(["| gate | claim | value | limit | accepted |", "|---|---|---|---|---|", *rows]),
    ]


def _since(gate: Gate) -> list[str]:
    if gate.baseline is None:
        return []
    made = f"{gate.baseline.created[:16].replace('T', ' ')} UTC, commit {(gate.baseline.commit or 'unknown')[:12]}"
    title = f"### Since the accepted report ({_cell(made)})"
    others = [change for change in gate.changes if not change.fails]
    if not others:
        return [title, "Nothing else changed by more than the noise."]
    rows = [_row(change) for change in others[:_MOST]]
    more = [f"and {len(others) - _MOST} more in `summary.json`"] if len(others) > _MOST else []
    noise = f"A value has moved if it moved by more than {100.0 * NOISE:g} % of the room its tolerance leaves."
    table = "\n".join(["| check | change | accepted | now | share of its room |", "|---|---|---|---|---|", *rows])
    return [title, table, *more, noise]


def _row(change: Change) -> str:
    share = "" if change.shift is None else f"{100.0 * change.shift:.3g} %"
    return f"| {_id(change.check.id)} | {change.kind} | {_before(change.before)} | {_before(change.now)} | {share} |"


def _before(kept: Kept | None) -> str:
    return "–" if kept is None else f"{_cell(kept.status)}, {_cell(_value(kept))}"


def _numbers(check: Check) -> str:
    return f"[{check.quantity} {_value(check)}; {_limit(check)}]"


def _value(check: Check | Kept) -> str:
    return displayed(check.value, check.unit, check.quantity)


def _limit(check: Check) -> str:
    if check.tolerance.startswith("at "):
        return check.tolerance
    return f"{displayed_reference(check)}, {check.tolerance}"


def _cell(text: Any) -> str:
    return for_markdown(str(text))


def _id(id: str) -> str:
    """An identifier as code; one that an accepted report's file may have made up as text."""
    return f"`{id}`" if re.fullmatch(r"[A-Za-z0-9_.+-]+", id) else _cell(id)
