"""``workbench sweep``: every point of a study's [sweep], one table, one page.

Verified by tests/end_to_end/test_sweep.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from contracts.errors import InputError, StudyError
from workbench.commands.computing import console, naming, tell_kept, warn
from workbench.commands.sweep_search import search
from workbench.execution.errors import RunError
from workbench.execution.progress import RunDisplay
from workbench.execution.runner import Computing, run_all
from workbench.execution.store import Store
from workbench.questions.sweep.confirmed import confirmed_record
from workbench.questions.sweep.graph import sweep_graph
from workbench.questions.sweep.likeness import unlike
from workbench.questions.sweep.results import Outcome, outcomes, references
from workbench.questions.sweep.table import SweepTable, sweep_table
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import to_json
from workbench.report.parquet import write_parquet
from workbench.report.placing import new_files
from workbench.report.sweep_page import sweep_page
from workbench.study.magnitudes import unusual
from workbench.study.model import Study
from workbench.study.reading import read_study_table, study_of
from workbench.study.sweep import SweepSection
from workbench.study.sweep_points import Point, beyond_reach, design_points, probes, sweep_points

__all__ = ["run_sweep"]

_FILES = ("sweep.csv", "sweep.parquet", "sweep.html")
_CONFIRMED = "confirmed.json"
"""Of a search: what ran again, for programs."""
_MOST_WARNINGS = 20
_MANY = 100
"""Points that take so long to read, some 20 ms each, that it is said."""


def run_sweep(study_path: Path, out: Path, store: Path, computing: Computing) -> int:
    """Every point of the study's [sweep]; 0 if all have a curve, else everything is written and RunError raised."""
    content = read_study_table(study_path)
    study = study_of(study_path, content)
    if study.sweep is not None and (count := len(design_points(study.sweep))) > _MANY:
        console.print(f"reading {count} points, each as a whole study: some {count // 50} s", soft_wrap=True)
    if study.sweep is not None and study.sweep.design == "search":
        return _run_search(study_path, content, study, out, Store(store, study=study_path.stem), computing)
    points = sweep_points(study_path, content)
    section = study.sweep
    assert section is not None
    silent = _without_effect(study_path, content, section, points)
    warn(study_path, (*_warnings(study, points), *beyond_reach(study, points), *silent))
    check_folder(out)
    check_targets(out, _FILES)
    with naming(study_path):
        graph = sweep_graph(points, section.models, section.moved)
    console.print(f"{len(points)} points, {', '.join(section.models)}: {len(graph.tasks)} tasks")
    with naming(study_path), RunDisplay(console, graph.tasks) as display:
        ended = run_all(graph.tasks, Store(store, study=study_path.stem), display, computing)
    found = outcomes(graph, ended.entries, ended.failures)
    table = sweep_table(study, graph.keys, found, references(study, study_path.parent, found))
    _publish(out, table, sweep_page(study.title, table, found))
    _print(table, found)
    if differ := unlike(found):
        console.print(f"sweep: {differ}", soft_wrap=True)
    console.print(f"sweep: {out / 'sweep.html'}", soft_wrap=True)
    _complain(study_path, out, found)
    return 0


def _run_search(
    path: Path, content: dict[str, Any], study: Study, out: Path, store: Store, computing: Computing
) -> int:
    """A search instead of points known beforehand; a point that fails is nothing to complain of."""
    warn(path, (*unusual(study), *beyond_reach(study, ())))
    check_folder(out)
    check_targets(out, (_CONFIRMED, *_FILES))
    searched = search(path, content, study, store, computing)
    table = sweep_table(study, searched.keys, searched.found, {}, searched.judged, searched.confirms)
    base = {key: value for key, value in content.items() if key != "sweep"}
    record = confirmed_record(base, study, searched.judged, searched.confirms)
    _publish(out, table, sweep_page(study.title, table, searched.found), {_CONFIRMED: to_json(record)})
    console.print(f"sweep: {out / 'sweep.html'}", soft_wrap=True)
    return 0


def _warnings(study: Study, points: Sequence[Point]) -> list[str]:
    """What is unusual about the study, then what is so about some of its points only; the first of each kind."""
    found = dict.fromkeys(unusual(study), "")
    for point in points:
        for warning in unusual(point.study):
            found.setdefault(warning, f"[sweep] point {point.number} ({point.label}): ")
    return [where + warning for warning, where in found.items()][:_MOST_WARNINGS]


def _without_effect(
    path: Path, content: dict[str, Any], section: SweepSection, points: Sequence[Point]
) -> Iterator[str]:
    """Parameters of which no other value changes what any of the models computes, the rest as the study has it."""
    for key in section.parameters:
        values = list(dict.fromkeys(point.values[key] for point in points if key in point.values))
        try:
            graph = sweep_graph(
                probes(path, content, key, values[:: max(len(values) - 1, 1)]), section.models, section.moved
            )
        except (StudyError, InputError):  # fits only together with other parameters
            continue
        if len(values) > 1 and len({run.tasks for run in graph.runs}) == len(section.models):
            yield f"sweep.{key} changes nothing that {' or '.join(section.models)} computes; leave it out"


def _publish(out: Path, table: SweepTable, page: str, more: Mapping[str, str] | None = None) -> None:
    """Put each file in place whole, the page last; ``more`` are further files by name."""
    further = more or {}
    with new_files(out, "sweep", (*further, *_FILES)) as new:
        for name, text in further.items():
            (new.folder / name).write_text(text, encoding="utf-8")
        (new.folder / "sweep.csv").write_text(table.csv(), encoding="utf-8", newline="")
        write_parquet(table, new.folder / "sweep.parquet")
        (new.folder / "sweep.html").write_text(page, encoding="utf-8")
    tell_kept(new.told)


def _print(table: SweepTable, found: list[Outcome]) -> None:
    """One line for each point and model: its values and its initial tangent."""
    for outcome, tangent in zip(found, table.column("initial_tangent_N_per_m"), strict=True):
        number = f"{1e-3 * tangent:.4f} N/mm" if isinstance(tangent, float) else "no initial tangent"
        state = "" if outcome.state == "whole" else f" ({outcome.state})"
        line = f"{outcome.run.point.number}: {outcome.run.point.label}: {outcome.run.model}: {number}{state}"
        console.print(line, soft_wrap=True)


def _complain(path: Path, out: Path, found: list[Outcome]) -> None:
    """Everything is written; now say, as the run's one error, which points are not whole, and why of the first."""
    bad = [outcome for outcome in found if outcome.state != "whole"]
    if bad:
        which = ", ".join(f"{o.run.point.number} ({o.run.model}, {o.state})" for o in bad[:10])
        more = f" and {len(bad) - 10} more" if len(bad) > 10 else ""
        what = f"{len(bad)} of {len(found)} curves are not whole: point {which}{more}; the first: {bad[0].note}"
        raise RunError(f"{path}: {what}; the others are in {out / 'sweep.csv'}")
