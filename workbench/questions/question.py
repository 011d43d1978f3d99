"""A question that the report answers, with everything it takes: tasks, results, checks, figures, section.

Verified by tests/unit/test_workbench_questions.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from contracts.curves import StiffnessCurve
from contracts.records import Check
from contracts.series import TimeSeries
from workbench.execution.task import Task
from workbench.study.model import Study

__all__ = ["Group", "Question", "no_tasks"]

Group = Literal["Result", "Wheel", "ANCF tire", "Rover", "Solvers"]
"""Headings of the report's contents, in their order."""


def no_tasks(study: Study) -> Sequence[Task]:
    """A question answered from the results of others."""
    return ()


def _none(study: Study, results: Any) -> tuple[()]:
    return ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """One question of the report.

    Attributes
    ----------
    name : identifier, and the folder beside this module that holds everything about it: its section of the report,
        ``section.html.j2``, and of the evidence, ``evidence.html.j2``, one of them or both, which see the results as
        ``results``, and ``statements.toml``, the words of its checks
    title : what the page's navigation calls it
    group : heading of the contents it stands under
    read : study, result folder of every task of the report by name -> the results, a frozen record
    tasks : study -> tasks; those they need may be any question's
    checks : study, results -> checks; they lead to this question's section
    figures : study, results -> HTML of each figure by name; the sections see them as ``figures``
    curves : study, results -> curves to publish as CSV
    series : study, results -> time series to publish as CSV; the section links them by ``series_link(name)`` of the
        macros
    applies : False leaves the question out of this study's graph and report
    budget : height that its section in the report may take where the window is 1440 wide [CSS points]; 0 for a question
        that stands in the evidence alone
    """

    name: str
    title: str
    group: Group
    read: Callable[[Study, Mapping[str, Path]], Any]
    tasks: Callable[[Study], Sequence[Task]] = no_tasks
    checks: Callable[[Study, Any], Sequence[Check]] = _none
    figures: Callable[[Study, Any], Mapping[str, str]] = lambda study, results: {}
    curves: Callable[[Study, Any], Sequence[StiffnessCurve]] = _none
    series: Callable[[Study, Any], Sequence[TimeSeries]] = _none
    applies: Callable[[Study], bool] = lambda study: True
    budget: int = 0
