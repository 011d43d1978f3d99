"""Question: how far do the reduced models and the user's curves follow the average continuum curve?

Verified by tests/unit/test_workbench_checks.py, tests/unit/test_workbench_agreement.py and
tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.fe.results import read_continuum
from workbench.questions.model_curves import UserCurve, model_curves
from workbench.questions.models.agreement import noted
from workbench.questions.models.curves import brush_curve
from workbench.questions.models.figures import models_figures
from workbench.questions.models.graph import brush_task, metrics_task
from workbench.questions.models.metrics import CurveMetrics
from workbench.questions.models.results import ComparedModels
from workbench.questions.question import Question
from workbench.study.model import Study
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_most, near

__all__ = ["MODELS", "agreement_checks", "read_models", "user_checks"]


def read_models(study: Study, folders: Mapping[str, Path]) -> ComparedModels:
    """All pairs from the folders of their tasks."""
    found = read_result(folders["metrics"])
    return ComparedModels(
        continuum=read_continuum(study, folders),
        ancf=None if study.ancf is None else model_curves("ancf", folders),
        brush=None if study.brush is None else brush_curve(study, folders["brush"]),
        metrics={pair: CurveMetrics(**numbers) for pair, numbers in found.items()},
        limit=study.tolerances.model_agreement,
    )


_UNKNOWN = CurveMetrics(
    start=0.0,
    end=0.0,
    relative_l2=math.nan,
    max_error=math.nan,
    max_error_at=0.0,
    tangent=math.nan,
    tangent_reference=0.0,
    reference_load=0.0,
)
"""Distances from an FE average that does not exist."""


def agreement_checks(
    models: Sequence[str], metrics: Mapping[str, CurveMetrics], tolerances: ToleranceSection
) -> list[Check]:
    """Those of ``"ancf"`` and ``"brush"`` that there are against the FE average, over the range they share up to 250 N:
    findings."""
    ancf, brush = metrics.get("ancf_average", _UNKNOWN), metrics.get("brush", _UNKNOWN)
    agree = tolerances.model_agreement
    against = "ANCF average against FE average"
    checks = [
        at_most(
            _agreement_claim(ancf, "ancf_vs_fe.relative_l2", against, "relative L2 difference"),
            lambda: ancf.relative_l2,
            agree,
        ),
        at_most(
            _agreement_claim(ancf, "ancf_vs_fe.max_error", f"{against}: largest difference", "load", "N"),
            lambda: ancf.max_error,
            agree * ancf.reference_load,
        ),
        near(
            _agreement_claim(ancf, "ancf_vs_fe.tangent", f"{against}: mean slope", "tangent", "N/m"),
            lambda: ancf.tangent,
            ancf.tangent_reference,
            agree,
        ),
        at_most(
            _agreement_claim(
                brush, "brush_vs_fe.relative_l2", "Brush line against FE average", "relative L2 difference"
            ),
            lambda: brush.relative_l2,
            agree,
        ),
    ]
    unknown = {"ancf": ancf is _UNKNOWN, "brush": brush is _UNKNOWN}
    return [
        replace(check, reference=None, tolerance="not known") if unknown[model] else check
        for check in checks
        if (model := check.id.partition("_")[0]) in models
    ]


def _agreement_claim(numbers: CurveMetrics, id: str, title: str, quantity: str, unit: str = "-") -> Claim:
    if numbers is _UNKNOWN:
        source = "no point of any FE curve converged"
    else:
        title += f", {numbers.start * 1e3:.1f} to {numbers.end * 1e3:.1f} mm"
        source = f"comparison where the FE average carries up to {numbers.reference_load:.4g} N; the limit is ours"
    return Claim(id=id, title=title, quantity=quantity, unit=unit, role="finding", source=source)


def user_checks(
    users: Sequence[UserCurve], metrics: Mapping[str, CurveMetrics], tolerances: ToleranceSection
) -> list[Check]:
    """The FE curve against each curve of the study's reference: findings."""
    return [
        at_most(
            Claim(
                id=f"user_{i}.relative_l2",
                title=f"FE {_place(user)} against the {user.kind} curve '{user.label}'",
                quantity="relative L2 difference",
                unit="-",
                role="finding",
                source=f"{user.kind}: {user.curve.source}",
            ),
            partial(_difference_from_user, metrics, i),
            tolerances.model_agreement,
        )
        for i, user in enumerate(users)
    ]


def _difference_from_user(metrics: Mapping[str, CurveMetrics], i: int) -> float:
    if f"user_{i}" not in metrics:
        raise InputError("FE curve", "no point", "converged at the user curve's orientation", "see its run's message")
    return metrics[f"user_{i}"].relative_l2


def _place(user: UserCurve) -> str:
    return "average" if user.orientation_deg is None else f"at {user.orientation_deg:g} deg"


def _tasks(study: Study) -> Sequence[Task]:
    return [metrics_task(study)] if study.brush is None else [brush_task(study), metrics_task(study)]


def _checks(study: Study, results: ComparedModels) -> Sequence[Check]:
    models = [name for name, curves in (("ancf", results.ancf), ("brush", results.brush)) if curves is not None]
    checks = agreement_checks(models, results.metrics, study.tolerances)
    checks += user_checks(results.continuum.users, results.metrics, study.tolerances)
    return noted(checks, results.agreements)


def _curves(study: Study, results: ComparedModels) -> Sequence[StiffnessCurve]:
    return () if results.brush is None else (results.brush,)


MODELS = Question(
    name="models",
    title="Models compared",
    group="Result",
    tasks=_tasks,
    read=read_models,
    checks=_checks,
    figures=models_figures,
    curves=_curves,
    budget=900,
)
