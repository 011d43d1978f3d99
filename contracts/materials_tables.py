"""Tables of a property against temperature: every row with its source, monotone interpolation, no extrapolation."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["KELVIN_AT_ZERO_CELSIUS", "PropertyRow", "PropertyTable"]

KELVIN_AT_ZERO_CELSIUS = 273.15


@dataclass(frozen=True, slots=True, kw_only=True)
class PropertyRow:
    """One row: temperature [K], value in the table's unit, and where the value comes from."""

    temperature: float
    value: float
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class PropertyTable:
    """A property against temperature.

    Between rows: piecewise cubic Hermite interpolation with the slopes of Fritsch & Butland (SIAM J. Sci. Stat. Comput.
    5, 1984), which is monotone where the rows are, and once continuously differentiable. Outside: refused.

    Attributes
    ----------
    what : name of the property, as in messages
    rows : two or more, in increasing temperature

    Raises
    ------
    InputError
        For rows out of order, values that are not finite, or a row without a source.

    Verified by tests/unit/test_materials_tables.py.
    """

    what: str
    rows: tuple[PropertyRow, ...]

    def __post_init__(self) -> None:
        temperatures = [row.temperature for row in self.rows]
        if len(self.rows) < 2 or any(b <= a for a, b in itertools.pairwise(temperatures)):
            raise InputError(self.what, temperatures, "needs two or more rows in increasing temperature", "sort them")
        for row in self.rows:
            if not (math.isfinite(row.value) and math.isfinite(row.temperature) and row.source):
                where = f"{row.value:g} at {row.temperature:g} K"
                raise InputError(self.what, where, "needs finite numbers and a source", "complete the row")

    def at(self, temperature: float) -> float:
        """Value at a temperature [K]; InputError outside the rows."""
        T = np.array([row.temperature for row in self.rows])
        y = np.array([row.value for row in self.rows])
        if not T[0] <= temperature <= T[-1]:
            zero = KELVIN_AT_ZERO_CELSIUS
            raise InputError(
                f"temperature for the {self.what}",
                f"{temperature - zero:g} C",
                f"must lie within the data, {T[0] - zero:.4g} to {T[-1] - zero:.4g} C",
                "choose a temperature inside",
            )
        k = min(int(np.searchsorted(T, temperature, side="right")) - 1, len(T) - 2)
        h, slopes = T[k + 1] - T[k], _slopes(T, y)
        s = (temperature - T[k]) / h
        rise = s * s * (3.0 - 2.0 * s)
        left, right = s * (1.0 - s) ** 2, s * s * (s - 1.0)
        return float(y[k] + (y[k + 1] - y[k]) * rise + h * (left * slopes[k] + right * slopes[k + 1]))


def _slopes(T: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope at each row: weighted harmonic mean of the two chords, zero at an extremum, one-sided at the ends."""
    h = np.diff(T)
    chord = np.diff(y) / h
    if len(chord) == 1:
        return np.repeat(chord, 2)
    slopes = np.zeros_like(y)
    for k in range(1, len(y) - 1):
        before, after = chord[k - 1], chord[k]
        if before * after > 0.0:
            w = 2.0 * h[k] + h[k - 1], h[k] + 2.0 * h[k - 1]
            slopes[k] = (w[0] + w[1]) / (w[0] / before + w[1] / after)
    slopes[0] = _end_slope(h[0], h[1], chord[0], chord[1])
    slopes[-1] = _end_slope(h[-1], h[-2], chord[-1], chord[-2])
    return slopes


def _end_slope(h0: float, h1: float, chord0: float, chord1: float) -> float:
    """Three-point slope at an end, limited so that the interpolant stays monotone."""
    slope = ((2.0 * h0 + h1) * chord0 - h0 * chord1) / (h0 + h1)
    if slope * chord0 <= 0.0:
        return 0.0
    if chord0 * chord1 <= 0.0 and abs(slope) > 3.0 * abs(chord0):
        return 3.0 * chord0
    return slope
