"""Check that every run reached its target. Verified by tests/end_to_end/test_partial_curve.py."""

from __future__ import annotations

from collections.abc import Mapping

from contracts.records import Check
from workbench.verdict.rules import Claim, stated
from workbench.verdict.status import COMPLETE

__all__ = ["completeness_check"]


def completeness_check(early_ends: Mapping[str, str]) -> Check:
    """A gate: no finite element run ended before its target. ``early_ends``: task name -> reason."""
    named = f": {', '.join(early_ends)}; what rests on them is partial" if early_ends else ""
    claim = Claim(
        id=COMPLETE,
        title=f"FE: runs that did not converge to their end{named}",
        quantity="runs",
        unit="-",
        role="gate",
        source="no publication: guards every other number against resting on a curve that ended early",
    )
    return stated(claim, float(len(early_ends)), 0.0, "none", "error" if early_ends else "pass")
