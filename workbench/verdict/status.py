"""What a report's checks come to. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

from collections.abc import Sequence

from contracts.records import Check, Status

__all__ = ["COMPLETE", "exit_status", "overall_status"]

COMPLETE = "fe.complete"
"""Identifier of the check that every run came to its end; its status ``error`` makes that of the whole report."""


def overall_status(checks: Sequence[Check]) -> Status:
    """``error`` if a run ended early, else what the gates say: ``fail``, also where one is undecided; ``error`` where
    one has no value; ``pass``."""
    if _ended_early(checks):
        return "error"
    gates = {c.status for c in checks if c.role == "gate"}
    return "fail" if gates & {"fail", "undecided"} else "error" if "error" in gates else "pass"


def exit_status(checks: Sequence[Check]) -> int:
    """0 if every gate passed, 2 if a run ended before its target, else 1."""
    if _ended_early(checks):
        return 2
    return 0 if overall_status(checks) == "pass" else 1


def _ended_early(checks: Sequence[Check]) -> bool:
    return any(c.id == COMPLETE and c.status == "error" for c in checks)
