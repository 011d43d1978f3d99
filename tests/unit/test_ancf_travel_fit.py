"""Gradient of the travel stiffness by the tire's parameters, against central differences of whole solves; bad data."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.fit import travel_fit
from ancf_reduced.fit.load_sensitivity import vary_tire
from ancf_reduced.fit.parameters import FreeParameter, Parameter, preset_at, unknowns_of
from ancf_reduced.fit.travel_fit import TravelData, travel_gradient, travel_stiffness
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_near, solve_tire
from contracts.errors import InputError
from contracts.hub_travel import Way

PRESET = replace(thesis_preset(), phase=0.1, datum_radius=0.1425, outer_radius=0.143, quadrature=(3, 3, 2))
DEFLECTION, PHI, STEP = np.array([0.0053, 0.0203]), 0.3, 1e-5
WAYS = (Way.FORE_AFT, Way.LATERAL, Way.TURNING)
DATA = TravelData(ways=WAYS, load=120.0, stiffness=np.full((1, 3), 1e3))


@pytest.mark.parametrize("parameter", list(Parameter))
def test_gradient_is_that_of_whole_solves(parameter: Parameter) -> None:
    """1e-5 of each way's own; under the load, so that the deflection changes with the parameter."""
    free = [FreeParameter(parameter=parameter, lower=1e-4, upper=1e9)]
    tire = build_tire(PRESET)
    states = [solve_tire(tire, PHI, DEFLECTION)]
    gradient = travel_gradient(vary_tire(tire, free), states, DATA)[0, :, 0]
    at, whole = unknowns_of(PRESET, free), []
    for step in (-STEP, STEP):
        other = build_tire(preset_at(PRESET, free, at + step))
        whole.append(travel_stiffness(other, [solve_near(other, states[0])], DATA)[0])
    difference = (whole[1] - whole[0]) / (2.0 * STEP)
    np.testing.assert_allclose(gradient, difference, rtol=1e-5, atol=1e-6 * np.abs(whole[0]).max())
    assert np.all(np.abs(gradient) > 0.01 * whole[0])  # every parameter changes every way


def test_the_equilibrium_s_part_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: with coordinates and deflection held the gradient is another, by 5 % and more."""
    free = [FreeParameter(parameter=Parameter.THICKNESS, lower=1e-4, upper=1e9)]
    tire = build_tire(PRESET)
    states, varied = [solve_tire(tire, PHI, DEFLECTION)], vary_tire(tire, free)
    right = travel_gradient(varied, states, DATA)
    monkeypatch.setattr(travel_fit, "_along", lambda varied, stand: np.zeros((1, len(stand.rows) + 1)))
    assert np.abs(travel_gradient(varied, states, DATA) / right - 1.0).min() > 0.05


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"ways": ()}, "one or more"),
        ({"ways": (Way.LATERAL, Way.LATERAL)}, "none twice"),
        ({"load": 0.0}, "load of the travels"),
        ({"weight": -1.0}, "weight of the travels"),
        ({"stiffness": np.array([[1.0, 2.0]])}, "3 an orientation"),
        ({"stiffness": np.array([[1.0, 2.0, 0.0]])}, "must be finite, > 0"),
    ],
)
def test_bad_data_are_refused(change: dict[str, object], text: str) -> None:
    with pytest.raises(InputError, match=text):
        replace(DATA, **change)


def test_a_load_beyond_the_curve_is_refused() -> None:
    tire = build_tire(PRESET)
    states = [solve_tire(tire, PHI, DEFLECTION)]
    with pytest.raises(InputError, match="near the loads solved"):
        travel_stiffness(tire, states, replace(DATA, load=5e3))
