"""Colours of a field on the wheel, and the bar that explains them.

Verified by tests/unit/test_viewer_colours.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from workbench.charts.palette import ABOVE_YIELD, SIGNED_ABOVE_YIELD, SIGNED_COLOURS, STRESS_COLOURS

__all__ = ["ColourBar", "colour_bar", "rgb"]

FloatArray = NDArray[np.float64]
_SHARE = 99.8
"""Percentile at which the colours end, so that a single corner does not take them all."""

_SIGNED = 0.01
"""Share of the end below which a negative value counts as round-off."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ColourBar:
    """Colours from ``begin``, zero or below, to ``end``; values beyond have the last one.

    Attributes
    ----------
    title, unit : of the quantity
    factor : from SI to the unit
    end : value at the end of the colours [SI]
    begin : value at their beginning [SI], ``-end`` where values have a sign
    stops : colours at equal steps
    """

    title: str
    unit: str
    factor: float
    end: float
    begin: float = 0.0
    stops: tuple[str, ...] = STRESS_COLOURS

    def colours(self, values: FloatArray) -> NDArray[np.uint8]:
        """Of values (...) [SI], shape (..., 3)."""
        stops = np.array([rgb(colour) for colour in self.stops], dtype=np.float64)
        share, places = (values - self.begin) / (self.end - self.begin), np.linspace(0.0, 1.0, len(stops))
        mixed = np.stack([np.interp(share, places, stops[:, i]) for i in range(3)], axis=-1)
        return mixed.round().astype(np.uint8)

    @property
    def warning(self) -> str:
        """A colour that is none of the bar's."""
        return SIGNED_ABOVE_YIELD if self.begin < 0.0 else ABOVE_YIELD

    def text(self, value: float) -> str:
        """A value [SI] with its unit."""
        return f"{self.factor * value:.{self._digits}f} {self.unit}"

    def shown(self, largest: float, smallest: float = 0.0) -> dict[str, object]:
        """What the page draws: title, gradient, ticks from top to bottom, the ends of the field's values [SI]."""
        ticks = np.linspace(self.factor * self.end, self.factor * self.begin, self._steps + 1)
        signed = f"from {self.text(smallest)} to {self.text(largest)}"
        return {
            "title": f"{self.title} [{self.unit}]",
            "gradient": f"linear-gradient(to top, {', '.join(self.stops)})",
            "ticks": [f"{tick:.{self._digits}f}" for tick in ticks],
            "above": signed if self.begin < 0.0 else f"largest {self.text(largest)}",
        }

    @property
    def _steps(self) -> int:
        """Of the bar, with a tick at zero."""
        return 4 if self.begin < 0.0 else 5

    @property
    def _digits(self) -> int:
        """So that the steps of the bar can be told apart."""
        step = self.factor * (self.end - self.begin) / self._steps
        return int(np.clip(1 - np.floor(np.log10(step)), 0, 4))


def rgb(colour: str) -> list[int]:
    """Of ``"#rrggbb"``, 0 to 255 each."""
    return [int(colour[i : i + 2], 16) for i in (1, 3, 5)]


def colour_bar(title: str, unit: str, factor: float, fields: Sequence[FloatArray]) -> ColourBar:
    """One bar for fields that are to be compared; ends at a round number at or above nearly all of their values.

    Where some are below zero by more than a hundredth of that, it begins as far below, and zero has no colour.
    """
    largest = factor * max(float(np.percentile(np.abs(one), _SHARE)) for one in fields)
    if largest <= 0.0:
        return ColourBar(title=title, unit=unit, factor=factor, end=1.0 / factor)
    step = 10.0 ** np.floor(np.log10(largest) - 0.5)
    end = float(np.ceil(largest / step) * step) / factor
    if min(float(one.min()) for one in fields) < -_SIGNED * end:
        return ColourBar(title=title, unit=unit, factor=factor, end=end, begin=-end, stops=SIGNED_COLOURS)
    return ColourBar(title=title, unit=unit, factor=factor, end=end)
