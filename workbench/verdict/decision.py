"""Yes, no or undecided: what several checks come to. Verified by tests/unit/test_workbench_answers.py."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from contracts.records import Check

__all__ = ["Decision", "decided", "together"]

Decision = Literal["yes", "no", "undecided"]


def decided(check: Check) -> Decision:
    """Of one check: what was not evaluated is undecided."""
    return "yes" if check.status == "pass" else "no" if check.status == "fail" else "undecided"


def together(decisions: Iterable[Decision]) -> Decision:
    """No if one says no; yes if every one does, and there is one; else undecided."""
    found = set(decisions)
    return "no" if "no" in found else "yes" if found == {"yes"} else "undecided"
