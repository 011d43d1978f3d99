"""Interactive figures of the page: axes, and the piece of HTML they become.

The one module that imports Plotly, not before there is a figure to make.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from typing import Any

from contracts.text import for_html, for_plotly, for_script
from workbench.charts.palette import INK

__all__ = [
    "Figure",
    "empty_figure",
    "figure_html",
    "log_axes",
    "log_axis",
    "low_figure",
    "plotly_script",
    "plotly_source",
]

type Figure = Any
"""Plotly's, which has no types."""
_SHOWN = ("name", "text", "label")
"""Keys of a figure under which Plotly finds what it shows."""


_DRAW_ALL = """addEventListener("DOMContentLoaded", () => document.querySelectorAll(".plot").forEach((box) => {
  const spec = JSON.parse(document.querySelector(`script[data-for="${box.id}"]`).textContent);
  Plotly.newPlot(box, spec.data, spec.layout, { responsive: true, displayModeBar: false, plotlyServerURL: "" });
}));"""


def plotly_source() -> str:
    """Plotly's JavaScript, for a page that draws its figures when they are seen."""
    from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

    return str(get_plotlyjs())


def plotly_script() -> str:
    """Plotly's JavaScript, to be put into a page once; it draws every figure of the page when it has loaded."""
    return f"{plotly_source()}\n{_DRAW_ALL}"


def empty_figure(x: str = "radial deflection [mm]", y: str = "load on the wheel [N]") -> Figure:
    """Axes in the page's style, with these titles; zero is shown."""
    import plotly.graph_objects as go  # type: ignore[import-untyped]

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


def low_figure(x: str, y: str) -> Figure:
    """Lower axes: two of them stand side by side."""
    figure = empty_figure(x, y)
    figure.update_layout(height=430, legend={"font": {"size": 11}})
    return figure


def log_axes(figure: Figure, ticks: list[float]) -> None:
    """Both axes logarithmic, with these ticks on the lower one."""
    figure.update_xaxes(type="log", rangemode="normal", tickvals=ticks)
    log_axis(figure)


def log_axis(figure: Figure) -> None:
    """The upward axis logarithmic."""
    figure.update_yaxes(type="log", rangemode="normal", exponentformat="power", dtick=1, title_standoff=12)
    figure.update_layout(margin_l=84)


def figure_html(figure: Figure, name: str) -> str:
    """The figure as a piece of the page: a place with this id, and the numbers the page draws there when it is seen.

    Names, titles and notes are text: Plotly, which reads markup in them, gets them escaped.
    """
    from plotly.io.json import to_json_plotly  # type: ignore[import-untyped]

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
