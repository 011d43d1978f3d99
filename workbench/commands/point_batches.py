"""Points that are chosen while a command runs: each batch read, computed through the store, and handed back.

Verified by tests/end_to_end/test_search.py and tests/end_to_end/test_optimise.py.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from contracts.errors import InputError, StudyError
from workbench.commands.computing import console, naming
from workbench.execution.listening import Teller
from workbench.execution.progress import RunDisplay
from workbench.execution.runner import Computing, run_all
from workbench.execution.store import Entry, Store
from workbench.questions.sweep.graph import SweepRun, sweep_graph
from workbench.questions.sweep.results import Outcome, measured, outcomes, own_curves
from workbench.study.model import Study
from workbench.study.sweep import SweepRange, SweepSection, SweptModel, Value
from workbench.study.sweep_points import Point, study_point

__all__ = ["PointBatches"]

_MEND = "correct the key or its range"


class _Quiet(Teller):
    """Hears of thousands of tasks and tells warnings only; counts what was computed."""

    def __init__(self) -> None:
        self.computed = 0

    def say(self, sentence: str, *, warning: bool = False) -> None:
        if warning:
            console.print(sentence, soft_wrap=True)

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        self.computed += not reused

    def warned(self, warning: str) -> None: ...
    def started(self, name: str) -> None: ...
    def progressed(self, name: str, fraction: float) -> None: ...
    def failed(self, name: str, message: str) -> None: ...


@dataclass(kw_only=True)
class PointBatches:
    """Computes batch after batch of a study's points.

    Attributes
    ----------
    path, base, study : the study's file, its content without the section, and it read
    section : name of the section whose points these are, for messages
    store, computing : where results are kept, without which nothing runs; who computes
    keys : of every task so far, by its name
    computed : tasks that the last batch computed, not found in the store
    """

    path: Path
    base: Mapping[str, Any]
    study: Study
    section: str
    store: Store | None = None
    computing: Computing = field(default_factory=Computing)
    keys: dict[str, str] = field(default_factory=dict)
    computed: int = 0

    def require_columns(self, sweep: SweepSection, wanted: Mapping[str, str]) -> None:
        """Refuse a column, name -> key that names it, that is no number of the table."""
        nothing = _refused(self.study, 0, {}, "", sweep.models[0])
        numbers = measured(nothing, sweep, self.study.tangent_up_to, None, own_curves(self.study))
        known = [name for name in numbers if name != "held_against"]
        for name, key in wanted.items():
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
                hint = f"e.g. {near[0]}" if near else f"one of {', '.join(known)}"
                shown = "" if key.endswith(name) else name
                raise StudyError(self.path, f"{self.section}.{key}", shown, "is no number of the table", hint)

    def unusable_ends(self, sweep: SweepSection) -> list[str]:
        """Each end of a range and each value of a list that, the rest as it is, makes no wheel, and why."""
        found = []
        for key, values in sweep.parameters.items():
            ends = (values.low, values.high) if isinstance(values, SweepRange) else values
            for number, value in enumerate(ends, start=1):
                try:
                    sweep_graph([study_point(self.path, self.base, number, {key: value})], sweep.models, sweep.moved)
                except (StudyError, InputError) as error:
                    what = error.key.rpartition("): ")[2] if isinstance(error, StudyError) else error.what
                    found.append(
                        f"{self.section}: {key} = {value} makes no wheel: {what} = {error.value}: {error.rule}"
                    )
        return found

    def run(
        self,
        values: Sequence[Mapping[str, Value]],
        sweep: SweepSection,
        first: int,
        models: Sequence[SweptModel] = (),
        *,
        shown: bool = False,
    ) -> list[Outcome]:
        """Outcomes of each point, numbered from ``first``, by each model, those of the sweep if left out.

        ``shown`` with a bar or line for each task.
        A point that makes no wheel has an outcome that says why; of the very first ones one must.
        """
        assert self.store is not None
        models = models or sweep.models
        points, refused = list[Point](), dict[int, str]()
        for number, chosen in enumerate(values, start=first):
            try:
                point = study_point(self.path, self.base, number, chosen)
                sweep_graph([point], models, sweep.moved)
                points.append(point)
            except (StudyError, InputError) as error:
                refused[number] = str(error)
                if isinstance(error, StudyError):
                    refused[number] = f"{error.key.replace('[sweep]', f'[{self.section}]', 1)}: {error.rule}"
        if first <= 1 and refused and not any(point.values for point in points):
            rule = f"none of its first points can be used: {refused[min(refused)]}"
            raise StudyError(self.path, self.section, "", rule, _MEND)
        graph, heard = sweep_graph(points, models, sweep.moved), _Quiet()
        display = RunDisplay(console, graph.tasks) if shown else nullcontext(heard)
        with naming(self.path), display as listener:
            ended = run_all(graph.tasks, self.store, listener, self.computing)
        self.keys |= graph.keys
        self.computed = heard.computed
        found = {(o.run.point.number, o.run.model): o for o in outcomes(graph, ended.entries, ended.failures)}
        return [
            found.get((number, model)) or _refused(self.study, number, chosen, refused[number], model)
            for number, chosen in enumerate(values, start=first)
            for model in models
        ]


def _refused(study: Study, number: int, values: Mapping[str, Value], why: str, model: SweptModel) -> Outcome:
    """A point that makes no wheel."""
    point = Point(number=number, values=values, study=study)
    return Outcome(run=SweepRun(point=point, model=model, curves={}, tasks=()), note=why)
