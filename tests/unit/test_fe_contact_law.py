"""The ramped penalty law with a multiplier, and the return mapping of Coulomb friction."""

from __future__ import annotations

import numpy as np
import pytest

from reference_fe.contact.law import friction_traction, ramped_pressure

PENALTY, RAMP = 1e11, 5e-6


def law(gap: float, multiplier: float = 0.0) -> tuple[float, float]:
    return ramped_pressure(gap, PENALTY, RAMP, multiplier)


def test_open_and_closed_branches() -> None:
    assert law(2 * RAMP) == (0.0, 0.0)
    assert law(-1e-4) == (pytest.approx(PENALTY * 1e-4), PENALTY)
    assert law(0.0, 3e6) == (pytest.approx(3e6), PENALTY)


@pytest.mark.parametrize("multiplier", [0.0, 2e5, 5e6])
@pytest.mark.parametrize("gap", [-1e-4, -RAMP, -0.3 * RAMP, 0.0, 0.8 * RAMP, RAMP, 1e-4])
def test_stiffness_is_minus_the_slope_and_the_law_is_continuous(gap: float, multiplier: float) -> None:
    h = 1e-10
    slope = (law(gap + h, multiplier)[0] - law(gap - h, multiplier)[0]) / (2 * h)
    assert -slope == pytest.approx(law(gap, multiplier)[1], abs=2e-5 * PENALTY)


@pytest.mark.parametrize("multiplier", [0.0, 3e5])
def test_the_pressure_never_pulls(multiplier: float) -> None:
    assert min(law(gap, multiplier)[0] for gap in np.linspace(-1e-5, 1e-5, 41)) >= 0.0


@pytest.mark.parametrize("pressure", [1e3, 4e5, 2e7])
def test_uzawa_ends_between_touch_and_the_ramp(pressure: float) -> None:
    """Under a given pressure the update stops moving at a gap of (sqrt(d) - sqrt(p/k))^2, zero from p = k d on."""
    gap, multiplier = -1e-4, 0.0
    for _ in range(2000):
        for _ in range(60):  # equilibrium of the point under the given pressure
            present, stiffness = law(gap, multiplier)
            gap += (present - pressure) / max(stiffness, 1e-3 * PENALTY)
        multiplier = law(gap, multiplier)[0]
    expected = max(0.0, np.sqrt(RAMP) - np.sqrt(pressure / PENALTY)) ** 2
    assert gap == pytest.approx(expected, abs=1e-3 * RAMP)


def test_friction_sticks_inside_the_limit_and_slides_along_the_trial() -> None:
    traction, direction = np.zeros(3), np.zeros(3)
    trial = np.array([3.0, 0.0, -4.0])
    assert friction_traction(trial, 5.5, traction, direction) == 1.0
    np.testing.assert_array_equal(traction, trial)
    np.testing.assert_array_equal(direction, 0.0)
    assert friction_traction(trial, 2.0, traction, direction) == pytest.approx(0.4)
    np.testing.assert_allclose(traction, 0.4 * trial)
    np.testing.assert_allclose(direction, trial / 5.0)
