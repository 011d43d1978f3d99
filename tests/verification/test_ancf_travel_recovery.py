"""Claim: stiffnesses against the hub's travel bring back parameters that load-deflection curves hardly determine.

Source: a thin tire's own curves and stiffnesses; no model error. Five parameters are free. By the curves alone the
radius of the hub is known least: the hub's and the outer radius' intervals, for the same scatter, shrink three times
and more with lateral and turning stiffness at weight 1, and the condition number falls. Modulus and thickness stay
correlated: both kinds of data see products of the two. Tolerance of the recovery: 1e-4 of each parameter, as in
test_ancf_curve_fit.py. With 1 % of independent noise on all data, each parameter lies within its 99.9 % interval (about
1.7 times the 95 % one). Negative control: stiffnesses twice the tire's own are not met, and the fit says so.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.fit.curve_fit import CurveFit, LoadData, fit_curves
from ancf_reduced.fit.parameters import FreeParameter, Parameter
from ancf_reduced.fit.travel_fit import TravelData, travel_stiffness
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_tire
from contracts.hub_travel import Way

THIN = {"young_modulus": 1.5e6, "rim_thickness": 0.006, "spoke_thickness": 0.006, "hub_radius": 0.03}
START = replace(thesis_preset(), quadrature=(3, 3, 2), datum_radius=0.1425, **THIN)
TRUTH = replace(START, young_modulus=1.8e6, rim_thickness=0.0055, spoke_thickness=0.0055, hub_radius=0.034)
BOUNDS = {
    Parameter.YOUNG_MODULUS: (50e3, 50e6),
    Parameter.THICKNESS: (0.001, 0.04),
    Parameter.CONTACT_STIFFNESS: (100.0, 1e5),
    Parameter.HUB_RADIUS: (0.02, 0.08),
    Parameter.OUTER_RADIUS: (0.140, 0.1455),
}
FREE = tuple(FreeParameter(parameter=p, lower=low, upper=high) for p, (low, high) in BOUNDS.items())
VALUES = np.array([p.parameter.of(TRUTH) for p in FREE])
PHI, DEFLECTION = np.radians([0.0, 20.0, 45.0]), np.array([0.005, 0.012, 0.018, 0.024])
HUB, OUTER = 3, 4


@pytest.fixture(scope="module")
def data() -> LoadData:
    tire = build_tire(TRUTH)
    states = [solve_tire(tire, phi, DEFLECTION) for phi in PHI.tolist()]
    loads = np.array([s.load for s in states])
    ways = TravelData(ways=(Way.LATERAL, Way.TURNING), load=100.0, stiffness=np.ones((len(PHI), 2)))
    travel = replace(ways, stiffness=travel_stiffness(tire, states, ways))
    scale = np.broadcast_to(loads.mean(axis=0), loads.shape)
    return LoadData(phi=PHI, deflection=DEFLECTION, load=loads, scale=scale, travel=travel)


@pytest.fixture(scope="module")
def found(data: LoadData) -> CurveFit:
    return fit_curves(START, FREE, data)


def test_known_parameters_are_recovered(found: CurveFit, data: LoadData) -> None:
    np.testing.assert_allclose(found.values, VALUES, rtol=1e-4)
    assert found.settled
    assert data.travel is not None
    np.testing.assert_allclose(found.travel, data.travel.stiffness, rtol=1e-4)
    assert found.statistics.degrees_of_freedom == 3 * 4 + 3 * 2 - 5


def test_radii_are_known_better_and_modulus_and_thickness_are_not_told_apart(found: CurveFit, data: LoadData) -> None:
    alone = fit_curves(START, FREE, replace(data, travel=None))
    widths = [f.statistics.standard_error / f.statistics.residual_scale for f in (alone, found)]
    gain = widths[0] / widths[1]
    assert int(np.argmax(widths[0])) == HUB
    assert min(gain[HUB], gain[OUTER]) > 3.0
    assert np.all(gain > 1.0)  # data more never widen an interval of the same scatter
    assert found.statistics.condition < alone.statistics.condition
    assert all(abs(f.statistics.correlation[0, 1]) > 0.95 for f in (alone, found))


def test_with_noise_they_lie_within_their_intervals(data: LoadData) -> None:
    random = np.random.default_rng(11)
    noisy = data.load + 0.01 * data.scale * random.standard_normal(data.load.shape)
    assert data.travel is not None
    stiffness = data.travel.stiffness * (1.0 + 0.01 * random.standard_normal(data.travel.stiffness.shape))
    fit = fit_curves(START, FREE, replace(data, load=noisy, travel=replace(data.travel, stiffness=stiffness)))
    error = np.abs(np.log(fit.values / VALUES))
    assert np.all(error < 1.7 * fit.statistics.half_width)
    assert np.all(error > 1e-5)  # the noise did move them


def test_stiffnesses_that_are_not_the_tire_s_are_not_met(data: LoadData) -> None:
    """Negative control."""
    assert data.travel is not None
    twice = replace(data.travel, stiffness=2.0 * data.travel.stiffness)
    fit = fit_curves(START, FREE, replace(data, travel=twice))
    assert np.abs(fit.travel / twice.stiffness - 1.0).max() > 0.1
