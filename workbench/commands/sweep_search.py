"""The batches of ``workbench sweep`` where its design is a search: choose, run, judge, choose better.

Verified by tests/end_to_end/test_search.py.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve
from contracts.errors import InputError, StudyError
from workbench.commands.computing import console, naming
from workbench.execution.listening import Teller
from workbench.execution.runner import Computing, run_all
from workbench.execution.store import Entry, Store
from workbench.questions.sweep.graph import SweepRun, sweep_graph
from workbench.questions.sweep.results import Outcome, measured, outcomes, own_curves
from workbench.questions.sweep.search import Judged, Strategy, best_points, judge
from workbench.study.model import Study
from workbench.study.sweep import SweepSection, Value
from workbench.study.sweep_points import Point, drawn_values, place_of, require_keys, study_point

__all__ = ["Searched", "search"]

_MEND = "correct the key or its range"


@dataclass(slots=True, kw_only=True)
class Searched:
    """What a search found.

    Attributes
    ----------
    found : outcome of each point, read at its scale; refused ones say why in their note
    judged : number of a point -> against the aims
    confirms : number of a point that ran again -> number of the point of the search that it is
    keys : keys of the tasks, by their names
    """

    found: list[Outcome] = field(default_factory=list)
    judged: dict[int, Judged] = field(default_factory=dict)
    confirms: dict[int, int] = field(default_factory=dict)
    keys: dict[str, str] = field(default_factory=dict)


class _Quiet(Teller):
    """Hears of thousands of tasks and tells warnings only."""

    def say(self, sentence: str, *, warning: bool = False) -> None:
        if warning:
            console.print(sentence, soft_wrap=True)

    def warned(self, warning: str) -> None: ...
    def started(self, name: str) -> None: ...
    def progressed(self, name: str, fraction: float) -> None: ...
    def finished(self, name: str, entry: Entry, reused: bool) -> None: ...
    def failed(self, name: str, message: str) -> None: ...


def search(path: Path, content: Mapping[str, Any], study: Study, store: Store, computing: Computing) -> Searched:
    """Run the search of a study's [sweep], and what it confirms; a line for each batch.

    Raises
    ------
    StudyError
        If an aim is no column of the table, a parameter no key of the study, or no point of the first batch a wheel.
    """
    section = study.sweep
    assert section is not None
    base = {key: value for key, value in content.items() if key != "sweep"}
    run = _Batches(path, base, study, store, computing)
    run.require_columns(section)
    require_keys(path, base, section)
    start = place_of(section, base)
    strategy = Strategy(start=start, batch=section.batch, seed=section.seed, step=section.first_step)
    assert section.samples is not None
    while len(run.searched.judged) < section.samples:
        values = drawn_values(section, strategy.ask())
        judged = run.batch(values, section)
        strategy.tell([one.cost for one in judged])
        _tell(run.searched, section.samples)
    searched = run.searched
    chosen = best_points(searched.judged, section.confirm)
    again = [_confirmed(searched, number, section) for number in chosen]
    if again:
        console.print(f"{len(again)} points run again, at the thickness found and at every orientation")
        first = max(searched.judged) + 1
        fixed = section.model_copy(update={"scaled": False})
        for at in range(0, len(again), section.batch):
            run.batch(again[at : at + section.batch], fixed)
        searched.confirms = {first + i: number for i, number in enumerate(chosen)}
        failed = [one for one in searched.found[-len(again) :] if one.state == "failed"]
        if failed:
            console.print(f"{len(failed)} of them have no curve; the first: {failed[0].note}", soft_wrap=True)
    return searched


def _confirmed(searched: Searched, number: int, section: SweepSection) -> dict[str, Value]:
    """Values of a point as it runs again."""
    outcome, scale = searched.judged[number].outcome, searched.judged[number].scale
    step = f"{section.confirm_step:.9g} rad"
    return {**outcome.run.point.values, "strip_scale": float(f"{scale:.6g}"), "orientation_step": step}


class _Batches:
    """Runs batch after batch and remembers what was found."""

    def __init__(self, path: Path, base: Mapping[str, Any], study: Study, store: Store, computing: Computing) -> None:
        self._path, self._base, self._study = path, base, study
        self._store, self._computing = store, computing
        self._followed: dict[str, StiffnessCurve] = own_curves(study)
        self.searched = Searched()

    def require_columns(self, section: SweepSection) -> None:
        """Refuse an aim that is no number of the table."""
        nothing = self._refused(0, {}, "", section)
        numbers = measured(nothing, section, self._study.tangent_up_to, None, self._followed)
        known = [name for name in numbers if name != "held_against"]
        for name, key in section.wanted.items():
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
                hint = f"e.g. {near[0]}" if near else f"one of {', '.join(known)}"
                raise StudyError(self._path, f"sweep.{key}", "", "is no number of the table", hint)

    def batch(self, values: Sequence[Mapping[str, Value]], section: SweepSection) -> list[Judged]:
        """One batch, in its order."""
        first = max(self.searched.judged, default=0) + 1
        points, refused = list[Point](), dict[int, str]()
        for number, chosen in enumerate(values, start=first):
            try:
                point = study_point(self._path, self._base, number, chosen)
                sweep_graph([point], section.models, section.moved)
                points.append(point)
            except (StudyError, InputError) as error:
                refused[number] = f"{error.key}: {error.rule}" if isinstance(error, StudyError) else str(error)
        if not points and first == 1:
            raise StudyError(self._path, "sweep", "", f"none of its first points can be used: {refused[1]}", _MEND)
        graph = sweep_graph(points, section.models, section.moved)
        with naming(self._path):
            ended = run_all(graph.tasks, self._store, _Quiet(), self._computing)
        self.searched.keys |= graph.keys
        found = {o.run.point.number: o for o in outcomes(graph, ended.entries, ended.failures)}
        for number, chosen in enumerate(values, start=first):
            outcome = found.get(number) or self._refused(number, chosen, refused[number], section)
            judged = judge(outcome, section, self._study.tangent_up_to, self._followed)
            self.searched.judged[number] = judged
            self.searched.found.append(judged.outcome)
        return [self.searched.judged[number] for number in range(first, first + len(values))]

    def _refused(self, number: int, values: Mapping[str, Value], why: str, section: SweepSection) -> Outcome:
        """A point that makes no wheel."""
        point = Point(number=number, values=values, study=self._study)
        return Outcome(run=SweepRun(point=point, model=section.models[0], curves={}, tasks=()), note=why)


def _tell(searched: Searched, samples: int) -> None:
    (best,) = best_points(searched.judged, 1)
    judged = searched.judged[best]
    misses = ", ".join(f"{name} {miss:.2f}" for name, miss in judged.misses.items())
    told = f"{len(searched.judged)} of {samples} points; best: {best}, largest miss {judged.largest:.3f} ({misses})"
    console.print(told, soft_wrap=True)
