"""``workbench optimise``: the best wheel within limits, confirmed by the solid model; table, page, a study of it.

Verified by tests/end_to_end/test_optimise.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from contracts.errors import StudyError
from workbench.charts.interactive import Figure
from workbench.charts.printed import draw
from workbench.commands.computing import console, tell_kept, warn
from workbench.commands.optimise_search import Optimised, require_step, search_and_confirm
from workbench.commands.point_batches import PointBatches
from workbench.execution.runner import Computing
from workbench.execution.store import Store
from workbench.questions.ancf_wheel.graph import require_ancf_wheel
from workbench.questions.optimise.figures import confirmed_figure, trade_figure
from workbench.questions.optimise.judging import STABILITY, Assessed, front, limits_of, nearest
from workbench.questions.optimise.table import optimise_table
from workbench.questions.optimise.words import limited, told_difference, told_limits, told_point
from workbench.questions.section.graph import without_planar_model
from workbench.questions.sweep.table import SweepTable
from workbench.report.folders import check_folder, check_targets
from workbench.report.optimise_page import optimise_page
from workbench.report.outputs import to_json
from workbench.report.placing import new_files
from workbench.study.magnitudes import of_the_file
from workbench.study.model import Study
from workbench.study.optimise import OptimiseSection
from workbench.study.reading import read_study_table, study_of
from workbench.study.rewrite import written_point
from workbench.study.sweep_points import require_keys

__all__ = ["require_optimise", "run_optimise"]

_BEST = "best.toml"
_FILES = ("optimise.csv", "optimise.json", "optimise.svg", "optimise.html")


def require_optimise(path: Path, content: Mapping[str, Any], study: Study) -> tuple[PointBatches, OptimiseSection]:
    """The section, and what computes its points, once all that can be refused beforehand was looked at; StudyError."""
    section = study.optimise
    if section is None:
        rule = "is missing: it says what is sought"
        raise StudyError(path, "optimise", "", rule, "copy it from studies/leaf_optimise.toml")
    base = {key: value for key, value in content.items() if key not in ("optimise", "sweep")}
    batches = PointBatches(path=path, base=base, study=study, section="optimise")
    if section.model == "section" and (reason := without_planar_model(study)) is not None:
        raise StudyError(path, reason.what, reason.value, reason.rule, 'set optimise.model = "ancf_wheel"')
    if section.model == "ancf_wheel":
        require_ancf_wheel(study)
    require_keys(path, base, section.as_sweep)
    wanted = {section.objective.column: "objective", section.trade.column: "against"}
    batches.require_columns(section.as_sweep, wanted)
    require_step(batches, section)
    return batches, section


def run_optimise(path: Path, out: Path, store: Path, computing: Computing) -> int:
    """0 where a wheel within the limits was found and confirmed, else 1; everything is written in any case."""
    content = read_study_table(path)
    study = study_of(path, content)
    batches, section = require_optimise(path, content, study)
    batches.store, batches.computing = Store(store, study=path.stem), computing
    warn(path, of_the_file(study))
    check_folder(out)
    check_targets(out, (*_FILES, _BEST))
    varied = ", ".join(section.variables)
    console.print(f"{section.objective.column} for {told_limits(limits_of(section))}; varied: {varied}", soft_wrap=True)
    found = search_and_confirm(batches, section)
    points = found.assessed(section)
    table = _table(study, section, batches, found, points)
    sentences = _sentences(section, found, points)
    _publish(out, path, study, section, found, table, points, sentences)
    for sentence in sentences:
        console.print(sentence, soft_wrap=True)
    console.print(f"optimise: {out / 'optimise.html'}", soft_wrap=True)
    return 0 if found.answer is not None else 1


def _table(
    study: Study, section: OptimiseSection, batches: PointBatches, found: Optimised, points: Sequence[Assessed]
) -> SweepTable:
    again = [one for pair in found.confirmed for one in (pair.fast, pair.solid)]
    confirms = {pair.solid.number: pair.found for pair in found.confirmed}
    on_front = {point.number for point in front(points, section)}
    return optimise_table(study, section, batches.keys, [*points, *again], found.round_of, confirms, on_front)


def _sentences(section: OptimiseSection, found: Optimised, points: Sequence[Assessed]) -> list[str]:
    """What was found."""
    refused = sum(point.outcome.curve is None for point in points)
    counts = f"{len(points)} wheels by the {section.model} model, {sum(p.feasible for p in points)} within the limits"
    buckled = sum(point.misses[STABILITY] > 0.0 for point in points)
    refusals = f", {refused} could not be meshed or pressed" if refused else ""
    unknown = sum(point.objective is None and point.outcome.curve is not None for point in points)
    without = f", {unknown} have no {section.objective.column} and count as not within them" if unknown else ""
    told = [f"{counts}{refusals}{f', {buckled} buckle below the load' if buckled else ''}{without}"]
    if len(found.limits) > 1:
        told.append(f"limits of the last search, corrected by the solid model: {told_limits(found.limits[-1])}")
    told += [
        f"point {one.found}, {section.model} against solid model at the same orientations: {difference}"
        for one in found.confirmed
        if (difference := told_difference(one, section))
    ]
    if found.answer is not None:
        confirmed = next((one for one in found.confirmed if one.solid is found.answer), None)
        by = "not confirmed by the solid model" if confirmed is None else f"point {confirmed.found}, by the solid model"
        gain = _gain(section, points, found.answer if confirmed is None else _searched(points, confirmed.found))
        told.append(f"best ({by}): {told_point(found.answer, section)}{gain}")
    elif found.confirmed:
        told.append(f"no confirmed wheel is within the limits; {_last(section, found)}")
    else:
        told.append(f"no wheel is within the limits; nearest: {told_point(nearest(points), section)}")
    return told


def _searched(points: Sequence[Assessed], number: int) -> Assessed:
    return next(point for point in points if point.number == number)


def _gain(section: OptimiseSection, points: Sequence[Assessed], answer: Assessed) -> str:
    """By how much the objective of a point of the search differs from that of the study as it is, by the same model."""
    base = next((point.objective for point in points if point.number == 0), None)
    if not base or answer.objective is None:
        return ""
    kept = "" if points[0].feasible else " (not within the limits)"
    change = 100.0 * (answer.objective / base - 1.0)
    return f"; {change:+.3g} % against the study as it is{kept}, both by the {section.model} model"


def _last(section: OptimiseSection, found: Optimised) -> str:
    close = nearest([one.solid for one in found.confirmed])
    return f"nearest: {told_point(close, section)}"


def _publish(
    out: Path,
    path: Path,
    study: Study,
    section: OptimiseSection,
    found: Optimised,
    table: SweepTable,
    points: Sequence[Assessed],
    sentences: Sequence[str],
) -> None:
    """Put each file in place whole, the page last; best.toml only where there is a best."""
    trade = trade_figure(points, found.confirmed, section)
    figures: list[tuple[Any, Figure]] = [(one, confirmed_figure(one, section)) for one in found.confirmed]
    best = () if found.answer is None else (_BEST,)
    with new_files(out, "optimise", (*best, *_FILES), whole_set=True) as new:
        if found.answer is not None:
            note = f"{path.name}, best point of `workbench optimise`:\n{sentences[-1]}"
            text = written_point(path.read_text(encoding="utf-8"), found.answer.outcome.run.point.values, note, path)
            (new.folder / _BEST).write_text(text, encoding="utf-8")
        (new.folder / "optimise.csv").write_text(table.csv(), encoding="utf-8", newline="")
        (new.folder / "optimise.json").write_text(to_json(_record(section, found, sentences)), encoding="utf-8")
        draw(trade.to_dict(), new.folder / "optimise.svg", whole_width=True)
        page = optimise_page(study.title, section, table, figures, trade, found.answer, sentences)
        (new.folder / "optimise.html").write_text(page, encoding="utf-8")
    tell_kept(new.told)


def _record(section: OptimiseSection, found: Optimised, sentences: Sequence[str]) -> dict[str, Any]:
    """What was asked, searched for and found, for programs; SI."""
    names = dict.fromkeys([section.objective.column, *limited(section), section.trade.column])

    def told(point: Assessed) -> dict[str, Any]:
        numbers = {name: point.numbers.get(name) for name in names}
        return {"point": point.number, "numbers": numbers, "misses": dict(point.misses), "feasible": point.feasible}

    return {
        "section": section.model_dump(mode="json", exclude_none=True),
        "limits": [{one.column: [one.low, one.high] for one in limits} for limits in found.limits],
        "confirmed": [
            {
                "found": one.found,
                "values": dict(one.solid.outcome.run.point.values),
                section.model: told(one.fast),
                "fe": told(one.solid),
            }
            for one in found.confirmed
        ],
        "answer": None if found.answer is None else told(found.answer),
        "told": list(sentences),
    }
