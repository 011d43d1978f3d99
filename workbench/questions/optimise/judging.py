"""Points of an optimisation against its limits: feasible or by how much not, cost, front of the trade-off.

The cost is the objective over that of the first point, with its sign, plus ten times what the limits are missed by,
relative to them: an exact penalty function (Nocedal and Wright, Numerical Optimization, 2nd edition, section 17.2; from
memory), whose least cost is the best feasible point as long as relaxing a limit by 1 % wins less than 10 % of the
objective. Verified by tests/unit/test_workbench_trade_offs.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from workbench.questions.sweep.results import Outcome, pivots_up_to
from workbench.study.optimise import OptimiseSection, Wish

__all__ = [
    "STABILITY",
    "WEIGHT",
    "Assessed",
    "Confirmed",
    "Limit",
    "Numbers",
    "assess",
    "best",
    "corrected",
    "front",
    "limits_of",
    "nearest",
]

type Numbers = Mapping[str, float | str | None]

_MISSING = 10.0
"""Relative miss of a limit whose number a point does not have because it has no curve."""
WEIGHT = 10.0
"""Cost of a relative miss of 1."""
STABILITY = "stability"
"""Name of the miss of a wheel that buckles, beside those of the limits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A number of the table that must lie between ``low`` and ``high``, SI; None where there is no such end."""

    name: str
    column: str
    low: float | None = None
    high: float | None = None

    def miss(self, value: float) -> float:
        """How far a value lies beyond an end, relative to it [-]; 0 within."""
        under = 0.0 if self.low is None else (self.low - value) / abs(self.low)
        over = 0.0 if self.high is None else (value - self.high) / abs(self.high)
        return max(under, over, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessed:
    """A point against the limits.

    Attributes
    ----------
    outcome : its curves by one model
    numbers : what the table tells of it; limited ones are None where an orientation does not bear the load
    objective : its value, in the unit of its column; None where it has none
    misses : of each limit, relative to it, and of `STABILITY` the share of the load that is not borne stably [-];
        0 where it holds
    """

    outcome: Outcome
    numbers: Numbers
    objective: float | None
    misses: Mapping[str, float]

    @property
    def number(self) -> int:
        """Of the point."""
        return self.outcome.run.point.number

    @property
    def feasible(self) -> bool:
        """Whether every limit holds, no orientation buckles up to the load and the objective is known."""
        return self.objective is not None and not any(self.misses.values())

    @property
    def missed(self) -> float:
        """What all limits and stability are missed by [-]."""
        return sum(self.misses.values())

    def cost(self, wish: Wish, scale: float) -> float:
        """What the search makes small [-]; ``scale`` is a usual size of the objective."""
        value = _MISSING if self.objective is None else wish.sign * self.objective / scale
        return value + WEIGHT * self.missed


@dataclass(frozen=True, slots=True, kw_only=True)
class Confirmed:
    """A point of the search that ran again: number of that point, and both models at the same orientations."""

    found: int
    fast: Assessed
    solid: Assessed


def limits_of(section: OptimiseSection) -> tuple[Limit, ...]:
    """The limits that a section states, in the order stiffness, utilisation, gap."""
    at, found = f"at_{section.load:g}N", []
    if (band := section.stiffness) is not None:
        found.append(Limit(name="stiffness", column=f"stiffness_{at}_N_per_m", low=band.low, high=band.high))
    if section.utilisation is not None:
        found.append(Limit(name="utilisation", column=f"utilisation_{at}", high=section.utilisation))
    if section.gap is not None:
        found.append(Limit(name="gap", column=f"gap_{at}_m", low=section.gap))
    return tuple(found)


def assess(outcome: Outcome, numbers: Numbers, section: OptimiseSection, limits: Sequence[Limit]) -> Assessed:
    """An outcome against limits and for stability.

    Where an orientation does not bear the load every limit is missed by 1 and the share that lacks, whatever the mean
    of the others says.
    """
    objective = numbers.get(section.objective.column)
    share = _share(outcome, section.load)
    lacking = _MISSING if share is None else 2.0 - share
    if lacking > 1.0:
        numbers = {**numbers, **dict.fromkeys(limit.column for limit in limits)}
    misses = {}
    for limit in limits:
        value = numbers.get(limit.column)
        known = isinstance(value, float) and math.isfinite(value)
        misses[limit.name] = limit.miss(value) if known and isinstance(value, float) else lacking
    misses[STABILITY] = _unstable(outcome, section.load)
    known_objective = float(objective) if isinstance(objective, float | int) else None
    return Assessed(outcome=outcome, numbers=numbers, objective=known_objective, misses=misses)


def _share(outcome: Outcome, load: float) -> float | None:
    """Part of the load that the weakest orientation comes to [-]; None without a curve."""
    if outcome.curve is None or not outcome.by_orientation:
        return None
    return min(1.0, min(float(curve.load.max()) for curve in outcome.by_orientation) / load)


def _unstable(outcome: Outcome, load: float) -> float:
    """Share of the load beyond the last point before a negative pivot, of the orientation where that is most [-].

    0 where there is none up to the load, or none is counted, as with friction.
    """
    most = 0.0
    for curve in outcome.by_orientation:
        counts = pivots_up_to(curve, load)
        if counts is not None and counts.any():
            most = max(most, 1.0 - float(curve.load[: int(np.argmax(counts > 0.0))].max(initial=0.0)) / load)
    return most


def best(points: Sequence[Assessed], wish: Wish) -> Assessed | None:
    """The feasible point that has the least, or the most; the first of equals."""
    feasible = [point for point in points if point.feasible]
    return min(feasible, key=lambda p: (wish.sign * (p.objective or 0.0), p.number)) if feasible else None


def nearest(points: Sequence[Assessed]) -> Assessed:
    """The point that misses the limits by least; one without a curve or an objective only where there is no other."""
    return min(points, key=lambda p: (p.outcome.curve is None, p.objective is None, p.missed, p.number))


def front(points: Sequence[Assessed], section: OptimiseSection) -> list[Assessed]:
    """Feasible points that no other beats in the objective and in what is traded for it, by the objective."""
    rows = [(p, section.objective.sign * p.objective, other) for p in points if p.feasible and p.objective is not None
            and (other := _trade(p, section)) is not None]  # fmt: skip
    found, least = [], math.inf
    for point, _, other in sorted(rows, key=lambda row: (row[1], row[2], row[0].number)):
        if other < least:
            found.append(point)
            least = other
    return found


def _trade(point: Assessed, section: OptimiseSection) -> float | None:
    value = point.numbers.get(section.trade.column)
    return section.trade.sign * value if isinstance(value, float | int) else None


def corrected(limits: Sequence[Limit], fast: Numbers, solid: Numbers) -> tuple[Limit, ...]:
    """Limits of the fast model that hold the solid one within the true ones, as both differ at one point.

    An end e becomes e times fast over solid; where a number is missing the limit stays.
    """
    found = []
    for limit in limits:
        a, b = fast.get(limit.column), solid.get(limit.column)
        if isinstance(a, float) and isinstance(b, float) and a > 0.0 and b > 0.0:
            low, high = (None if end is None else end * a / b for end in (limit.low, limit.high))
            limit = replace(limit, low=low, high=high)
        found.append(limit)
    return tuple(found)
