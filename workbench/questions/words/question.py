"""Question: what the thesis' words say of the reference, and whether this wheel is so, beside one with hoops.

None of the statements is independent evidence: the wheel is chosen by the numbers of the thesis' tires.
Verified by tests/unit/test_workbench_thesis_words.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.fe.reference_checks import mesh_share
from workbench.questions.mesh_study.question import mesh_study_of
from workbench.questions.model_curves import model_curves
from workbench.questions.models.curves import brush_curve
from workbench.questions.question import Question
from workbench.questions.words.checks import verdicts, words_checks
from workbench.questions.words.figures import words_figures
from workbench.questions.words.graph import HOOPS, HOOPS_TWIN, TWIN, asked, hoops, hoops_tasks, twin_tasks
from workbench.questions.words.plausible import plausible
from workbench.questions.words.readings import reading_curves, reading_tasks
from workbench.questions.words.results import Words
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.strengths import yield_strengths

__all__ = ["WORDS"]


def _read(study: Study, folders: Mapping[str, Path]) -> Words:
    fe = model_curves("fe", folders, around(study))
    if study.brush is None:
        raise InputError("[brush]", "", "is not in the study", "add it")
    words = Words(
        fe=fe,
        average=fe.average,
        ancf=model_curves("ancf", folders),
        readings=reading_curves(folders),
        brush=brush_curve(study, folders["brush"]),
        section=model_curves("section", folders, around(study)),
        twin=model_curves(TWIN, folders, around(study)),
        yield_strength=yield_strengths(study),
        plausible=plausible(),
        mesh=mesh_share(mesh_study_of(study, folders), fe.average, 0.0, fe.average.deflection[-1]),
    )
    turns = around(hoops())
    own = model_curves(HOOPS, folders, turns)
    beside = replace(
        words,
        fe=own,
        average=own.average,
        section=own,
        twin=model_curves(HOOPS_TWIN, folders, turns),
        yield_strength=yield_strengths(hoops()),
    )
    return replace(words, verdicts=verdicts(words), hoops=replace(beside, verdicts=verdicts(beside)))


def _tasks(study: Study) -> Sequence[Task]:
    return [*twin_tasks(study), *hoops_tasks(), *reading_tasks(study)]


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
    budget=1050,
)
