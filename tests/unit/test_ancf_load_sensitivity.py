"""Gradient of the load with respect to the tire's parameters, against central differences of whole solves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.fit.load_sensitivity import load_gradient, vary_tire
from ancf_reduced.fit.parameters import FreeParameter, Parameter, preset_at, unknowns_of
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_near, solve_tire

PRESET = replace(thesis_preset(), phase=0.1, datum_radius=0.1425, outer_radius=0.143, quadrature=(3, 3, 2))
DEFLECTION = np.array([0.0053, 0.0203])
PHI, STEP = 0.3, 1e-5


@pytest.mark.parametrize("parameter", list(Parameter))
def test_gradient_is_that_of_whole_solves(parameter: Parameter) -> None:
    """1e-5 of the largest entry; the two agree to about 1e-8, which is the differences' own round-off."""
    free = [FreeParameter(parameter=parameter, lower=1e-4, upper=1e9)]
    tire = build_tire(PRESET)
    states = solve_tire(tire, PHI, DEFLECTION)
    gradient = load_gradient(vary_tire(tire, free), states)[:, 0]
    at = unknowns_of(PRESET, free)
    lower, upper = (solve_near(build_tire(preset_at(PRESET, free, at + s)), states).load for s in (-STEP, STEP))
    np.testing.assert_allclose(gradient, (upper - lower) / (2.0 * STEP), rtol=0, atol=1e-5 * np.abs(gradient).max())
    assert np.abs(gradient).min() > 0.1


def test_the_load_is_proportional_to_both_stiffnesses_together() -> None:
    both = Parameter.YOUNG_MODULUS, Parameter.CONTACT_STIFFNESS
    free = [FreeParameter(parameter=parameter, lower=1.0, upper=1e9) for parameter in both]
    states = solve_tire(build_tire(PRESET), PHI, DEFLECTION)
    gradient = load_gradient(vary_tire(build_tire(PRESET), free), states)
    np.testing.assert_allclose(gradient.sum(axis=1), states.load, rtol=1e-9)


def test_nothing_touches_nothing_changes() -> None:
    high = replace(PRESET, datum_radius=0.15)
    free = [FreeParameter(parameter=p, lower=1e-4, upper=1e9) for p in (Parameter.YOUNG_MODULUS, Parameter.THICKNESS)]
    tire = build_tire(high)
    assert np.array_equal(load_gradient(vary_tire(tire, free), solve_tire(tire, PHI, [0.001])), [[0.0, 0.0]])
