"""Claim: the fit finds the parameters that made the curves, and says so where no parameters can.

Source: synthetic curves of a tire of known parameters; no model error, so that only the search and its statistics are
tested. Tolerances: 1e-4 of each parameter without noise (the search ends at 1e-6 of the sum of squares); with 1 % of
independent noise each parameter within its 99.9 % interval (about 1.7 times the 95 % one), which a right interval
misses once in 300 for three parameters; the noise is fixed. Negative controls: curves of six spokes leave four spokes a
residual of more than 5 % on some orientation, and a bound that shuts the true value out is found to hold.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.fit.curve_fit import CurveFit, LoadData, fit_curves
from ancf_reduced.fit.parameters import FreeParameter, Parameter
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import TirePreset, thesis_preset
from ancf_reduced.tire.static import solve_tire

START = replace(thesis_preset(), quadrature=(3, 3, 2))
TRUTH = replace(START, young_modulus=340e3, hub_radius=0.044, contact_stiffness=1700.0)
FREE = (
    FreeParameter(parameter=Parameter.YOUNG_MODULUS, lower=50e3, upper=5e6),
    FreeParameter(parameter=Parameter.HUB_RADIUS, lower=0.02, upper=0.08),
    FreeParameter(parameter=Parameter.CONTACT_STIFFNESS, lower=100.0, upper=1e5),
)
PHI, DEFLECTION = np.radians([0.0, 20.0, 45.0]), np.array([0.005, 0.012, 0.020, 0.028])
VALUES = np.array([p.parameter.of(TRUTH) for p in FREE])


def curves_of(preset: TirePreset) -> np.ndarray:
    return np.array([solve_tire(build_tire(preset), phi, DEFLECTION).load for phi in PHI.tolist()])


def fitted(loads: np.ndarray, start: TirePreset = START, free: tuple[FreeParameter, ...] = FREE) -> CurveFit:
    scale = np.broadcast_to(np.maximum(loads.mean(axis=0), 1.0), loads.shape)
    return fit_curves(start, free, LoadData(phi=PHI, deflection=DEFLECTION, load=loads, scale=scale))


@pytest.fixture(scope="module")
def true_loads() -> np.ndarray:
    return curves_of(TRUTH)


def test_known_parameters_are_recovered(true_loads: np.ndarray) -> None:
    found = fitted(true_loads)
    np.testing.assert_allclose(found.values, VALUES, rtol=1e-4)
    assert found.settled
    assert found.relative_error.max() < 1e-5
    assert found.statistics.inside.all()


def test_with_noise_they_lie_within_their_intervals(true_loads: np.ndarray) -> None:
    noise = 0.01 * true_loads.mean(axis=0) * np.random.default_rng(7).standard_normal(true_loads.shape)
    found = fitted(true_loads + noise)
    error = np.log(found.values / VALUES)
    assert np.all(np.abs(error) < 1.7 * found.statistics.half_width)
    assert np.all(np.abs(error) > 1e-5)  # the noise did move them
    assert found.statistics.residual_scale == pytest.approx(0.01, rel=0.6)


def test_four_spokes_cannot_follow_six(true_loads: np.ndarray) -> None:
    """Negative control: only the spokes differ, and at least one orientation keeps more than 5 %."""
    six = curves_of(replace(TRUTH, spokes=6, circumferential_plates=6))
    assert fitted(six).relative_error.max() > 0.05
    assert fitted(true_loads).relative_error.max() < 1e-5


def test_a_bound_that_shuts_the_truth_out_is_found(true_loads: np.ndarray) -> None:
    """Negative control: the modulus may not exceed 300 kPa, the true one is 340."""
    low = replace(FREE[0], upper=300e3)
    found = fitted(true_loads, free=(low, *FREE[1:]))
    assert found.statistics.inside.tolist() == [False, True, True]
    assert found.values[0] == pytest.approx(300e3, rel=5e-3)
    assert np.isnan(found.statistics.half_width[0])
    assert found.relative_error.max() > 1e-3


def test_phase_is_recovered(true_loads: np.ndarray) -> None:
    phase = FreeParameter(parameter=Parameter.PHASE, lower=-0.5, upper=0.5)
    found = fitted(curves_of(replace(TRUTH, phase=0.2)), TRUTH, (phase,))
    assert found.values[0] == pytest.approx(0.2, abs=1e-5)
