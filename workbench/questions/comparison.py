"""The comparison: stored results in, every question's answer and checks out.

Verified by tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve
from contracts.records import Check
from contracts.series import TimeSeries
from workbench.questions.models.agreement import Agreement
from workbench.questions.models.question import MODELS
from workbench.questions.models.results import ComparedModels
from workbench.questions.registry import questions_of
from workbench.study.model import Study
from workbench.study.sections import ToleranceSection
from workbench.verdict.statements import statement_of

__all__ = ["Comparison", "compare"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Everything the report shows that came out of the results.

    Attributes
    ----------
    answers : results of each question by its name
    checks : the verdict, line by line
    question_of : identifier of a check -> question that made it
    curves, series : to be published
    """

    answers: Mapping[str, Any]
    checks: tuple[Check, ...]
    question_of: Mapping[str, str]
    curves: tuple[StiffnessCurve, ...]
    series: tuple[TimeSeries, ...]

    @property
    def agreements(self) -> Mapping[str, Agreement]:
        """Each pair of models judged against its limit and the numerical uncertainty."""
        models = self.answers[MODELS.name]
        assert isinstance(models, ComparedModels)
        return models.agreements


def compare(study: Study, folders: Mapping[str, Path]) -> Comparison:
    """Read the results of ``report_tasks`` and hold them against their references.

    Parameters
    ----------
    study : supplies references and tolerances
    folders : result folder of each task by name
    """
    asked = questions_of(study)
    answers = {question.name: question.read(study, folders) for question in asked}
    made = {question.name: question.checks(study, answers[question.name]) for question in asked}
    return Comparison(
        answers=answers,
        checks=tuple(_with_own_limit(check, study.tolerances) for checks in made.values() for check in checks),
        question_of={check.id: name for name, checks in made.items() for check in checks},
        curves=tuple(one for question in asked for one in question.curves(study, answers[question.name])),
        series=tuple(one for question in asked for one in question.series(study, answers[question.name])),
    )


def _with_own_limit(check: Check, tolerances: ToleranceSection) -> Check:
    """Says so where the study sets the limit itself: the reason given is that of the limit by default."""
    setting = statement_of(check.id, check.quantity, check.title).setting
    if not setting or getattr(tolerances, setting) == getattr(ToleranceSection(), setting):
        return check
    return replace(check, why=f"The study sets this limit itself ([tolerances] {setting}). By default: {check.why}")
