"""An optimisation's points and limits in words. Verified by tests/unit/test_workbench_trade_offs.py."""

from __future__ import annotations

from collections.abc import Sequence

from workbench.questions.optimise.judging import STABILITY, Assessed, Confirmed, Limit, limits_of
from workbench.questions.sweep.words import column_of
from workbench.study.optimise import OptimiseSection

__all__ = ["limited", "told_buckling", "told_difference", "told_limits", "told_number", "told_point", "told_verdict"]


def told_number(name: str, value: float | str | None) -> str:
    """``"stiffness at 150 N 8.123 N/mm"``."""
    column = column_of(name)
    label, _, unit = column.label.removesuffix("]").partition(" [")
    if not isinstance(value, float | int):
        return f"{label} unknown"
    return f"{label} {column.factor * value:.4g} {unit}".removesuffix(" -")


def told_point(point: Assessed, section: OptimiseSection) -> str:
    """Number of a point, its objective and the numbers that are limited; by how much it misses a limit; buckling."""
    names = [section.objective.column, *limited(section)]
    told = ", ".join(told_number(name, point.numbers.get(name)) for name in dict.fromkeys(names))
    missed = ", ".join(f"{name} by {100.0 * miss:.2g} %" for name, miss in _limits_missed(point).items())
    early = f" ({point.outcome.note})" if point.outcome.note else ""
    both = "".join(f"; {words}" for words in (missed and f"misses {missed}", told_buckling(point, section)) if words)
    return f"{point.number}: {told}{both}{early}"


def told_buckling(point: Assessed, section: OptimiseSection) -> str:
    """``"buckles past 130 N"``, the last load borne without a negative pivot; ``""`` of a wheel that does not."""
    lacking = point.misses[STABILITY]
    return f"buckles past {(1.0 - lacking) * section.load:.4g} N" if lacking else ""


def told_verdict(point: Assessed) -> str:
    """``"within the limits"``, or what of ``"breaks a limit"``, ``"buckles"`` and ``"has no objective"`` is so."""
    found = [*(["breaks a limit"] if _limits_missed(point) else []), *(["buckles"] if point.misses[STABILITY] else [])]
    found += ["has no objective"] if point.objective is None else []
    return " and ".join(found) or "within the limits"


def _limits_missed(point: Assessed) -> dict[str, float]:
    return {name: miss for name, miss in point.misses.items() if miss and name != STABILITY}


def told_limits(limits: Sequence[Limit]) -> str:
    """``"stiffness at 150 N 8.0 to 9.0 N/mm, utilisation at 150 N at most 1"``."""
    told = []
    for limit in limits:
        column = column_of(limit.column)
        label, _, unit = column.label.removesuffix("]").partition(" [")
        ends = [None if end is None else f"{column.factor * end:.4g}" for end in (limit.low, limit.high)]
        both = f"{ends[0]} to {ends[1]}" if all(ends) else f"at least {ends[0]}" if ends[0] else f"at most {ends[1]}"
        told.append(f"{label} {both} {unit}".removesuffix(" -"))
    return ", ".join(told)


def told_difference(one: Confirmed, section: OptimiseSection) -> str:
    """By how much the fast model lies off the solid one in each number that counts, at the same orientations."""
    told = []
    for name in dict.fromkeys([*limited(section), section.trade.column]):
        fast, solid = one.fast.numbers.get(name), one.solid.numbers.get(name)
        if isinstance(fast, float) and isinstance(solid, float) and solid:
            told.append(f"{column_of(name).label.partition(' [')[0]} {100.0 * (fast / solid - 1.0):+.2g} %")
    return ", ".join(told)


def limited(section: OptimiseSection) -> list[str]:
    """Columns that have a limit."""
    return [limit.column for limit in limits_of(section)]
