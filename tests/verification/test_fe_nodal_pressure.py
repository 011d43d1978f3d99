"""Claim: contact pressure recovered at nodes converges to Hertz' semi-ellipse as the mesh is refined.

Source: contracts/published/hertz_line.csv. A cylinder of four times the table's radius under a quarter of its load, so
that large strain is worth 0.3 % of the peak and the penalty, 1e16 N/m^3, 0.01 % of the penetration of Hertz' cylinder.
Difference: integral over |p - p_Hertz| over the load, 3.6, 1.8 and 1.1 % on cells halved twice: order 1.0 at first, as
the end's kink lies within a cell, and then the 0.9 % by which even the pressures at the quadrature points differ from
the linear theory begin to count. Negative control: another half width is told apart at once.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from reference_fe.verification.hertz_line import GENTLE, HALF_WIDTH, PEAK_PRESSURE, pressure_on_the_line


@functools.cache
def line(cells: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Places and pressures of the stations of nodes, from the middle outwards."""
    place, pressure = pressure_on_the_line(cells, stiffness=1e16)
    stations, which = np.unique(place.round(9), return_inverse=True)
    return stations, np.bincount(which, pressure) / np.bincount(which)


def difference(cells: tuple[int, int], half_width: float = HALF_WIDTH) -> float:
    """Between the recovered pressure and a semi-ellipse of Hertz' load, over the load [-]."""
    place, pressure = line(cells)
    x = np.linspace(0.0, 1.6 * HALF_WIDTH, 2001)
    peak = PEAK_PRESSURE / GENTLE * HALF_WIDTH / half_width
    ellipse = peak * np.sqrt(np.clip(1.0 - (x / half_width) ** 2, 0.0, None))
    return float(np.trapezoid(np.abs(np.interp(x, place, pressure) - ellipse), x) / np.trapezoid(ellipse, x))


def test_it_converges_to_hertz() -> None:
    coarse, fine = difference((12, 8)), difference((24, 14))
    assert coarse < 0.04
    assert np.log2(coarse / fine) == pytest.approx(1.0, abs=0.2)


def test_it_is_nowhere_negative_and_has_hertz_peak() -> None:
    _, pressure = line((24, 14))
    assert pressure.min() == 0.0
    assert GENTLE * pressure.max() == pytest.approx(PEAK_PRESSURE, rel=0.02)


def test_negative_control_another_half_width_is_told_apart() -> None:
    assert difference((24, 14), 1.1 * HALF_WIDTH) > 3.0 * difference((24, 14))
