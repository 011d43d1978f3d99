"""What a fit refuses; bounds, mass and weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.fit.curve_fit import LoadData, fit_curves
from ancf_reduced.fit.parameters import FreeParameter, Parameter, with_mass
from ancf_reduced.plates.mass import flexible_mass
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError

DATA = LoadData(phi=np.zeros(1), deflection=np.array([0.01, 0.02]), load=np.ones((1, 2)), scale=np.ones((1, 2)))


def free(parameter: Parameter, lower: float = 1e-3, upper: float = 1e9) -> FreeParameter:
    return FreeParameter(parameter=parameter, lower=lower, upper=upper)


@pytest.mark.parametrize(("low", "high"), [(2.0, 1.0), (0.0, 1.0), (1.0, float("inf"))])
def test_bad_bounds_are_refused(low: float, high: float) -> None:
    with pytest.raises(InputError, match="bounds of young_modulus"):
        free(Parameter.YOUNG_MODULUS, low, high)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"load": np.ones((2, 2))}, "data of the fit"),
        ({"load": np.full((1, 2), np.nan)}, "must be finite"),
        ({"scale": np.zeros((1, 2))}, "weights of the fit"),
        ({"mean_weight": 0.5}, "weights of the fit"),
    ],
)
def test_bad_data_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        replace(DATA, **change)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ([], "free parameters"),
        ([free(Parameter.THICKNESS), free(Parameter.SPOKE_THICKNESS)], "none twice"),
        ([free(Parameter.YOUNG_MODULUS), free(Parameter.HUB_RADIUS)], "more than the parameters"),
        ([free(Parameter.YOUNG_MODULUS, 1e6, 1e7)], "start of young_modulus"),
    ],
)
def test_what_cannot_be_fitted_is_refused(parameters: list[FreeParameter], message: str) -> None:
    with pytest.raises(InputError, match=message):
        fit_curves(thesis_preset(), parameters, DATA)


def test_mass_is_held_through_the_density() -> None:
    assert flexible_mass(build_tire(with_mass(thesis_preset(), 4.0)).model) == pytest.approx(4.0, rel=1e-12)
    with pytest.raises(InputError, match="mass"):
        with_mass(thesis_preset(), 0.0)


def test_the_mean_weighs_more() -> None:
    """sum of squares = n w^2 m^2 + sum (r - m)^2."""
    data = LoadData(phi=np.zeros(3), deflection=np.array([0.01]), load=np.ones((3, 1)), scale=np.full((3, 1), 2.0))
    r = np.array([[1.0], [2.0], [6.0]])
    assert np.sum(data.weighted(r) ** 2) == pytest.approx(np.sum((r / 2.0) ** 2))
    heavy = replace(data, mean_weight=5.0).weighted(r)
    assert np.sum(heavy**2) == pytest.approx(3 * 25 * 1.5**2 + np.sum((r / 2.0 - 1.5) ** 2))
