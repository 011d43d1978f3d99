"""Figures of a parameter study: parallel coordinates of its table, curves of each model.

Verified by tests/unit/test_workbench_sweep.py and tests/end_to_end/test_sweep.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from workbench.charts.curves import named
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, STRAIN_COLOURS
from workbench.questions.sweep.results import Outcome
from workbench.questions.sweep.table import Cell, SweepTable

__all__ = ["coordinate_axes", "curves_figure", "parallel_coordinates"]

_SCALED = {"_N_per_m": (1e-3, "N/mm"), "_Pa": (1e-6, "MPa"), "_m": (1e3, "mm"), "_N": (1.0, "N"), "_deg": (1.0, "deg")}
"""Ending of a column's name -> factor and unit in which its axis is drawn."""
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
        labelangle=-20,
        labelfont={"size": 13, "color": INK},
        tickfont={"size": 12, "color": INK},
        rangefont={"size": 1, "color": "rgba(0, 0, 0, 0)"},
    )
    figure.update_layout(height=480, margin={"l": 70, "r": 110, "t": 120, "b": 24})
    return figure_html(figure, "sweep-coordinates")


def coordinate_axes(table: SweepTable) -> list[dict[str, Any]]:
    """Axes of the rows drawn: every value and number that all of them have, text as equally spaced names."""
    rows = _drawn_rows(table)
    names = [*(("model",) if len(set(table.column("model"))) > 1 else ()), *table.inputs, *table.outputs]
    columns = {name: [row[table.names.index(name)] for row in rows] for name in names}
    text = {name for name in table.outputs if any(isinstance(cell, str) for cell in columns[name])}
    whole = {name: cells for name, cells in columns.items() if cells and None not in cells and name not in text}
    told = dict(zip(table.inputs, table.labels, strict=True)) | {"model": "model"}
    return [_axis(cells, told[name]) if name in told else _found_axis(cells, name) for name, cells in whole.items()]


def _drawn_rows(table: SweepTable) -> list[tuple[Cell, ...]]:
    """Rows with values and numbers: neither the study as it is, nor a point that failed."""
    point, state = table.names.index("point"), table.names.index("state")
    return [row for row in table.rows if row[point] != 0 and row[state] != "failed"]


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


def _found_axis(cells: Sequence[Cell], name: str) -> dict[str, Any]:
    """What was found, in the unit that engineers read."""
    ending = next((ending for ending in _SCALED if name.endswith(ending)), "")
    factor, unit = _SCALED[ending] if ending else (1.0, "-")
    values = [factor * float(cell) for cell in cells if cell is not None]
    return _between(values, f"{name.removesuffix(ending).replace('_', ' ')} [{unit}]")


def _between(values: list[float], label: str) -> dict[str, Any]:
    """An axis with some space at its ends."""
    low, high = min(values), max(values)
    margin = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    return {"label": label, "values": values, "range": [low - margin, high + margin]}


def curves_figure(found: Sequence[Outcome], model: str) -> str:
    """Curves of one model at every point, from dark to light with the load they reach at the common deflection."""
    figure = empty_figure()
    curves = [(o.run.point, o.curve) for o in found if o.run.model == model and o.curve is not None]
    swept = [(point, curve) for point, curve in curves if point.number and not curve.unloaded]
    common = min((curve.deflection[-1] for _, curve in swept), default=0.0)
    stiff = {point.number: float(curve.load_at(common)) for point, curve in swept}
    order = {number: i for i, number in enumerate(sorted(stiff, key=lambda n: stiff[n]))}
    for point, curve in curves:
        base = point.number == 0
        rank = order.get(point.number, 0)
        colour = INK if base else STRAIN_COLOURS[round(rank / max(len(order) - 1, 1) * (len(STRAIN_COLOURS) - 2))]
        figure.add_scatter(
            x=curve.deflection * 1e3,
            y=curve.load,
            name=named(f"{point.number}: {point.label}" if not base else point.label, curve),
            mode="lines",
            line={"color": colour, "width": 3.0 if base else 1.8, "dash": "dash" if base else _DASHES[rank % 3]},
            hovertemplate="%{y:.1f} N",
            showlegend=base or len(swept) <= _FEW,
        )
    figure.update_layout(
        hovermode="closest", height=560, legend={"orientation": "v", "y": 1.0, "yanchor": "top", "x": 1.02}
    )
    return figure_html(figure, f"sweep-{model}")
