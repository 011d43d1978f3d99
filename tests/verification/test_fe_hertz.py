"""Claim: line contact of an elastic body with a rigid cylinder follows Hertz: half width and peak pressure to 3 %.

Source: contracts/published/hertz_line.csv (Johnson, Contact Mechanics, 1985, eqs. 4.43 and 4.45). Hertz' theory is
linear; at this load a / R = 12 %, so that large strain accounts for most of the tolerance (neo-Hookean material, half
width on the deformed surface; measured: 0.1 % and 2.1 %). The model is reference_fe/verification/hertz_line.py.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from reference_fe.verification.hertz_line import E_STAR, HALF_WIDTH, LOAD, PEAK_PRESSURE, RADIUS, line_contact

run = functools.cache(line_contact)


def test_the_table_is_hertz_formula() -> None:
    assert pytest.approx(np.sqrt(4.0 * LOAD * RADIUS / (np.pi * E_STAR)), rel=1e-8) == HALF_WIDTH
    assert pytest.approx(2.0 * LOAD / (np.pi * HALF_WIDTH), rel=1e-8) == PEAK_PRESSURE


@pytest.mark.parametrize(
    ("radius", "curvature"), [(RADIUS, 0.0), (2.0 * RADIUS, 0.5 / RADIUS)], ids=["flat", "two radii"]
)
def test_half_width_and_peak_pressure(radius: float, curvature: float) -> None:
    found = run(radius, curvature)
    assert found.half_width == pytest.approx(HALF_WIDTH, rel=0.03)
    assert found.peak_pressure == pytest.approx(PEAK_PRESSURE, rel=0.03)
    assert found.penetration < 1e-6


def test_a_wrong_radius_is_caught() -> None:
    """Negative control: a cylinder of 1.2 R makes the contact 10 % wider."""
    found = run(1.2 * RADIUS)
    assert abs(found.half_width / HALF_WIDTH - 1.0) > 0.05
    assert abs(found.peak_pressure / PEAK_PRESSURE - 1.0) > 0.05
