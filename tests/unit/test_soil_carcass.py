"""The rim's compliance by harmonics.

Claims: shapes of known harmonics give them back, whatever way the points are spaced; a point force moves the rim by its
compliance; the mean of two sides takes what is odd away; a gap between points is refused. Source: the definition.
"""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from soil.carcass import HARMONICS, Carcass, carcass_from_shapes, shape_under


def test_known_harmonics_come_back() -> None:
    angle = np.sort(np.random.default_rng(3).uniform(-np.pi, np.pi, 4000))
    even = 1e-3 * (5.0 + 70.0 * np.cos(angle) + 40.0 * np.cos(2.0 * angle))
    found = carcass_from_shapes([(angle, even + 0.01 * np.sin(angle))], 200.0, "made up")
    assert found.compliance[:3] == pytest.approx((2.5e-5, 3.5e-4, 2e-4), rel=1e-3)
    assert np.abs(found.compliance[3:]).max() < 1e-6
    assert len(found.compliance) == HARMONICS + 1


def test_a_point_force_moves_the_rim_by_its_compliance() -> None:
    carcass = Carcass(compliance=(5e-6, 75e-6, 41e-6), load=200.0, source="made up")
    shape = shape_under(carcass, np.array([0.3]), np.array([200.0]))
    w, slope = shape.at(np.array([0.3, 0.3 + np.pi]))
    assert w[0] == pytest.approx(200.0 * carcass.deflection_per_load)
    assert w[1] == pytest.approx(200.0 * (5e-6 - 75e-6 + 41e-6))
    assert slope == pytest.approx([0.0, 0.0], abs=1e-15)


def test_at_another_load_it_is_as_soft_as_the_wheels_curve() -> None:
    carcass = Carcass(
        compliance=(5e-6, 75e-6), load=200.0, curve=((100.0, 7e-3), (200.0, 16e-3), (300.0, 30e-3)), source="made up"
    )
    assert carcass.at(100.0).deflection_per_load == pytest.approx(80e-6 * 70.0 / 80.0)
    assert carcass.at(250.0).deflection_per_load == pytest.approx(80e-6 * 90.0 / 80.0)
    assert carcass.at(1e3).deflection_per_load == carcass.at(300.0).deflection_per_load
    assert Carcass(compliance=(1e-6,), load=1.0, source="line").at(9.0).compliance == (1e-6,)


def test_the_slope_is_the_derivative() -> None:
    carcass = Carcass(compliance=(5e-6, 75e-6, 41e-6, 8e-6), load=200.0, source="made up")
    shape = shape_under(carcass, np.array([0.1, -0.4]), np.array([120.0, 80.0]))
    w, slope = shape.at(np.array([0.2 - 1e-6, 0.2, 0.2 + 1e-6]))
    assert slope[1] == pytest.approx((w[2] - w[0]) / 2e-6, rel=1e-7)


def test_a_gap_between_points_is_refused() -> None:
    angle = np.linspace(-2.0, 2.0, 500)
    with pytest.raises(InputError, match="gap between points"):
        carcass_from_shapes([(angle, np.cos(angle))], 200.0, "made up")
    with pytest.raises(InputError, match="load"):
        carcass_from_shapes([], 0.0, "made up")
