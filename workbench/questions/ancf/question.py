"""Question: how does the study's ANCF tire carry load, and is it the thesis' where it says so?

Verified by tests/unit/test_workbench_checks.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.ancf.checks import ancf_checks, surfaces_check
from workbench.questions.ancf.graph import ancf_curve_tasks
from workbench.questions.ancf.results import AncfTireResults, read_ancf
from workbench.questions.ancf.surfaces import report_surfaces_task
from workbench.questions.question import Question
from workbench.study.model import Study, stated

__all__ = ["ANCF"]


def _tasks(study: Study) -> Sequence[Task]:
    return [*ancf_curve_tasks(study), report_surfaces_task(study)]


def _checks(study: Study, results: AncfTireResults) -> Sequence[Check]:
    tolerances = study.tolerances
    preset = ancf_checks(results.ancf, tolerances) if stated(study.ancf, "ancf").thesis_preset else []
    return [surfaces_check(lambda: results.surface_distance, tolerances), *preset]


def _curves(study: Study, results: AncfTireResults) -> Sequence[StiffnessCurve]:
    return [*results.ancf.by_orientation.values(), results.ancf.average]


def _figures(study: Study, results: AncfTireResults) -> Mapping[str, str]:
    from workbench.questions.ancf.figures import ancf_figure

    return {"ancf": ancf_figure(results.fe_average, results.ancf)}


ANCF = Question(
    name="ancf",
    title="ANCF",
    group="ANCF tire",
    tasks=_tasks,
    read=read_ancf,
    checks=_checks,
    figures=_figures,
    curves=_curves,
    applies=lambda study: study.ancf is not None,
)
