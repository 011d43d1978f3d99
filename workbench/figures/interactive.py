"""Curves as interactive figures in the page. The one module that imports Plotly.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go  # type: ignore[import-untyped]
from plotly.io.json import to_json_plotly  # type: ignore[import-untyped]
from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.text import for_html, for_plotly, for_script
from workbench.comparison.curves import ModelCurves, UserCurve
from workbench.comparison.mesh_study import MeshStudy
from workbench.figures.palette import BAND, INK, MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.study.model import Band

__all__ = [
    "ancf_figure",
    "empty_figure",
    "fe_figure",
    "figure_html",
    "mesh_study_figure",
    "models_figure",
    "named",
    "plotly_script",
    "plotly_source",
    "section_figure",
    "stress_figure",
]

_MANY = 8
"""More orientations than this are drawn alike."""
_SHOWN = ("name", "text", "label")
"""Keys of a figure under which Plotly finds what it shows."""
_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")
_MARKERS = ("circle", "square", "diamond", "triangle-up", "cross", "x")


_DRAW_ALL = """addEventListener("DOMContentLoaded", () => document.querySelectorAll(".plot").forEach((box) => {
  const spec = JSON.parse(document.querySelector(`script[data-for="${box.id}"]`).textContent);
  Plotly.newPlot(box, spec.data, spec.layout, { responsive: true, displayModeBar: false, plotlyServerURL: "" });
}));"""


def plotly_source() -> str:
    """Plotly's JavaScript, for a page that draws its figures when they are seen."""
    return str(get_plotlyjs())


def plotly_script() -> str:
    """Plotly's JavaScript, to be put into a page once; it draws every figure of the page when it has loaded."""
    return f"{plotly_source()}\n{_DRAW_ALL}"


def fe_figure(fe: ModelCurves, study: MeshStudy | None, users: Sequence[UserCurve], band: Band | None) -> str:
    """FE at each orientation, their average with the mesh uncertainty, the band if there is one."""
    figure = empty_figure()
    _add_band(figure, band)
    _add_orientations(figure, fe, "FE")
    _add_uncertainty(figure, fe.average, study)
    _add_line(figure, fe.average, "FE average", MODEL_COLOURS["fe"], width=4.0)
    _add_users(figure, users)
    return figure_html(figure, "fe-curves")


def ancf_figure(fe: StiffnessCurve, ancf: ModelCurves) -> str:
    """ANCF at each orientation and their average, with the FE average behind."""
    figure = empty_figure()
    _add_line(figure, fe, "FE average", MODEL_COLOURS["fe"], width=2.0, dash="dot")
    _add_orientations(figure, ancf, "ANCF", first_colour=1)
    _add_line(figure, ancf.average, "ANCF average", MODEL_COLOURS["ancf"], width=4.0)
    return figure_html(figure, "ancf-curves")


def models_figure(
    fe: StiffnessCurve,
    study: MeshStudy | None,
    users: Sequence[UserCurve],
    band: Band | None,
    *,
    ancf: StiffnessCurve | None,
    brush: StiffnessCurve | None,
) -> str:
    """The averages of all models together, with the band and the user's curves."""
    figure = empty_figure()
    _add_band(figure, band)
    _add_uncertainty(figure, fe, study)
    _add_line(figure, fe, "FE average", MODEL_COLOURS["fe"], width=4.0)
    if ancf is not None:
        _add_line(figure, ancf, "ANCF average", MODEL_COLOURS["ancf"], width=4.0, dash="dash")
    if brush is not None:
        _add_line(figure, brush, "brush line", MODEL_COLOURS["brush"], width=3.0, dash="dot")
    _add_users(figure, users)
    return figure_html(figure, "model-curves")


def mesh_study_figure(study: MeshStudy) -> str:
    """Load over the extrapolated load, or over the finest mesh's, against the square of the element size."""
    figure = empty_figure("(element size / that of the coarsest mesh)²", "load / extrapolated load - 1 [%]")
    sizes = np.array([run.size / study.runs[-1].size for run in study.runs])
    for i, deflection in enumerate(study.deflections):
        try:
            found = study.convergence(deflection)
        except InputError:
            continue
        base = found.extrapolated if found.extrapolated is not None else found.values[0]
        figure.add_scatter(
            x=sizes**2,
            y=100.0 * (np.array(found.values) / base - 1.0),
            error_y={"type": "data", "array": [100.0 * found.index_fine, 100.0 * found.index_medium,
                                               100.0 * found.index_coarse], "thickness": 1.2, "width": 5},
            name=f"{1e3 * deflection:g} mm",
            mode="lines+markers",
            line={"color": ORIENTATION_COLOURS[i % 6], "width": 2.0, "dash": _DASHES[i % 6]},
            marker={"symbol": _MARKERS[i % 6], "size": 9},
            hovertemplate="%{y:.3f} %",
        )  # fmt: skip
    return figure_html(figure, "mesh-study")


def section_figure(section: ModelCurves, fe: ModelCurves) -> str:
    """Section model at each orientation as lines, the solid model's points on them, both averages."""
    figure = empty_figure()
    for i, (orientation, curve) in enumerate(section.by_orientation.items()):
        colour = ORIENTATION_COLOURS[i % 6]
        _add_line(figure, curve, f"section {orientation:g}°", colour, width=1.8, dash=_DASHES[i % 6])
        solid = fe.by_orientation.get(orientation)
        if solid is not None:
            figure.add_scatter(
                x=solid.deflection * 1e3,
                y=solid.load,
                name=named(f"solid {orientation:g}°", solid),
                mode="markers",
                marker={"symbol": _MARKERS[i % 6], "size": 6, "color": colour},
                hovertemplate="%{y:.1f} N",
            )
    _add_line(figure, section.average, "section average", MODEL_COLOURS["section"], width=4.0)
    _add_line(figure, fe.average, "solid average", MODEL_COLOURS["fe"], width=2.0, dash="dot")
    return figure_html(figure, "section-curves")


def stress_figure(curve: StiffnessCurve, strengths: Mapping[str, float]) -> str:
    """Largest von Mises stress of each part against load at one orientation, with the yield strength."""
    figure = empty_figure("load on the wheel [N]", "largest von Mises stress [MPa]")
    parts = [p for p in strengths if f"max_von_mises_{p}_Pa" in curve.columns]
    for i, part in enumerate(parts):
        stress = curve.columns[f"max_von_mises_{part}_Pa"] * 1e-6
        style = {"color": ORIENTATION_COLOURS[i % 6], "width": 2.5, "dash": _DASHES[i % 6]}
        figure.add_scatter(x=curve.load, y=stress, name=part.replace("_", " "), mode="lines", line=style)
    for strength in sorted({strengths[p] for p in parts}):
        figure.add_hline(
            y=strength * 1e-6,
            line={"color": INK, "width": 1, "dash": "dash"},
            annotation={"text": f"yield strength {strength * 1e-6:.0f} MPa", "font": {"size": 12}},
            annotation_position="top left",
        )
    return figure_html(figure, "stress-curves")


def empty_figure(x: str = "radial deflection [mm]", y: str = "load on the wheel [N]") -> go.Figure:
    """Axes in the page's style, with these titles; zero is shown."""
    axis = {
        "showline": True,
        "linecolor": "#9aa0a6",
        "gridcolor": "#e8eaed",
        "zeroline": False,
        "rangemode": "tozero",
        "ticks": "outside",
        "tickcolor": "#9aa0a6",
    }
    layout = {
        "template": "none",
        "font": {"family": "system-ui, -apple-system, Segoe UI, Roboto, sans-serif", "size": 14, "color": INK},
        "margin": {"l": 64, "r": 16, "t": 16, "b": 56},
        "height": 480,
        "hovermode": "x unified",
        "legend": {"orientation": "h", "yanchor": "bottom", "y": 1.02, "x": 0.0},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "xaxis": {**axis, "title": {"text": x, "font": {"size": 13}}},
        "yaxis": {**axis, "title": {"text": y, "font": {"size": 13}}},
    }
    return go.Figure(layout=layout)


def figure_html(figure: go.Figure, name: str) -> str:
    """The figure as a piece of the page: a place with this id, and the numbers the page draws there when it is seen.

    Names, titles and notes are text: Plotly, which reads markup in them, gets them escaped.
    """
    text = for_script(str(to_json_plotly(_escaped(figure.to_dict()))))
    height = int(figure.layout.height)
    titles = (figure.layout.xaxis.title.text, figure.layout.yaxis.title.text)
    label = for_html(f"{titles[1]} against {titles[0]}")
    return (
        f'<div class="plot" id="{name}" role="img" aria-label="{label}" style="height: {height}px"></div>'
        f'<script type="application/json" data-for="{name}">{text}</script>'
    )


def _escaped(spec: Any) -> Any:
    """The figure's dictionary with every text that is shown escaped."""
    if isinstance(spec, dict):
        return {k: for_plotly(v) if k in _SHOWN and isinstance(v, str) else _escaped(v) for k, v in spec.items()}
    return [_escaped(one) for one in spec] if isinstance(spec, list | tuple) else spec


def named(name: str, curve: StiffnessCurve) -> str:
    """Name in a legend, with what the curve lacks."""
    return name + (" (missing)" if curve.unloaded else " (partial)" if curve.partial else "")


def _add_line(
    figure: go.Figure, curve: StiffnessCurve, name: str, colour: str, width: float, dash: str = "solid"
) -> None:
    figure.add_scatter(
        x=curve.deflection * 1e3,
        y=curve.load,
        name=named(name, curve),
        mode="lines",
        line={"color": colour, "width": width, "dash": dash},
        hovertemplate="%{y:.1f} N",
    )


def _add_orientations(figure: go.Figure, curves: ModelCurves, model: str, first_colour: int = 0) -> None:
    """A line for each orientation; of more than can be told apart only their range is named."""
    if len(curves.by_orientation) > _MANY:
        _add_cloud(figure, curves, model)
        return
    for i, (orientation, curve) in enumerate(curves.by_orientation.items(), start=first_colour):
        figure.add_scatter(
            x=curve.deflection * 1e3,
            y=curve.load,
            name=named(f"{model} {orientation:g}°", curve),
            mode="lines+markers",
            line={"color": ORIENTATION_COLOURS[i % 6], "width": 1.6, "dash": _DASHES[i % 6]},
            marker={"symbol": _MARKERS[i % 6], "size": 5, "maxdisplayed": 12},
            hovertemplate="%{y:.1f} N",
        )


def _add_cloud(figure: go.Figure, curves: ModelCurves, model: str) -> None:
    first, *_, last = curves.by_orientation
    for orientation, curve in curves.by_orientation.items():
        figure.add_scatter(
            x=curve.deflection * 1e3,
            y=curve.load,
            name=f"{model} {first:g}° to {last:g}°",
            legendgroup=model,
            showlegend=orientation == first,
            mode="lines",
            line={"color": "#9aa0a6", "width": 1.0},
            hoverinfo="skip",
        )


def _add_uncertainty(figure: go.Figure, average: StiffnessCurve, study: MeshStudy | None) -> None:
    """The average's numerical uncertainty as a grey band; nothing if no mesh study gives one."""
    if study is None:
        return
    try:
        low, high = study.band(average)
    except InputError:
        return
    d = average.deflection * 1e3
    figure.add_scatter(
        x=np.concatenate([d, d[::-1]]),
        y=np.concatenate([high, low[::-1]]),
        fill="toself",
        fillcolor="rgba(26, 26, 26, 0.22)",
        line={"width": 0},
        name="numerical uncertainty of the FE average",
        hoverinfo="skip",
    )


def _add_band(figure: go.Figure, band: Band | None) -> None:
    """The band as it is known: a slope near the origin and one interval of deflection at each load."""
    if band is None:
        return
    end = 8.0
    slope = band.initial_tangent * 1e-3
    figure.add_scatter(
        x=[0.0, end],
        y=[0.0, slope * end],
        mode="lines",
        line={"color": "#009e73", "width": 7},
        opacity=0.35,
        name=f"inferred slope {slope:g} N/mm",
        hoverinfo="skip",
    )
    loads = [p.load for p in band.points]
    figure.add_scatter(
        x=[500.0 * (p.low + p.high) for p in band.points],
        y=loads,
        mode="markers",
        marker={"color": "#009e73", "symbol": "line-ns-open", "size": 14},
        error_x={"type": "data", "array": [500.0 * (p.high - p.low) for p in band.points], "color": "#009e73",
                 "thickness": 4, "width": 9},
        name="inferred band",
        hovertemplate="%{x:.1f} mm",
    )  # fmt: skip
    for p in band.points:
        figure.add_shape(type="rect", x0=1e3 * p.low, x1=1e3 * p.high, y0=p.load - 5.0, y1=p.load + 5.0,
                         fillcolor=BAND, line={"width": 0}, layer="below")  # fmt: skip


def _add_users(figure: go.Figure, users: Sequence[UserCurve]) -> None:
    for i, user in enumerate(users):
        figure.add_scatter(
            x=user.curve.deflection * 1e3,
            y=user.curve.load,
            name=user.label,
            mode="markers+lines",
            marker={"symbol": "star", "size": 8},
            line={"color": ("#cc79a7", "#56b4e9", "#f0e442")[i % 3], "width": 1.5},
            hovertemplate="%{y:.1f} N",
        )
