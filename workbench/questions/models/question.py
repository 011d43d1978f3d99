"""Question: how far do the reduced models and the user's curves follow the average continuum curve?

Verified by tests/unit/test_workbench_checks.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.models.agreement import noted
from workbench.questions.models.checks import agreement_checks, user_checks
from workbench.questions.models.graph import brush_task, metrics_task
from workbench.questions.models.results import ComparedModels, read_models
from workbench.questions.question import Question
from workbench.study.model import Study

__all__ = ["MODELS"]


def _tasks(study: Study) -> Sequence[Task]:
    return [metrics_task(study)] if study.brush is None else [brush_task(study), metrics_task(study)]


def _checks(study: Study, results: ComparedModels) -> Sequence[Check]:
    models = [name for name, curves in (("ancf", results.ancf), ("brush", results.brush)) if curves is not None]
    checks = agreement_checks(models, results.metrics, study.tolerances)
    checks += user_checks(results.continuum.users, results.metrics, study.tolerances)
    return noted(checks, results.agreements)


def _curves(study: Study, results: ComparedModels) -> Sequence[StiffnessCurve]:
    return () if results.brush is None else (results.brush,)


def _figures(study: Study, results: ComparedModels) -> Mapping[str, str]:
    from workbench.questions.models.figures import models_figure

    continuum = results.continuum
    figure = models_figure(
        continuum.fe.average,
        continuum.mesh_study,
        continuum.users,
        study.reference,
        ancf=None if results.ancf is None else results.ancf.average,
        brush=results.brush,
    )
    return {"models": figure}


MODELS = Question(
    name="models",
    title="Models compared",
    group="Result",
    tasks=_tasks,
    read=read_models,
    checks=_checks,
    figures=_figures,
    curves=_curves,
)
