"""Checks of the contact methods. Verified by tests/unit/test_workbench_contact.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from contracts.records import Check
from workbench.verdict.rules import Claim, at_most

__all__ = ["AUGMENTED", "largest_change", "penalty_check", "penetration_check"]

AUGMENTED = "augmented_lagrangian"
_LIMIT = 0.005
_DEEPEST = 1e-6


def largest_change(loads: Mapping[str, float]) -> float:
    """Largest |F / F_al - 1| of the study's penalty and ten times it, F_al with the augmented Lagrangian [-]."""
    return max(abs(loads[name] / loads[AUGMENTED] - 1.0) for name in ("1", "10"))


def penalty_check(loads: Callable[[], Mapping[str, float]], where: str) -> Check:
    """``loads`` gives loads [N] by factor on the penalty (``"0.1"``, ``"1"``, ``"10"``) and by `AUGMENTED`."""
    claim = Claim(
        id="fe.penalty_study",
        title=f"FE: load with the penalty, once and ten times, against the augmented Lagrangian, {where}",
        quantity="change of load",
        unit="-",
        role="gate",
        source="augmented Lagrangian, Simo & Laursen 1992, Comput. Struct. 42, 97-116; the limit is ours",
    )
    return at_most(claim, lambda: largest_change(loads()), _LIMIT)


def penetration_check(depth: Callable[[], float], where: str) -> Check:
    """``depth`` gives the largest penetration [m] that the augmented Lagrangian leaves anywhere on the faces."""
    claim = Claim(
        id="fe.penetration",
        title=f"FE: largest penetration anywhere on the faces with the augmented Lagrangian, up to {where}",
        quantity="penetration",
        unit="m",
        role="gate",
        source="Signorini's condition (Wriggers 2006): no point below the ground; the limit is ours",
    )
    return at_most(claim, depth, _DEEPEST)
