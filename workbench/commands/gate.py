"""The report as a gate of continuous integration: what changed since the accepted one, in plain words.

Verified by tests/end_to_end/test_ci_gate.py.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from contracts.records import Check
from workbench.execution.terminal import Terminal
from workbench.report.gate_summary import Gate, gate_lines, gate_markdown
from workbench.verdict.baseline import Baseline, changes_since

__all__ = ["GateChoices", "gate_of", "plain_console", "tell"]

_JOB_SUMMARY = "GITHUB_STEP_SUMMARY"
"""Environment variable with the path of the file whose Markdown GitHub shows on the job's page."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GateChoices:
    """What the command line asks for: plain output for logs, and the folder of the accepted report or None."""

    ci: bool = False
    baseline: Path | None = None


def plain_console() -> Terminal:
    """Console of a log: no bars, no colours, lines as long as they are."""
    return Terminal(force_terminal=False, no_color=True, soft_wrap=True)


def gate_of(study: str, verdict: str, checks: Sequence[Check], baseline: Baseline | None) -> Gate:
    """The run's checks beside the accepted ones."""
    changes = () if baseline is None else changes_since(baseline, checks)
    return Gate(study=study, verdict=verdict, checks=checks, baseline=baseline, changes=changes)


def tell(gate: Gate, console: Terminal) -> None:
    """Print the gate's lines and add its summary to the job's page, where there is one."""
    for line in gate_lines(gate):
        console.print(line)
    page = os.environ.get(_JOB_SUMMARY)
    if page:
        with Path(page).open("a", encoding="utf-8") as stream:
            stream.write(gate_markdown(gate))
