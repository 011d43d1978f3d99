"""Figures of a parameter study: parallel coordinates of its table, curves of each model.

Verified by tests/unit/test_workbench_sweep.py and tests/end_to_end/test_sweep.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from contracts.curves import StiffnessCurve
from workbench.charts.curves import named
from workbench.charts.interactive import Figure, empty_figure, figure_html
from workbench.charts.palette import INK, STRAIN_COLOURS
from workbench.questions.sweep.results import Outcome
from workbench.questions.sweep.table import Cell, SweepTable
from workbench.questions.sweep.words import Column, drawn_rows, told_columns
from workbench.study.sweep_points import Point

__all__ = ["coordinate_axes", "curves_figure", "parallel_coordinates", "point_words"]

_DASHES = ("solid", "dot", "dashdot")
_FEW = 12
"""More points than this are not named in the legend."""


def parallel_coordinates(table: SweepTable) -> str:
    """One line for each point and model through an axis for each value and number, coloured by the initial tangent."""
    axes = coordinate_axes(table)
    figure = empty_figure()
    colour = next((axis for axis in axes if axis["label"].startswith("initial tangent")), axes[-1])
    scale = [[i / (len(STRAIN_COLOURS) - 1), colour_] for i, colour_ in enumerate(STRAIN_COLOURS)]
    figure.add_parcoords(
        dimensions=axes,
        line={"color": colour["values"], "colorscale": scale, "cmin": colour["range"][0], "cmax": colour["range"][1]},
        labelfont={"size": 12, "color": INK},
        tickfont={"size": 12, "color": INK},
        rangefont={"size": 1, "color": "rgba(0, 0, 0, 0)"},
    )
    figure.update_layout(height=420, margin={"l": 80, "r": 80, "t": 48, "b": 24})
    return figure_html(figure, "sweep-coordinates")


def coordinate_axes(table: SweepTable) -> list[dict[str, Any]]:
    """Axes of the rows drawn: what was varied and the numbers told, as far as all of them have one; text as equally
    spaced names."""
    rows = drawn_rows(table)
    varied = dict(zip(table.inputs, table.labels, strict=True))
    if len(set(table.column("model"))) > 1:
        varied = {"model": "model"} | varied
    found = {column.name: column for column in told_columns(table)}
    cells = {name: [row[table.names.index(name)] for row in rows] for name in (*varied, *found)}
    whole = {name: held for name, held in cells.items() if held and None not in held}
    return [_axis(h, varied[n]) if n in varied else _found_axis(h, found[n]) for n, h in whole.items()]


def _axis(cells: Sequence[Cell], label: str) -> dict[str, Any]:
    """What was varied: a tick for each of a few values."""
    if any(isinstance(cell, str) for cell in cells):
        texts = sorted({str(cell) for cell in cells})
        places = [texts.index(str(cell)) for cell in cells]
        ends = [-0.5, len(texts) - 0.5]
        return {"label": label, "values": places, "tickvals": [*range(len(texts))], "ticktext": texts, "range": ends}
    values = [float(cell) for cell in cells if cell is not None]
    ticks = sorted(set(values))
    few = {"tickvals": ticks, "ticktext": [f"{v:g}" for v in ticks]} if len(ticks) <= 8 else {}
    return _between(values, label) | few


def _found_axis(cells: Sequence[Cell], column: Column) -> dict[str, Any]:
    """What was found, in the unit that engineers read."""
    return _between([column.factor * float(cell) for cell in cells if cell is not None], column.label)


def _between(values: list[float], label: str) -> dict[str, Any]:
    """An axis with some space at its ends."""
    low, high = min(values), max(values)
    margin = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    return {"label": label, "values": values, "range": [low - margin, high + margin]}


def curves_figure(found: Sequence[Outcome], model: str) -> str:
    """Curves of one model at every point, from dark to light with the load they reach at the common deflection.

    Beside points at one orientation each the study as it is has a line for each orientation, not their mean.
    """
    figure = empty_figure()
    own = [o for o in found if o.run.model == model and o.curve is not None]
    swept = [o for o in own if o.run.point.number and not _curve(o).unloaded]
    common = min((_curve(o).deflection[-1] for o in swept), default=0.0)
    ranked = sorted(swept, key=lambda o: float(_curve(o).load_at(common)))
    for outcome in own:
        if outcome.run.point.number == 0:
            _add_base(figure, outcome, single=all(len(o.by_orientation) == 1 for o in swept))
            continue
        rank = next((i for i, o in enumerate(ranked) if o is outcome), 0)
        colour = STRAIN_COLOURS[round(rank / max(len(ranked) - 1, 1) * (len(STRAIN_COLOURS) - 2))]
        line = {"color": colour, "width": 1.8, "dash": _DASHES[rank % 3]}
        _add(figure, _curve(outcome), point_words(outcome.run.point), line, named_too=len(ranked) <= _FEW)
    figure.update_layout(hovermode="closest")
    return figure_html(figure, f"sweep-{model}")


def point_words(point: Point) -> str:
    """``"3: strip thickness 0.55 mm, orientation 0 deg"``."""
    return f"{point.number}: " + ", ".join(f"{key.replace('_', ' ')} {value}" for key, value in point.values.items())


def _curve(outcome: Outcome) -> StiffnessCurve:
    assert outcome.curve is not None
    return outcome.curve


def _add_base(figure: Figure, base: Outcome, *, single: bool) -> None:
    """The study as it is: its mean, or each of its orientations."""
    curves = base.by_orientation if single and len(base.by_orientation) > 1 else (_curve(base),)
    for i, curve in enumerate(curves):
        at = f", {curve.orientation_deg:g} deg" if len(curves) > 1 else ""
        dash = ("dash", "longdash", "longdashdot")[i % 3]
        _add(figure, curve, base.run.point.label + at, {"color": INK, "width": 2.6, "dash": dash}, named_too=True)


def _add(figure: Figure, curve: StiffnessCurve, name: str, line: dict[str, Any], *, named_too: bool) -> None:
    figure.add_scatter(
        x=curve.deflection * 1e3,
        y=curve.load,
        name=named(name, curve),
        mode="lines",
        line=line,
        hovertemplate="%{y:.1f} N",
        showlegend=named_too,
    )
