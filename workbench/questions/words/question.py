"""Question: what the thesis' words say of the reference, and whether this wheel is so.

None of the statements is independent evidence: the wheel is chosen by the numbers of the thesis' tires.
Verified by tests/unit/test_workbench_thesis_words.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.model_curves import model_curves
from workbench.questions.models.curves import brush_curve
from workbench.questions.question import Question
from workbench.questions.strength.yielding import yield_strengths
from workbench.questions.words.figures import words_figures
from workbench.questions.words.graph import TWIN, asked, twin_tasks
from workbench.questions.words.plausible import plausible
from workbench.questions.words.readings import reading_curves, reading_tasks
from workbench.questions.words.results import AVERAGE, FOLLOWS, LOADS, SMALL, SPREAD_AT, Words, follows, spread
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_least, at_most, near

__all__ = ["WORDS", "words_checks"]

SLOPE, END, FAILS = 0.03, 0.05, 0.05
"""Relative: slope up to 5 mm, load at the 160 N end, and by how much the brush line must fail at the 250 N end."""
BAND = 0.02
"""By how much the solid model's average may leave the band of the section model's, relative."""


def words_checks(words: Words) -> list[Check]:
    """Each sentence as findings."""
    low, high = LOADS
    slope, reading = words.brush_slope, words.reading.text
    checks = [
        near(
            _claim(
                "small.slope", f"slope of the average up to {1e3 * SMALL:g} mm, and the brush line's", "slope", "N/m"
            ),
            lambda: words.average.initial_tangent(SMALL),
            slope,
            SLOPE,
        ),
        near(
            _claim("small.end", f"load of the average where the brush line carries {low:g} N", "load", "N"),
            lambda: float(words.average.load_at(low / slope)),
            low,
            END,
        ),
        at_least(
            _claim("brush_fails", f"distance of average and brush line where that carries {high:g} N", "difference"),
            lambda: abs(words.brush_misses(high)),
            FAILS,
        ),
    ]
    for deflection, limit in AVERAGE.items():
        text = f"average over that of the thesis' tire ({reading}), at {1e3 * deflection:g} mm"
        claim = _claim(f"average_{1e3 * deflection:g}mm", text, "load / load")
        checks.append(near(claim, partial(words.average_over, words.tire, deflection), 1.0, limit))
    for orientation, curve in words.tire.by_orientation.items():
        text = (
            f"the thesis' tire ({reading}) at {orientation:g} deg, {low:g} to {high:g} N, "
            "and the nearest orientation of the wheel"
        )
        claim = _claim(f"follows_{orientation:g}deg", text, "largest relative difference")
        checks.append(at_most(claim, lambda curve=curve: follows(words.fe, curve)[1], FOLLOWS))  # type: ignore[misc]
    own, twin = partial(spread, words.section, SPREAD_AT), partial(spread, words.twin, SPREAD_AT)
    of_all = f"over that of the wheel as it is, at {1e3 * SPREAD_AT:g} mm (section model)"
    checks += [
        at_least(
            _claim(
                "out_of_phase", f"spread of the orientations with all springs in phase, {of_all}", "spread / spread"
            ),
            lambda: twin() / own(),
            1.0,
        ),
        at_most(
            _claim("no_yielding", f"largest linearised stress over yield strength at {high:g} N", "stress / yield"),
            partial(words.stress, high),
            1.0,
        ),
        at_most(
            _claim("stable", f"negative eigenvalues of the tangent up to {high:g} N", "count"),
            partial(words.negative_pivots, high),
            0.0,
        ),
        at_most(
            _claim("band", "distance of the average from the band of the plausible set", "difference"),
            lambda: words.plausible.outside(words.average),
            BAND,
        ),
    ]
    return checks


def _claim(name: str, title: str, quantity: str, unit: str = "-") -> Claim:
    source = "the thesis' words, read as numbers by us; no independent evidence, the wheel is chosen by them"
    title = title[0].upper() + title[1:]
    return Claim(id=f"words.{name}", title=title, quantity=quantity, unit=unit, role="finding", source=source)


def _read(study: Study, folders: Mapping[str, Path]) -> Words:
    fe = model_curves("fe", folders, around(study))
    if study.brush is None:
        raise InputError("[brush]", "", "is not in the study", "add it")
    return Words(
        fe=fe,
        average=fe.average,
        ancf=model_curves("ancf", folders),
        readings=reading_curves(folders),
        brush=brush_curve(study, folders["brush"]),
        section=model_curves("section", folders, around(study)),
        twin=model_curves(TWIN, folders, around(study)),
        yield_strength=yield_strengths(study),
        plausible=plausible(),
    )


def _tasks(study: Study) -> Sequence[Task]:
    return [*twin_tasks(study), *reading_tasks(study)]


def _curves(study: Study, words: Words) -> Sequence[StiffnessCurve]:
    return [words.plausible.band]


def _checks(study: Study, words: Words) -> Sequence[Check]:
    return words_checks(words)


WORDS = Question(
    name="words",
    title="What the thesis' words allow",
    group="Result",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=words_figures,
    curves=_curves,
    applies=asked,
)
