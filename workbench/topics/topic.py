"""A topic: one question the report answers beside the comparison of models, with its tasks, checks and section.

Verified by tests/unit/test_workbench_topics.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve
from contracts.records import Check
from contracts.series import TimeSeries
from workbench.execution.task import Task
from workbench.study.model import Study

__all__ = ["Topic"]


def _always(study: Study) -> bool:
    return True


def _no_figures(study: Study, results: Any) -> Mapping[str, str]:
    return {}


def _no_curves(study: Study, results: Any) -> Sequence[StiffnessCurve]:
    return ()


def _no_series(study: Study, results: Any) -> Sequence[TimeSeries]:
    return ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """One topic of the report.

    Attributes
    ----------
    name : identifier; the section is ``templates/section_{name}.html.j2``, which sees the results as ``topic``
    title : what the page's navigation calls it
    tasks : study -> tasks, each after those it needs; "mesh", "mesh_whole" and "fe_phi..." are there already
    read : study, result folder of every task by name -> the topic's results
    checks : study, the topic's results -> checks
    figures : study, the topic's results -> HTML of each figure by name; the template sees them as ``figures``
    curves : study, the topic's results -> curves to publish as CSV beside the models'
    series : study, the topic's results -> time series to publish as CSV; the section links them by
        ``series_link(name)`` of the macros
    applies : False leaves the topic out of this study's graph and report
    """

    name: str
    title: str
    tasks: Callable[[Study], Sequence[Task]]
    read: Callable[[Study, Mapping[str, Path]], Any]
    checks: Callable[[Study, Any], Sequence[Check]]
    figures: Callable[[Study, Any], Mapping[str, str]] = _no_figures
    curves: Callable[[Study, Any], Sequence[StiffnessCurve]] = _no_curves
    series: Callable[[Study, Any], Sequence[TimeSeries]] = _no_series
    applies: Callable[[Study], bool] = _always
