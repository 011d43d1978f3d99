"""The rounds of ``workbench optimise``: search by the fast model, confirm by the solid one, correct the limits, again.

Verified by tests/end_to_end/test_optimise.py.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError, StudyError
from workbench.commands.computing import console
from workbench.commands.point_batches import PointBatches
from workbench.execution.progress import duration_text
from workbench.questions.optimise.judging import (
    Assessed,
    Confirmed,
    Limit,
    Numbers,
    assess,
    best,
    corrected,
    front,
    limits_of,
    nearest,
)
from workbench.questions.optimise.linearised import proposal
from workbench.questions.optimise.words import told_limits, told_point, told_verdict
from workbench.questions.sweep.results import Outcome, measured
from workbench.questions.sweep.search import Strategy
from workbench.study.optimise import OptimiseSection
from workbench.study.orientation import degrees
from workbench.study.sweep import Value
from workbench.study.sweep_points import drawn_values, place_of, study_point

__all__ = ["Optimised", "require_step", "search_and_confirm"]

_LATER_STEP = 0.1
"""Standard deviation of a later round's first batch over range [-]: it begins where the last one ended."""
_FIRST_REACH = 0.2
"""Move limit of the linear programme, as a part of the ranges: halved where it wins nothing, else doubled again."""


@dataclass(slots=True, kw_only=True)
class Optimised:
    """What an optimisation found.

    Attributes
    ----------
    limits : of each round's search; those of the first are the section's
    searched : every point of the searches, the study as it is first, with its numbers
    round_of : number of a point -> round that chose it
    confirmed : points that ran again
    answer : the best confirmed point within the section's limits, or where nothing is confirmed the best of the search
    """

    limits: list[tuple[Limit, ...]] = field(default_factory=list)
    searched: list[tuple[Outcome, Numbers]] = field(default_factory=list)
    round_of: dict[int, int] = field(default_factory=dict)
    confirmed: list[Confirmed] = field(default_factory=list)
    answer: Assessed | None = None

    def assessed(self, section: OptimiseSection) -> list[Assessed]:
        """Every point of the searches against the limits of the last one."""
        return [assess(outcome, numbers, section, self.limits[-1]) for outcome, numbers in self.searched]


def search_and_confirm(batches: PointBatches, section: OptimiseSection) -> Optimised:
    """Search, and as long as the best point breaks a limit by the solid model, search again with limits corrected.

    Raises
    ------
    StudyError
        If no point of the first batch is a wheel, or none has an objective.
    """
    return _Rounds(batches, section).run()


class _Rounds:
    """One optimisation while it runs."""

    def __init__(self, batches: PointBatches, section: OptimiseSection) -> None:
        self.batches, self.section, self.sweep = batches, section, section.as_sweep
        self.found = Optimised(limits=[limits_of(section)])
        self.places: dict[int, NDArray[np.float64]] = {}
        self.next = 1

    def _numbers(self, outcome: Outcome) -> Numbers:
        """Columns of a sweep's table."""
        return measured(outcome, self.sweep, self.batches.study.tangent_up_to)

    def run(self) -> Optimised:
        """Every round."""
        section, found = self.section, self.found
        for number in range(1 + section.rounds):
            self._search(number)
            chosen = self._chosen()
            if not chosen:
                missing = nearest(found.assessed(section))
                console.print(f"no point is within the limits; nearest: {told_point(missing, section)}", soft_wrap=True)
                return found
            if section.confirm == 0:
                found.answer = chosen[0]
                return found
            first = self._confirm(chosen if number == 0 else chosen[:1])
            if first is None:
                console.print("the search ends at points that have been confirmed already; it is given up")
                return found
            found.answer = best([one.solid for one in found.confirmed], section.objective)
            if first.solid.feasible or number == section.rounds:
                return found
            fast = next(numbers for o, numbers in found.searched if o.run.point.number == first.found)
            found.limits.append(corrected(found.limits[0], fast, first.solid.numbers))
            told = told_limits(found.limits[-1])
            why = f"the solid model {told_verdict(first.solid)}"
            console.print(f"{why}; searched again for {told} by {section.model}", soft_wrap=True)
        return found

    def _search(self, number: int) -> None:
        """One search from the study as it is, or from the last one's best point."""
        section, sweep = self.section, self.sweep
        start, step, samples = place_of(sweep, self.batches.base), section.first_step, section.samples
        if number > 0:
            points = self.found.assessed(section)
            here = best(points, section.objective) or nearest(points)
            start, step = self.places.get(here.number, start), _LATER_STEP * section.first_step / 0.3
            samples = max(section.batch, section.samples // 2)
        strategy = Strategy(start=start, batch=section.batch, seed=section.seed + number, step=step)
        done, spent, computed, reach = 0, 0.0, 0, _FIRST_REACH
        while done < samples:
            more = self._proposed(reach)
            asked, begun = strategy.ask(more), time.monotonic()
            self.places |= dict(enumerate(asked, start=self.next))
            values = drawn_values(sweep, asked)
            begins = not self.found.searched
            points = self._run([{}, *values], number, first=0)[1:] if begins else self._run(values, number)
            if begins:
                self._require_objective()
            scale = self._scale()
            strategy.tell([point.cost(section.objective, scale) for point in points])
            done += len(points)
            if more:
                now = best(self.found.assessed(section), section.objective)
                won = now is not None and now.number > self.next - 1 - len(more)
                reach = min(_FIRST_REACH, 2.0 * reach) if won else 0.5 * reach
            if self.batches.computed:
                spent, computed = spent + time.monotonic() - begun, computed + 1
            left = max(0, -(-(samples - done) // section.batch))
            seconds = left * spent / max(computed, 1)
            pace = f"; about {duration_text(seconds)} left of the search" if seconds >= 1.0 else ""
            console.print(f"{done} of {samples} points; {self._told()}{pace}", soft_wrap=True)

    def _run(self, values: Sequence[Mapping[str, Value]], number: int, first: int | None = None) -> list[Assessed]:
        """One batch against the limits of this round."""
        first = self.next if first is None else first
        outcomes = self.batches.run(values, self.sweep, first)
        rows = [(outcome, self._numbers(outcome)) for outcome in outcomes]
        self.found.searched += rows
        self.found.round_of |= dict.fromkeys(range(first, first + len(rows)), number)
        self.next = max(self.next, first + len(rows))
        return [assess(outcome, numbers, self.section, self.found.limits[-1]) for outcome, numbers in rows]

    def _proposed(self, reach: float) -> list[NDArray[np.float64]]:
        """What the linear programme of the points so far says within a box, and one of a quarter the size."""
        points, limits = self.found.assessed(self.section), self.found.limits[-1]
        both = [
            proposal(points, self.places, limits, self.section.objective, self._scale(), size)
            for size in (reach, 0.25 * reach)
        ]
        return [one for one in both if one is not None]

    def _require_objective(self) -> None:
        """Refuse an objective of which no wheel of the first batch has a value: every point would be infeasible."""
        numbers = [numbers for outcome, numbers in self.found.searched if outcome.curve is not None]
        column = self.section.objective.column
        if numbers and not any(isinstance(one.get(column), float | int) for one in numbers):
            rule = f"{column} has no value at any of the first {len(numbers)} wheels, all would count as infeasible"
            hint = "take a column that has one, see `workbench sweep`, or a study whose curves reach further"
            raise StudyError(self.batches.path, "optimise.objective", "", rule, hint)

    def _scale(self) -> float:
        """A usual size of the objective: that of the first point which has one."""
        column = self.section.objective.column
        values = (numbers.get(column) for _, numbers in self.found.searched)
        return next((abs(value) for value in values if isinstance(value, float) and value), 1.0)

    def _told(self) -> str:
        points = self.found.assessed(self.section)
        chosen = best(points, self.section.objective)
        kind = "best" if chosen else "none within the limits; nearest"
        return f"{kind}: {told_point(chosen or nearest(points), self.section)}"

    def _chosen(self) -> list[Assessed]:
        """The best point, then others of the front, as far from each other along it as can be."""
        points = self.found.assessed(self.section)
        first = best(points, self.section.objective)
        if first is None:
            return []
        others = [point for point in front(points, self.section) if point.number != first.number]
        wanted = min(max(self.section.confirm - 1, 0), len(others))
        places = np.linspace(0, len(others) - 1, wanted + 1)[1:].round().astype(int).tolist()
        return [first, *(others[place] for place in places)]

    def _confirm(self, chosen: Sequence[Assessed]) -> Confirmed | None:
        """Run those by both models that have not run yet; the first of them, None where all have."""
        known = {one.found for one in self.found.confirmed}
        again = [point for point in chosen if point.number not in known]
        if chosen[0].number in known or not again:
            return None
        section = self.section
        step = {} if section.confirm_step is None else {"orientation_step": _written(section.confirm_step)}
        values = [{**point.outcome.run.point.values, **step} for point in again]
        named = ", ".join(str(point.number) for point in again)
        console.print(f"confirmed by the solid model: {named}", soft_wrap=True)
        outcomes = self.batches.run(values, self.sweep, self.next, (section.model, "fe"), shown=True)
        self.next += len(again)
        both = [assess(o, self._numbers(o), section, self.found.limits[0]) for o in outcomes]
        pairs = zip(again, both[::2], both[1::2], strict=True)
        new = [Confirmed(found=point.number, fast=fast, solid=solid) for point, fast, solid in pairs]
        self.found.confirmed += new
        for one in new:
            verdict = told_verdict(one.solid)
            console.print(f"{one.found}, solid: {verdict}: {told_point(one.solid, section)}", soft_wrap=True)
        return new[0]


def require_step(batches: PointBatches, section: OptimiseSection) -> None:
    """Refuse a step between orientations that does not divide the wheel's period; StudyError."""
    if section.confirm_step is None:
        return
    try:
        study_point(batches.path, batches.base, 0, {"orientation_step": _written(section.confirm_step)})
    except InputError as error:
        raise StudyError(batches.path, "optimise.confirm_step", error.value, error.rule, error.hint) from error


def _written(angle: float) -> str:
    return f"{degrees(angle):g} deg"
