"""Figures of an optimisation: the trade-off with its front, and the curves of what was confirmed.

Verified by tests/end_to_end/test_optimise.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from workbench.charts.curves import DASHES, add_line
from workbench.charts.interactive import Figure, empty_figure
from workbench.charts.palette import INK, ORIENTATION_COLOURS
from workbench.questions.optimise.judging import Assessed, Confirmed, front
from workbench.questions.sweep.words import column_of
from workbench.study.optimise import OptimiseSection

__all__ = ["confirmed_figure", "trade_figure"]

_ROOM = 0.6
"""Of the feasible points' extent, that the axes show on each side; points further away are in the table."""


def trade_figure(points: Sequence[Assessed], confirmed: Sequence[Confirmed], section: OptimiseSection) -> Figure:
    """Objective and what is traded for it: points beyond the limits, feasible ones, the front, what was confirmed."""
    x, y = column_of(section.objective.column), column_of(section.trade.column)
    figure = empty_figure(x.label, y.label)
    figure.update_layout(hovermode="closest", xaxis_rangemode="normal", yaxis_rangemode="normal", height=520)

    def place(point: Assessed) -> tuple[float, float] | None:
        values = [point.numbers.get(column.name) for column in (x, y)]
        at = [c.factor * v for c, v in zip((x, y), values, strict=True) if isinstance(v, float | int)]
        return (at[0], at[1]) if len(at) == 2 else None

    def add(chosen: Sequence[Assessed], name: str, marker: dict[str, object], mode: str = "markers") -> None:
        at = [(found, point) for point in chosen if (found := place(point)) is not None]
        if at:
            figure.add_scatter(
                x=[found[0] for found, _ in at],
                y=[found[1] for found, _ in at],
                name=name,
                mode=mode,
                marker=marker,
                line={"color": ORIENTATION_COLOURS[0], "width": 1.6},
                text=[f"point {point.number}" for _, point in at],
            )

    searched = [point for point in points if point.number]
    best_ones = front(searched, section)
    beaten = [point for point in searched if point.feasible and point not in best_ones]
    add([p for p in searched if not p.feasible], "beyond a limit", {"symbol": "x", "size": 6, "color": "#9aa0a6"})
    add(beaten, "within the limits", {"symbol": "circle", "size": 6, "color": ORIENTATION_COLOURS[5]})
    add(best_ones, f"front, {section.model} model", {"symbol": "circle", "size": 8, "color": ORIENTATION_COLOURS[0]},
        "lines+markers")  # fmt: skip
    add([p for p in points if not p.number], "the study as it is", {"symbol": "diamond", "size": 11, "color": INK})
    within = [one.solid for one in confirmed if one.solid.feasible]
    beyond = [one.solid for one in confirmed if not one.solid.feasible]
    add(within, "solid model, within the limits", {"symbol": "star", "size": 15, "color": ORIENTATION_COLOURS[2]})
    add(beyond, "solid model, beyond a limit", {"symbol": "triangle-up", "size": 12, "color": "#d55e00"})
    shown = [p for p in points if p.feasible or not p.number] + within + beyond
    ends = np.array([at for point in shown if (at := place(point)) is not None])
    if len(ends) > 1:
        low, high = ends.min(axis=0), ends.max(axis=0)
        margin = np.where(high > low, _ROOM * (high - low), 0.1 * np.abs(high) + 1e-9)
        for i, axis in enumerate((figure.update_xaxes, figure.update_yaxes)):
            axis(range=[float(low[i] - margin[i]), float(high[i] + margin[i])])
    return figure


def confirmed_figure(one: Confirmed, section: OptimiseSection) -> Figure:
    """Curves of a confirmed point: the solid model at each orientation, the means of both, the stiffness asked for."""
    figure = empty_figure()
    for i, curve in enumerate(one.solid.outcome.by_orientation):
        add_line(figure, curve, f"solid {curve.orientation_deg:g}°", ORIENTATION_COLOURS[i % 6], width=1.4,
                 dash=DASHES[i % 6])  # fmt: skip
    for model, assessed, dash in (("solid", one.solid, "solid"), (section.model, one.fast, "dash")):
        if assessed.outcome.curve is not None:
            add_line(figure, assessed.outcome.curve, f"{model}, mean", INK, width=3.0, dash=dash)
    band = section.stiffness
    for name, stiffness in (("softest", band.low), ("stiffest", band.high)) if band is not None else ():
        if stiffness is not None:
            figure.add_scatter(
                x=[0.0, 1e3 * section.load / stiffness],
                y=[0.0, section.load],
                name=f"{name} that will do, {1e-3 * stiffness:g} N/mm",
                mode="lines",
                line={"color": "#9aa0a6", "width": 1.5, "dash": "dot"},
            )
    return figure
