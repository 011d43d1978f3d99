"""Pieces of figures that hold what we found against what is published: lines, points, bands, load paths.

Verified by tests/unit/test_workbench_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from workbench.charts.interactive import empty_figure
from workbench.charts.palette import BAND, ORIENTATION_COLOURS

__all__ = ["add_band", "add_line", "add_path", "add_points", "cantilever_figure", "log_axes", "low_figure"]

_BLUE, _ORANGE, _GREEN, _PINK = ORIENTATION_COLOURS[:4]


def low_figure(x: str, y: str) -> Any:
    """Two of them stand side by side."""
    figure = empty_figure(x, y)
    figure.update_layout(height=430, legend={"font": {"size": 11}})
    return figure


def log_axes(figure: Any, ticks: list[float]) -> None:
    """Both axes logarithmic, with these ticks on the lower one."""
    figure.update_xaxes(type="log", rangemode="normal", tickvals=ticks)
    figure.update_yaxes(type="log", rangemode="normal", exponentformat="power", dtick=1, title_standoff=12)
    figure.update_layout(margin_l=84)


def cantilever_figure(shear: Mapping[str, Any], moment: Mapping[str, Any]) -> Any:
    """Deflection and shortening over length of Sze, Liu and Lo's two cantilevers against load, their points on ours."""
    figure = low_figure("load / full load", "displacement / length")
    cases = ((shear, "shear", 10.0, (_GREEN, _BLUE)), (moment, "moment", 12.0, (_PINK, _ORANGE)))
    for numbers, label, length, colours in cases:
        for k, way in enumerate(("shortening", "deflection")):
            add_path(figure, numbers, k, f"{label}: {way}", colours[k], 1.0 / length)
    return figure


def add_path(figure: Any, numbers: Mapping[str, Any], k: int, name: str, colour: str, scale: float = 1.0) -> None:
    """One displacement of a load path: ours as a line from rest, the published ones as points."""
    table, ours = np.array(numbers["table"]), np.array(numbers["deflection"])[:, k]
    add_line(figure, [0.0, *numbers["load"]], scale * np.append(0.0, ours), f"{name}, ours", colour)
    add_points(figure, table[:, 0], scale * table[:, 1 + k], f"{name}, Sze et al.", colour, "circle-open")


def add_line(figure: Any, x: Any, y: Any, name: str, colour: str, dash: str = "solid") -> None:
    """A curve."""
    line = {"color": colour, "width": 1.8, "dash": dash}
    figure.add_scatter(x=x, y=y, name=name, mode="lines", line=line, hovertemplate="%{y:.4g}")


def add_points(figure: Any, x: Any, y: Any, name: str, colour: str, symbol: str) -> None:
    """Single points."""
    marker = {"color": colour, "symbol": symbol, "size": 8}
    figure.add_scatter(x=x, y=y, name=name, mode="markers", marker=marker, hovertemplate="%{y:.4g}")


def add_band(figure: Any, x: Any, y: Any, share: float, name: str) -> None:
    """Tolerance band of a share of y."""
    figure.add_scatter(
        x=np.append(x, x[::-1]),
        y=np.append(y * (1.0 - share), (y * (1.0 + share))[::-1]),
        fill="toself",
        fillcolor=BAND,
        line={"width": 0},
        name=name,
        hoverinfo="skip",
    )
