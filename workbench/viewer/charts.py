"""Curves and time series as Plotly figures, in the plain form the page's script takes.

Verified by tests/unit/test_viewer_charts.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.series import TimeSeries
from workbench.charts.palette import INK, MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.viewer.folder import spoken
from workbench.viewer.mode_shapes import Mode
from workbench.viewer.names import chart_text, plain

__all__ = ["curves_chart", "modes_chart", "quantities", "series_chart"]

Figure = dict[str, Any]
_COLOURS = tuple(c for c in ORIENTATION_COLOURS if c not in MODEL_COLOURS.values())
_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")
_QUANTITIES = {
    "load_N": ("wheel load [N]", 1.0),
    "deflection_m": ("radial deflection [mm]", 1e3),
    "tractive_N": ("tractive force [N]", 1.0),
    "lateral_N": ("lateral force [N]", 1.0),
}
"""End of a column's name -> title of the axis, factor to its unit."""
_FACTORS = {"_m": ("[mm]", 1e3), "_m_s": ("[mm/s]", 1e3), "_rad": ("[°]", 180.0 / np.pi), "_N": ("[N]", 1.0)}


def curves_chart(
    curves: Mapping[str, StiffnessCurve], own: Sequence[str], shown: tuple[str, float, float] | None
) -> Figure:
    """Load against deflection of curves by name.

    own : names of curves a user added, drawn as given
    shown : name, deflection [m] and load [N] of what the wheel shows, marked; or None
    """
    lines: list[Figure] = []
    colour = 0
    for name, curve in curves.items():
        model, average = name.split("_")[0], name.endswith("_average")
        kept = average and model in MODEL_COLOURS
        style = MODEL_COLOURS[model] if kept else _COLOURS[colour % len(_COLOURS)]
        dash = "solid" if kept else _DASHES[colour // len(_COLOURS) % len(_DASHES)]
        colour += not kept
        lines.append(
            {
                "type": "scatter",
                "mode": "lines+markers" if name in own else "lines",
                "name": chart_text(name if name in own else spoken(name)) + " (partial)" * curve.partial,
                "x": _rounded(1e3 * curve.deflection),
                "y": _rounded(curve.load),
                "line": {"color": style, "width": 3.5 if kept else 2.0, "dash": dash},
                "hovertemplate": "%{y:.1f} N",
            }
        )
    if shown is not None:
        name, deflection, load = shown
        mark = {"color": "#d81b60", "size": 11, "line": {"color": "white", "width": 2}}
        place: Figure = {"x": [1e3 * deflection], "y": [load], "mode": "markers", "type": "scatter", "marker": mark}
        lines.append(place | {"name": f"shown: {name}", "hovertemplate": "%{y:.1f} N"})
    return {"data": lines, "layout": _layout("radial deflection [mm]", "load on the wheel [N]", "tozero")}


def modes_chart(modes: Sequence[Mode], shown: int) -> Figure:
    """Frequencies of modes over their numbers; the one that is shown is marked."""
    bars = {
        "type": "bar",
        "x": list(range(1, len(modes) + 1)),
        "y": _rounded([one.frequency for one in modes]),
        "text": [chart_text(one.kind) for one in modes],
        "marker": {"color": ["#d81b60" if k == shown else MODEL_COLOURS["ancf"] for k in range(len(modes))]},
        "hovertemplate": "%{y:.2f} Hz, %{text}<extra></extra>",
        "textposition": "none",
        "showlegend": False,
    }
    layout = _layout("number of the mode", "frequency [Hz]", "tozero")
    return {
        "data": [bars],
        "layout": layout | {"hovermode": "closest", "xaxis": layout["xaxis"] | {"rangemode": "normal"}},
    }


def quantities(series: TimeSeries) -> dict[str, str]:
    """What of a series can be drawn: key -> title; of wheels all six together, of everything else one column."""
    found = {}
    for key, (title, _) in _QUANTITIES.items():
        if any(column.endswith(f"_{key}") for column in series.columns):
            found[key] = title
    single = [c for c in series.columns if not any(c.endswith(f"_{key}") for key in _QUANTITIES)]
    return found | {column: plain(_titled(column)[0]) for column in single}


def series_chart(series: TimeSeries, quantity: str) -> Figure:
    """One quantity of a series against time, see `quantities`."""
    if quantity in _QUANTITIES:
        title, factor = _QUANTITIES[quantity]
        columns = {c: c.removesuffix(f"_{quantity}") for c in series.columns if c.endswith(f"_{quantity}")}
    else:
        title, factor = _titled(quantity)
        columns = {quantity: title.partition(" [")[0]}
    lines = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": chart_text(plain(label.replace("_", " "))),
            "x": _rounded(series.time),
            "y": _rounded(factor * series[column]),
            "line": {
                "color": ORIENTATION_COLOURS[k % len(ORIENTATION_COLOURS)],
                "width": 1.8,
                "dash": "dash" if label.endswith("right") else "solid",
            },
            "hovertemplate": "%{y:.4g}",
        }
        for k, (column, label) in enumerate(columns.items())
    ]
    return {"data": lines, "layout": _layout("time [s]", chart_text(plain(title)), "normal")}


def _titled(column: str) -> tuple[str, float]:
    """Title with unit, and factor to it, of a column named as ``body_x_m``."""
    for end in sorted(_FACTORS, key=len, reverse=True):
        if column.endswith(end):
            unit, factor = _FACTORS[end]
            return f"{column.removesuffix(end).replace('_', ' ')} {unit}", factor
    return column, 1.0


def _rounded(values: Any) -> list[float]:
    """Six digits are more than a screen shows."""
    return [float(f"{value:.6g}") for value in values]


def _layout(x: str, y: str, mode: str) -> Figure:
    axis = {
        "showline": True,
        "linecolor": "#9aa0a6",
        "gridcolor": "#e8eaed",
        "zeroline": False,
        "rangemode": mode,
        "ticks": "outside",
        "tickcolor": "#9aa0a6",
        "automargin": True,
    }
    return {
        "font": {"family": "system-ui, -apple-system, Segoe UI, Roboto, sans-serif", "size": 13, "color": INK},
        "margin": {"l": 60, "r": 18, "t": 12, "b": 48},
        "autosize": True,
        "hovermode": "x unified",
        "legend": {"orientation": "h", "yanchor": "bottom", "y": 1.02, "x": 0.0},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "xaxis": {**axis, "title": {"text": x}},
        "yaxis": {**axis, "title": {"text": y}},
    }
