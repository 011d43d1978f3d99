"""Charts as pictures. The one module that imports matplotlib; needs no display.

Verified by tests/unit/test_workbench_compared_page.py.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib import get_data_path
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from workbench.figures.palette import INK

__all__ = ["blank_figure", "font_folder", "png_bytes", "red_green_blue", "stacked_axes"]


def stacked_axes(heights: Sequence[float], size: tuple[float, float]) -> tuple[Figure, list[Any]]:
    """Axes above each other with one abscissa; ``heights`` relative to each other, ``size`` in inches."""
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=list(heights))
    axes = [row[0] for row in grid]
    for one in axes:
        one.spines[["top", "right"]].set_visible(False)
        one.grid(color="#e8eaed")
        one.set_axisbelow(True)
        one.tick_params(colors=INK)
    return figure, axes


def blank_figure(width: float, height: float) -> Any:
    """A page [inches] without axes."""
    return Figure(figsize=(width, height))


def red_green_blue(name: str) -> tuple[float, float, float, float]:
    """A colour's name or hexadecimal number as red, green, blue, opacity."""
    return to_rgba(name)


def font_folder() -> Path:
    """Where matplotlib's DejaVu fonts lie."""
    return Path(get_data_path()) / "fonts" / "ttf"


def png_bytes(figure: Figure, dpi: int = 144) -> bytes:
    """The figure as the content of a PNG file."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=dpi)
    return stream.getvalue()
