"""Figures of the multibody engine: error against work. Verified by tests/unit/test_workbench_multibody.py."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from workbench.charts.interactive import figure_html, log_axes, low_figure
from workbench.charts.palette import ORIENTATION_COLOURS

if TYPE_CHECKING:
    from workbench.questions.multibody.results import MultibodyResults, WorkRow
    from workbench.study.model import Study

__all__ = ["work_figures"]

_DASHES = {"explicit": "solid", "implicit": "dash"}


def work_figures(study: Study, results: MultibodyResults) -> dict[str, str]:
    """HTML by name: error against evaluations of the equations of motion, and against processor time."""
    rows = results.rows
    return {
        "evaluations": _figure(rows, "evaluations", "evaluations of the equations of motion", [300, 1000, 3000, 10000]),
        "seconds": _figure(rows, "seconds", "processor time [s]", [0.03, 0.1, 0.3, 1.0, 3.0, 10.0]),
    }


def _figure(rows: Sequence[WorkRow], work: str, label: str, ticks: list[float]) -> str:
    """A line for each problem and kind of steps, from the largest error allowed to the smallest."""
    figure = low_figure(label, "largest error [m; A03: relative rate]")
    log_axes(figure, ticks)
    problems = list(dict.fromkeys(row.problem for row in rows))
    for problem, method in dict.fromkeys((row.problem, row.method) for row in rows):
        line = [row for row in rows if (row.problem, row.method) == (problem, method)]
        colour = ORIENTATION_COLOURS[problems.index(problem)]
        figure.add_scatter(
            x=[getattr(row, work) for row in line],
            y=[row.error for row in line],
            name=f"{line[0].title}, {method}",
            mode="lines+markers",
            line={"color": colour, "width": 1.8, "dash": _DASHES[method]},
            marker={"size": 8, "symbol": "circle" if method == "explicit" else "square-open"},
            text=[f"{row.allowed:g} a step" for row in line],
            hovertemplate="%{text}: %{y:.3g}",
        )
    figure.update_layout(hovermode="closest")
    return figure_html(figure, f"multibody-{work}")
