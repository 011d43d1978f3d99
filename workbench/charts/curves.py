"""Lines and areas of an interactive figure; stiffness curves. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contracts.curves import StiffnessCurve
from workbench.charts.interactive import Figure
from workbench.charts.palette import BAND, ORIENTATION_COLOURS

__all__ = ["DASHES", "MARKERS", "add_area", "add_line", "add_orientations", "add_plain", "named"]

_MANY = 8
"""More orientations than this are drawn alike."""
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")
MARKERS = ("circle", "square", "diamond", "triangle-up", "cross", "x")


def named(name: str, curve: StiffnessCurve) -> str:
    """Name in a legend, with what the curve lacks."""
    return name + (" (missing)" if curve.unloaded else " (partial)" if curve.partial else "")


def add_plain(
    figure: Figure, x: ArrayLike, y: ArrayLike, name: str, colour: str, width: float = 2.0, mode: str = "lines"
) -> None:
    """A line through any numbers."""
    figure.add_scatter(x=x, y=y, name=name, mode=mode, line={"color": colour, "width": width})


def add_area(
    figure: Figure,
    x: NDArray[np.float64],
    there: ArrayLike,
    back: NDArray[np.float64],
    name: str,
    colour: str = BAND,
    outline: str | None = None,
) -> None:
    """The area between two lines over the same places; with an outline where a line may cover it whole."""
    figure.add_scatter(
        x=np.concatenate([x, x[::-1]]),
        y=np.concatenate([there, back[::-1]]),
        mode="lines",
        fill="toself",
        fillcolor=colour,
        line={"width": 0} if outline is None else {"width": 3, "color": outline},
        name=name,
        hoverinfo="skip",
    )


def add_line(figure: Figure, curve: StiffnessCurve, name: str, colour: str, width: float, dash: str = "solid") -> None:
    """The curve, [mm] and [N]."""
    figure.add_scatter(
        x=curve.deflection * 1e3,
        y=curve.load,
        name=named(name, curve),
        mode="lines",
        line={"color": colour, "width": width, "dash": dash},
        hovertemplate="%{y:.1f} N",
    )


def add_orientations(figure: Figure, curves: Mapping[float, StiffnessCurve], model: str, first_colour: int = 0) -> None:
    """A line for each orientation; of more than can be told apart only their range is named."""
    if len(curves) > _MANY:
        _add_cloud(figure, curves, model)
        return
    for i, (orientation, curve) in enumerate(curves.items(), start=first_colour):
        figure.add_scatter(
            x=curve.deflection * 1e3,
            y=curve.load,
            name=named(f"{model} {orientation:g}°", curve),
            mode="lines+markers",
            line={"color": ORIENTATION_COLOURS[i % 6], "width": 1.6, "dash": DASHES[i % 6]},
            marker={"symbol": MARKERS[i % 6], "size": 5, "maxdisplayed": 12},
            hovertemplate="%{y:.1f} N",
        )


def _add_cloud(figure: Figure, curves: Mapping[float, StiffnessCurve], model: str) -> None:
    first, *_, last = curves
    for orientation, curve in curves.items():
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
