"""The ramped penalty law, evaluated as plain numbers through UFL."""

from __future__ import annotations

import numpy as np
import pytest

from reference_fe.contact_law import plane_pressure
from reference_fe.dolfinx_api import ufl

PENALTY, RAMP = 1e11, 5e-6


def law(gap: float, lag: float = 0.0) -> tuple[float, float]:
    pressure, stiffness = plane_pressure(ufl.as_ufl(gap), ufl.as_ufl(lag), ufl.as_ufl(PENALTY), RAMP)
    return float(pressure(())), float(stiffness(()))


def test_open_and_closed_branches() -> None:
    assert law(2 * RAMP) == (0.0, 0.0)
    assert law(-1e-4) == (pytest.approx(PENALTY * 1e-4), PENALTY)


@pytest.mark.parametrize("gap", [-1e-4, -RAMP, -0.3 * RAMP, 0.0, 0.8 * RAMP, RAMP, 1e-4])
def test_stiffness_is_minus_the_slope_and_the_law_is_continuous(gap: float) -> None:
    h = 1e-10
    slope = (law(gap + h)[0] - law(gap - h)[0]) / (2 * h)
    assert -slope == pytest.approx(law(gap)[1], abs=2e-5 * PENALTY)


@pytest.mark.parametrize("lag", [1e-3, -1e-3, 3e-6])
def test_a_lag_gives_the_tangent_line_at_the_lagged_gap(lag: float) -> None:
    gap = -2e-6
    pressure, stiffness = law(gap + lag)
    assert law(gap, lag) == (pytest.approx(pressure + stiffness * lag), stiffness)


def test_the_pressure_never_pulls() -> None:
    assert min(law(gap)[0] for gap in np.linspace(-1e-5, 1e-5, 41)) >= 0.0
