"""How strips are held across the plane: limits, bending modulus, and the strip between beam and plate."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from reference_fe.material.plane_state import PLANE_STRAIN, PLANE_STRESS, planar_lambda, strip_constraint

NU = 0.342


def modulus_by_ritz(width: float, radius: float, thickness: float) -> float:
    """Moment per curvature over D b of a curved strip, by minimising its energy over even polynomials w(y).

    U = int D/2 (1 + 2 nu w'' + w''^2) + E t w^2 / (2 R^2) dy for unit curvature, D = E t^3 / (12 (1 - nu^2)).
    """
    y, weight = np.polynomial.legendre.leggauss(80)
    y, weight = 0.5 * width * y, 0.5 * width * weight
    powers = np.arange(0, 24, 2)
    scale = 0.5 * width
    w = (y[:, None] / scale) ** powers
    bend = powers * (powers - 1) * (y[:, None] / scale) ** np.maximum(powers - 2, 0) / scale**2
    spring = 12.0 * (1.0 - NU**2) / (radius * thickness) ** 2
    stiffness = (bend * weight[:, None]).T @ bend + spring * (w * weight[:, None]).T @ w
    load = -NU * weight @ bend
    amplitude = np.linalg.lstsq(stiffness, load, rcond=None)[0]
    return 1.0 + NU * float(weight @ bend @ amplitude) / width


@pytest.mark.parametrize("width", [2e-3, 8e-3, 20e-3, 40e-3])
def test_strip_against_its_energy_minimum(width: float) -> None:
    """D b (1 - nu^2 f) is the Ritz minimum of the strip's energy; 1e-6 is what 12 polynomials leave."""
    constraint = strip_constraint(width, 45e-3, 0.6e-3, NU)
    assert modulus_by_ritz(width, 45e-3, 0.6e-3) == pytest.approx(1.0 - NU**2 * (1.0 - constraint), rel=1e-6)


def test_narrow_strips_are_beams_and_wide_ones_plates() -> None:
    widths = np.geomspace(1e-4, 1e2, 60)
    values = [strip_constraint(float(b), 45e-3, 0.6e-3, NU) for b in widths]
    assert values[0] == pytest.approx(0.0, abs=1e-6)
    assert values[-1] == pytest.approx(1.0, abs=1e-3)
    assert all(-1e-9 <= v <= 1.0 for v in values)
    assert np.all(np.diff(values[5:30]) > 0.0)


def test_bending_modulus_of_the_planar_lambda() -> None:
    E, nu, mu = TI_6AL_4V.young_modulus, TI_6AL_4V.poisson_ratio, TI_6AL_4V.lame_mu
    for constraint, wanted in ((PLANE_STRESS, E), (PLANE_STRAIN, E / (1.0 - nu**2)), (0.5, None)):
        lam = planar_lambda(TI_6AL_4V, constraint)
        modulus = 4.0 * mu * (lam + mu) / (lam + 2.0 * mu)
        assert modulus == pytest.approx(wanted or E * (1.0 - 0.5 * nu**2) / (1.0 - nu**2), rel=1e-12)
    lam = TI_6AL_4V.lame_lambda
    assert planar_lambda(TI_6AL_4V, PLANE_STRAIN) == pytest.approx(lam, rel=1e-12)
    assert planar_lambda(TI_6AL_4V, PLANE_STRESS) == pytest.approx(2.0 * lam * mu / (lam + 2.0 * mu), rel=1e-12)


@pytest.mark.parametrize("width", [0.0, -1.0, math.nan, math.inf])
def test_bad_strips_are_refused(width: float) -> None:
    with pytest.raises(InputError, match="strip width"):
        strip_constraint(width, 45e-3, 0.6e-3, NU)
    with pytest.raises(InputError, match="transverse constraint"):
        planar_lambda(TI_6AL_4V, -0.1)
