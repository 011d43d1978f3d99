"""A wheel on soil.

Claims: a rigid wheel's load, pull and torque are Wong and Reece's integrals to 1e-6, here once more by adaptive
quadrature of their formulas; a standing one carries the closed form; a flexible rim goes over into the rigid one as it
stiffens, with the order one of its compliance, and is the rim's own deflection on rigid soil. Sources: Wong and Reece
(1967) as docs/theory/soil.md has them. Negative controls: K ten times, no cohesion, no lugs each take pull away.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from contracts.errors import InputError
from soil.carcass import RIGID, Carcass
from soil.soil import Soil, soil_named
from soil.steady_wheel import WheelOnSoil, standing_wheel, steady_wheel, towed_wheel

EARTH = 9.81
SMOOTH = WheelOnSoil(radius=0.15735, width=0.165)
FLEXIBLE = Carcass(compliance=(5e-6, 75e-6, 41e-6, 8e-6, 1e-6), load=200.0, source="a spring wheel's")
WHEEL = WheelOnSoil(radius=0.1425, width=0.12, carcass=FLEXIBLE)


def wong_reece(soil: Soil, load: float, slip: float) -> tuple[float, float, float]:
    """Pull, torque and sinkage of the smooth rigid wheel with theta_2 from the unloading line."""
    R, b = SMOOTH.radius, SMOOTH.width
    k = (soil.cohesive_modulus / b + soil.frictional_modulus) / ((1 + slip) / (1 - slip / 2)) ** soil.exponent
    friction = math.tan(soil.rim_friction * soil.friction_angle)

    def integrals(first: float) -> tuple[float, float, float]:
        top = (soil.peak_rolling + soil.peak_slipping * slip) * first
        deepest = R * (math.cos(top) - math.cos(first))
        behind = -math.acos(1.0 - min(k * deepest**soil.exponent / (soil.unloading_growth * deepest), 1.0) / R)

        def pressure(t: float) -> float:
            e = t if t >= top else first - (t - behind) / (top - behind) * (first - top)
            return k * max(R * (math.cos(e) - math.cos(first)), 0.0) ** soil.exponent

        def shear(t: float) -> float:
            j = R * ((first - t) - (1 - slip) * (math.sin(first) - math.sin(t)))
            return pressure(t) * friction * math.copysign(1 - math.exp(-abs(j) / soil.shear_modulus), j)

        def total(f: object) -> float:
            parts = ((behind, top), (top, first))
            return sum(quad(f, low, high, epsabs=1e-12, epsrel=1e-12, limit=400)[0] for low, high in parts)

        load_ = R * b * total(lambda t: pressure(t) * math.cos(t) + shear(t) * math.sin(t))
        pull = R * b * total(lambda t: shear(t) * math.cos(t) - pressure(t) * math.sin(t))
        return load_, pull, R * R * b * total(shear)

    first = float(brentq(lambda t: integrals(t)[0] - load, 0.05, 1.2, xtol=1e-13))
    _, pull, torque = integrals(first)
    return pull, torque, R * (1.0 - math.cos(first))


@pytest.mark.parametrize("slip", [0.05, 0.3, 0.6])
def test_a_rigid_wheel_is_wong_and_reeces(slip: float) -> None:
    soil = soil_named("ding2011")
    found = steady_wheel(SMOOTH, soil, 80.0, slip, EARTH)
    pull, torque, sinkage = wong_reece(soil, 80.0, slip)
    assert found.load == pytest.approx(80.0, rel=1e-9)
    assert found.drawbar_pull == pytest.approx(pull, rel=1e-6)
    assert found.torque == pytest.approx(torque, rel=1e-6)
    assert found.sinkage == pytest.approx(sinkage, rel=1e-6)


def test_a_standing_rigid_wheel_carries_the_closed_form() -> None:
    soil = replace(soil_named("fjs1"), exponent=1.0)
    found = standing_wheel(SMOOTH, soil, 120.0)
    k, R, b, t = soil.modulus(SMOOTH.width), SMOOTH.radius, SMOOTH.width, found.entry
    assert b * k * R * R * (t - math.sin(t) * math.cos(t)) == pytest.approx(120.0, rel=1e-6)
    assert found.sinkage == pytest.approx(R * (1.0 - math.cos(t)), rel=1e-3)
    assert found.exit == pytest.approx(-t, rel=1e-3)


def test_a_rim_that_stiffens_goes_over_into_the_rigid_one_in_first_order() -> None:
    soil = soil_named("ding2011")
    rigid = steady_wheel(replace(WHEEL, carcass=RIGID), soil, 200.0, 0.2, EARTH)
    shares = np.array([0.08, 0.04, 0.02, 0.01])
    gains = []
    for share in shares.tolist():
        carcass = replace(FLEXIBLE, compliance=tuple(share * g for g in FLEXIBLE.compliance))
        gains.append(steady_wheel(replace(WHEEL, carcass=carcass), soil, 200.0, 0.2, EARTH).drawbar_pull)
    apart = np.abs(np.array(gains) - rigid.drawbar_pull)
    order = np.polyfit(np.log(shares), np.log(apart), 1)[0]
    assert 0.9 < order < 1.1
    assert gains[0] > rigid.drawbar_pull


def rim_at(soil: Soil, height: float) -> float:
    """Load of the flexible wheel at rest with its hub so high: points every milliradian, damped steps, sums."""
    angle = np.arange(-1.2, 1.2, 1e-3)
    apart = np.cos(np.subtract.outer(angle, angle)[None] * np.arange(len(FLEXIBLE.compliance))[:, None, None])
    influence = np.einsum("m,mij->ij", np.array(FLEXIBLE.compliance), apart)
    w = np.zeros_like(angle)
    for _ in range(200):
        reach = WHEEL.radius - w
        pressure = soil.modulus(WHEEL.width) * np.maximum(reach * np.cos(angle) - height, 0.0) ** soil.exponent
        w += 0.2 * (influence @ (WHEEL.width * pressure * reach * 1e-3) - w)
    x = (WHEEL.radius - w) * np.sin(angle)
    return float(WHEEL.width * pressure @ np.gradient(x))


@pytest.mark.parametrize("height", [0.125, 0.115])
def test_a_flexible_wheel_at_rest_is_what_points_around_its_rim_give(height: float) -> None:
    soil = soil_named("ding2011")
    assert standing_wheel(WHEEL, soil, rim_at(soil, height)).hub_height == pytest.approx(height, abs=1e-6)


def test_on_soil_as_hard_as_rock_the_rim_gives_way_as_on_rigid_ground() -> None:
    rock = replace(soil_named("ding2011"), frictional_modulus=2e11, cohesive_modulus=0.0, exponent=1.0)
    found = standing_wheel(WHEEL, rock, 100.0)
    assert found.deflection == pytest.approx(100.0 * FLEXIBLE.deflection_per_load, rel=0.15)
    assert found.sinkage < 2e-4
    assert found.hub_height == pytest.approx(WHEEL.radius - found.deflection - found.sinkage, abs=1e-5)


def test_a_flexible_wheel_sinks_less_and_pulls_more() -> None:
    soil = soil_named("ding2011")
    rigid = steady_wheel(replace(WHEEL, carcass=RIGID), soil, 200.0, 0.2, EARTH)
    flexible = steady_wheel(WHEEL, soil, 200.0, 0.2, EARTH)
    assert flexible.sinkage < rigid.sinkage
    assert flexible.drawbar_pull > 1.05 * rigid.drawbar_pull
    assert flexible.largest_pressure < rigid.largest_pressure


def test_the_towed_wheel_takes_no_torque_and_resists() -> None:
    found = towed_wheel(SMOOTH, soil_named("ding2011"), 80.0, EARTH)
    assert abs(found.torque) < 1e-6
    assert -0.2 < found.slip < 0.0
    assert found.drawbar_pull < 0.0


@pytest.mark.parametrize(
    "change",
    [{"shear_modulus": 0.114}, {"cohesion": 0.0}, {"friction_angle": 0.4}],
    ids=["K ten times", "no cohesion", "less friction"],
)
def test_weaker_soil_pulls_less(change: dict[str, float]) -> None:
    soil = soil_named("ding2011")
    wheel = replace(WHEEL, lug_height=0.003, lugs=24)
    given = steady_wheel(wheel, soil, 200.0, 0.2, EARTH).drawbar_pull
    weaker = steady_wheel(wheel, replace(soil, ranges={}, **change), 200.0, 0.2, EARTH).drawbar_pull
    assert weaker < given - 0.1


def test_lugs_pull() -> None:
    soil = soil_named("ding2011")
    lugged = steady_wheel(replace(WHEEL, lug_height=0.003, lugs=24), soil, 200.0, 0.2, EARTH)
    bare = steady_wheel(WHEEL, soil, 200.0, 0.2, EARTH)
    assert lugged.drawbar_pull > bare.drawbar_pull + 1.0


def test_what_cannot_be_is_refused() -> None:
    soil = soil_named("grc1")
    for load, slip, word in ((0.0, 0.1, "load"), (1e5, 0.1, "axle"), (80.0, 1.0, "slip"), (80.0, math.nan, "slip")):
        with pytest.raises(InputError, match=word):
            steady_wheel(SMOOTH, soil, load, slip, EARTH)
    with pytest.raises(InputError, match="gravity"):
        steady_wheel(SMOOTH, soil, 80.0, 0.1, -1.0)
    with pytest.raises(InputError, match="lugs"):
        WheelOnSoil(radius=0.1, width=0.1, lugs=-1)
