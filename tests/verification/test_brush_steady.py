"""Claim: the steady slip laws of the brush tire are those of the literature.

Source: contracts/published/brush_tire.csv (isotropic brush with parabolic pressure, Pacejka's closed form, confirmed
there by quadrature of the bristle model) and fiala_tire.csv. Tolerance: half a unit of the last printed digit, 5e-10 N
and N m. Negative controls: friction that does not fall with slip, and a brush with uniform pressure, are newtons off.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from contracts.published import published_table
from rover_dynamics.tires.brush_slip import brush_slip, falling_friction, fiala_slip

PRINTED = 5.01e-10
LOAD = 198.0


def test_brush_is_the_published_table() -> None:
    table = published_table("brush_tire")
    stiffness = 2.0 * 8e6 * 0.03**2
    for sigma, force, moment in zip(table["sigma"], table["F_closed_N"], table["Mz_closed_Nm"], strict=True):
        forward = brush_slip((sigma, 0.0), LOAD, stiffness, 0.6, 0.03)
        sideways = brush_slip((0.0, -sigma), LOAD, stiffness, 0.6, 0.03)
        assert forward == (pytest.approx(force, abs=PRINTED), 0.0, 0.0)
        assert sideways == (0.0, pytest.approx(-force, abs=PRINTED), pytest.approx(moment, abs=PRINTED))


def test_brush_is_the_quadrature_of_its_bristles() -> None:
    table = published_table("brush_tire")
    found = [brush_slip((s, 0.0), LOAD, 14400.0, 0.6, 0.03)[0] for s in table["sigma"]]
    np.testing.assert_allclose(found, table["F_quadrature_N"], rtol=0, atol=4e-9)  # the quadrature's own error


def test_brush_is_the_same_in_every_direction() -> None:
    for angle in (0.3, 2.0, -1.2):
        x, y, _ = brush_slip((0.01 * math.cos(angle), 0.01 * math.sin(angle)), LOAD, 14400.0, 0.6, 0.03)
        assert math.hypot(x, y) == pytest.approx(93.654116927, abs=PRINTED)
        assert math.atan2(y, x) == pytest.approx(angle, abs=1e-14)


def _fiala_errors(fall: float) -> float:
    """Largest difference from the table with the friction falling by ``fall`` from 0.757."""
    table, worst = published_table("fiala_tire"), 0.0
    columns = (table[name] for name in ("kappa", "alpha_deg", "Fx", "Fy", "Mz"))
    for kappa, degrees, *expected in zip(*columns, strict=True):
        slip = (kappa, -math.tan(math.radians(degrees)))
        friction = falling_friction(math.hypot(*slip), 0.757 - fall, 0.757)
        found = fiala_slip(slip, LOAD, (8250.0, 850.0 * 180.0 / math.pi), friction, 0.1)
        worst = max(worst, float(np.abs(np.subtract(found, expected)).max()))
    return worst


def test_fiala_is_the_published_table() -> None:
    assert _fiala_errors(0.16) < PRINTED


def test_negative_control_friction_that_does_not_fall() -> None:
    assert _fiala_errors(0.0) > 1.0


def test_negative_control_brush_with_uniform_pressure() -> None:
    table, x = published_table("brush_tire"), published_table("brush_tire")["sigma"] * 14400.0 / (0.6 * LOAD)
    uniform = 0.6 * LOAD * np.where(x < 2.0, np.where(x < 0.5, x, 1.0 - 0.25 / np.maximum(x, 0.5)), 1.0)
    assert np.abs(uniform - table["F_closed_N"]).max() > 5.0
