"""Charts as pictures. The one module that imports matplotlib, and only where something is drawn; needs no display.

Verified by tests/unit/test_workbench_compared_page.py and tests/end_to_end/test_rover_soil.py.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.text import for_matplotlib
from workbench.charts.palette import INK, MODEL_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "Axes",
    "blank_figure",
    "curve_axes",
    "font_folder",
    "ground_png",
    "png_bytes",
    "red_green_blue",
    "stacked_axes",
]


def stacked_axes(heights: Sequence[float], size: tuple[float, float]) -> tuple[Figure, list[Any]]:
    """Axes above each other with one abscissa; ``heights`` relative to each other, ``size`` in inches."""
    figure = blank_figure(*size, layout="constrained")
    grid = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=list(heights))
    axes = [row[0] for row in grid]
    for one in axes:
        one.spines[["top", "right"]].set_visible(False)
        one.grid(color="#e8eaed")
        one.set_axisbelow(True)
        one.tick_params(colors=INK)
    return figure, axes


def curve_axes(curve: StiffnessCurve, ax: Axes | None = None) -> Axes:
    """Load [N] against deflection [mm], into new axes of pyplot if none are given."""
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.subplots(layout="constrained")[1]
    where = " average" if curve.orientation_deg is None else f" {curve.orientation_deg:g}°"
    where = "" if curve.model == "brush" else where  # the same at every orientation
    label = for_matplotlib(f"{curve.model}{where}" + " (partial)" * curve.partial)
    colour = MODEL_COLOURS.get(curve.model)
    taken = any(line.get_color() == colour for line in ax.lines)
    ax.plot(1e3 * curve.deflection, curve.load, label=label, color=None if taken else colour)
    ax.set_xlabel("radial deflection [mm]")
    ax.set_ylabel("wheel load [N]")
    ax.legend()
    return ax


def blank_figure(width: float, height: float, layout: Literal["constrained"] | None = None) -> Any:
    """A page [inches] without axes."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout=layout)


def red_green_blue(name: str) -> tuple[float, float, float, float]:
    """A colour's name or hexadecimal number as red, green, blue, opacity."""
    from matplotlib.colors import to_rgba

    return to_rgba(name)


def font_folder() -> Path:
    """Where matplotlib's DejaVu fonts lie."""
    from matplotlib import get_data_path

    return Path(get_data_path()) / "fonts" / "ttf"


def ground_png(x: NDArray[np.float64], y: NDArray[np.float64], depth: NDArray[np.float64], title: str) -> bytes:
    """PNG of ruts from above, x ahead: depths (n, m) [m] at x (n,) and y (m,) [m]."""
    length, width = (max(float(np.ptp(one)), 0.1) for one in (x, y))
    figure = blank_figure(9.0, min(max(9.0 * width / length, 2.0), 9.0) + 0.8, layout="constrained")
    axes = figure.subplots()
    image = axes.pcolormesh(x, y, 1e3 * depth.T, cmap="cividis_r", shading="nearest")
    axes.set_aspect("equal")
    axes.set_xlabel("x, ahead [m]")
    axes.set_ylabel("y, left [m]")
    axes.set_title(for_matplotlib(title), fontsize=10, color=INK, loc="left")
    figure.colorbar(image, ax=axes, label="depth of the ground [mm]", shrink=0.8)
    return png_bytes(figure)


def png_bytes(figure: Figure) -> bytes:
    """The figure as the content of a PNG file."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=144)
    return stream.getvalue()
