"""A wheel on soil.

Claims: a rigid wheel's load, pull and torque are Wong and Reece's integrals to 1e-6, here once more by adaptive
quadrature of their formulas, with lugs and when it skids to 1e-4 of the load; a standing one carries the closed form; a
flexible one, at rest and driven, is what sums over points of its rim give, of other code; it goes over into the rigid
one as it stiffens, with the order one of its compliance, and gives way on rigid soil as on rigid ground.
Sources: Wong and Reece (1967) as docs/theory/soil.md has them. Negative controls: K ten times, no cohesion, no lugs
each take pull away.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

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


def strength(wheel: WheelOnSoil, soil: Soil, gravity: float, pressure: float) -> float:
    """Of the rim [Pa], docs/theory/soil.md 11.4."""
    slides = pressure * math.tan(soil.rim_angle)
    if not wheel.lugs:
        return slides
    h, passive = wheel.lug_height, math.tan(0.25 * math.pi + 0.5 * soil.friction_angle) ** 2
    sides = h / wheel.width
    tips = soil.cohesion * (1 + 2 * sides)
    tips += pressure * math.tan(soil.friction_angle) * (1 + 0.64 * sides * (0.5 * math.pi - math.atan(sides)))
    pushed = (0.5 * soil.density * gravity * h**2 + pressure * h) * passive + 2 * soil.cohesion * h * passive**0.5
    return float(min(tips, slides + pushed * wheel.lugs / (2 * math.pi * wheel.radius)))


def wong_reece(wheel: WheelOnSoil, soil: Soil, load: float, slip: float, gravity: float) -> tuple[float, float, float]:
    """Pull, torque and sinkage of a rigid wheel with theta_2 from the unloading line."""
    R, b = wheel.radius, wheel.width
    faces = R + 0.5 * wheel.lug_height
    ahead = max(slip, 0.0)
    k = (soil.cohesive_modulus / b + soil.frictional_modulus) / ((1 + ahead) / (1 - ahead / 2)) ** soil.exponent

    def integrals(first: float) -> tuple[float, float, float]:
        top = (soil.peak_rolling + soil.peak_slipping * ahead) * first
        deepest = R * (math.cos(top) - math.cos(first))
        line = soil.unloading_stiffness + soil.unloading_growth * deepest
        behind = -math.acos(1.0 - min(k * deepest**soil.exponent / line, 1.0) / R)

        def pressure(t: float) -> float:
            e = t if t >= top else first - (t - behind) / (top - behind) * (first - top)
            return float(k * max(R * (math.cos(e) - math.cos(first)), 0.0) ** soil.exponent)

        def shear(t: float) -> float:
            j = faces * (first - t) - (1 - slip) * R * (math.sin(first) - math.sin(t))
            share = math.copysign(1 - math.exp(-abs(j) / soil.shear_modulus), j)
            return strength(wheel, soil, gravity, pressure(t)) * share

        def total(f: Callable[[float], float]) -> float:
            parts = ((behind, top), (top, first))
            return float(sum(quad(f, low, high, epsabs=1e-12, epsrel=1e-12, limit=400)[0] for low, high in parts))

        load_ = R * b * total(lambda t: pressure(t) * math.cos(t) + shear(t) * math.sin(t))
        pull = R * b * total(lambda t: shear(t) * math.cos(t) - pressure(t) * math.sin(t))
        return load_, pull, R * faces * b * total(shear)

    first = float(brentq(lambda t: integrals(t)[0] - load, 0.05, 1.2, xtol=1e-13))
    _, pull, torque = integrals(first)
    return pull, torque, R * (1.0 - math.cos(first))


@pytest.mark.parametrize("slip", [0.05, 0.3, 0.6])
def test_a_rigid_wheel_is_wong_and_reeces(slip: float) -> None:
    soil = soil_named("ding2011")
    found = steady_wheel(SMOOTH, soil, 80.0, slip, EARTH)
    pull, torque, sinkage = wong_reece(SMOOTH, soil, 80.0, slip, EARTH)
    assert found.load == pytest.approx(80.0, rel=1e-9)
    assert found.drawbar_pull == pytest.approx(pull, rel=1e-6)
    assert found.torque == pytest.approx(torque, rel=1e-6)
    assert found.sinkage == pytest.approx(sinkage, rel=1e-6)
    assert found.efficiency == pytest.approx(max(pull, 0.0) * (1.0 - slip) * SMOOTH.radius / torque, rel=1e-6)


@pytest.mark.filterwarnings("ignore::scipy.integrate.IntegrationWarning")
@pytest.mark.parametrize(("slip", "lugs"), [(-0.2, 12), (0.3, 12), (0.3, 3), (-0.2, 0)])
def test_with_lugs_and_when_it_skids_it_is_too(slip: float, lugs: int) -> None:
    """Its stresses have kinks, where lugs change their way to fail and where the shear turns: 1e-4 of the load."""
    soil = replace(soil_named("ding2011"), unloading_stiffness=2e6)
    wheel = replace(SMOOTH, lug_height=0.02 if lugs else 0.0, lugs=lugs)
    found = steady_wheel(wheel, soil, 80.0, slip, EARTH)
    pull, torque, sinkage = wong_reece(wheel, soil, 80.0, slip, EARTH)
    assert found.drawbar_pull == pytest.approx(pull, abs=1e-4 * 80.0)
    assert found.torque == pytest.approx(torque, abs=1e-4 * 80.0 * wheel.radius)
    assert found.sinkage == pytest.approx(sinkage, rel=1e-4)


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


def rim_at(soil: Soil, height: float, slip: float | None = None) -> tuple[float, float, float, float]:
    """Load, pull, torque and sinkage of the flexible wheel, its hub so high, at rest or driven; sums over points."""
    step, R, b = 1e-4, WHEEL.radius, WHEEL.width
    angle, order = np.arange(1.2, -1.2, -step), np.arange(len(FLEXIBLE.compliance))
    cosines, sines = np.cos(np.outer(order, angle)), np.sin(np.outer(order, angle))
    g, w = np.array(FLEXIBLE.compliance)[:, None], np.zeros_like(angle)
    s = 0.0 if slip is None else slip
    k = soil.modulus(b) / ((1 + s) / (1 - s / 2)) ** soil.exponent
    for _ in range(200):
        depth = (R - w) * np.cos(angle) - height
        first = int(np.argmax(depth > 0.0))
        entry = float(np.interp(0.0, depth[first - 1 : first + 1], angle[first - 1 : first + 1]))
        felt = np.maximum(depth, 0.0)
        if slip is not None:
            top = (soil.peak_rolling + soil.peak_slipping * slip) * entry
            peak = float(np.interp(-top, -angle, depth))
            left = depth.max() - k * peak**soil.exponent / (soil.unloading_growth * peak)
            last = len(angle) - 1 - int(np.argmax(depth[::-1] > left))
            behind = float(np.interp(left, depth[[last + 1, last]], angle[[last + 1, last]]))
            as_front = np.where(angle > top, angle, top + (top - angle) * (entry - top) / (top - behind))
            felt = np.where(angle > behind, np.maximum(np.interp(-as_front, -angle, depth), 0.0), 0.0)
        pressure = k * felt**soil.exponent
        force = b * pressure * (R - w) * step
        shape = g * (cosines @ force)[:, None] * cosines + g * (sines @ force)[:, None] * sines
        w += 0.2 * (shape.sum(axis=0) - w)
    x, z = (R - w) * np.sin(angle), (R - w) * np.cos(angle) - height
    dx, dz = -np.gradient(x), -np.gradient(z)
    if slip is None:
        return float(b * pressure @ dx), 0.0, 0.0, float(z.max())
    arc = np.hypot(dx, dz)
    touches = angle <= entry
    j = np.cumsum((arc - (1 - slip) * dx) * touches)
    tau = pressure * math.tan(soil.rim_angle) * np.sign(j) * (1 - np.exp(-np.abs(j) / soil.shear_modulus))
    return (
        float(b * (pressure @ dx - tau @ dz)),
        float(b * (tau @ dx + pressure @ dz)),
        float(R * b * tau @ arc),
        float(z.max()),
    )


@pytest.mark.parametrize("height", [0.125, 0.115])
def test_a_flexible_wheel_at_rest_is_what_points_around_its_rim_give(height: float) -> None:
    soil = soil_named("ding2011")
    load, _, _, sinkage = rim_at(soil, height)
    found = standing_wheel(WHEEL, soil, load)
    assert (found.hub_height, found.sinkage) == pytest.approx((height, sinkage), abs=1e-6)


@pytest.mark.parametrize("slip", [0.0, 0.3])
def test_a_flexible_wheel_that_drives_is_too(slip: float) -> None:
    soil = soil_named("ding2011")
    load, pull, torque, sinkage = rim_at(soil, 0.105, slip)
    found = steady_wheel(WHEEL, soil, load, slip, EARTH)
    assert (found.hub_height, found.sinkage) == pytest.approx((0.105, sinkage), abs=2e-6)
    assert (found.drawbar_pull, found.torque) == pytest.approx((pull, torque), rel=1e-3)


def test_the_rim_is_as_soft_as_the_wheel_is_at_the_load() -> None:
    curve = ((100.0, 7e-3), (200.0, 16e-3), (300.0, 30e-3))
    given = replace(FLEXIBLE, curve=curve)
    scaled = replace(FLEXIBLE, compliance=tuple(70.0 / 80.0 * g for g in FLEXIBLE.compliance), load=100.0)
    soil = soil_named("ding2011")
    found, expected = (steady_wheel(replace(WHEEL, carcass=one), soil, 100.0, 0.2, EARTH) for one in (given, scaled))
    assert found.deflection == pytest.approx(expected.deflection, rel=1e-6)


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


def test_a_wheel_is_towed_where_it_would_dig_itself_in_by_its_drive() -> None:
    soil = replace(soil_named("ding2011"), ranges={}, frictional_modulus=1e5)
    with pytest.raises(InputError, match=r"220 N on ding2011 at slip 0\.5: must be below"):
        steady_wheel(SMOOTH, soil, 220.0, 0.5, EARTH)
    found = towed_wheel(SMOOTH, soil, 220.0, EARTH)
    assert abs(found.torque) < 1e-6
    assert found.slip < 0.0


@pytest.mark.parametrize(
    "change",
    [{"shear_modulus": 0.114}, {"cohesion": 0.0}, {"friction_angle": 0.4}],
    ids=["K ten times", "no cohesion", "less friction"],
)
def test_weaker_soil_pulls_less(change: dict[str, Any]) -> None:
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


def test_the_load_that_a_flexible_wheel_is_told_to_stay_below_is_its_own() -> None:
    """Not that of a shape on the way to it: the same whatever load is asked for, and just below it there is a state."""
    soil, told = soil_named("jsc1a"), set[str]()
    for load in (500.0, 700.0):
        with pytest.raises(InputError, match="axle") as caught:
            steady_wheel(WHEEL, soil, load, 0.8, EARTH)
        told |= set(re.findall(r"below (\S+) N", str(caught.value)))
    (most,) = told
    assert steady_wheel(WHEEL, soil, 0.99 * float(most), 0.8, EARTH).load == pytest.approx(0.99 * float(most))
    with pytest.raises(InputError, match="axle"):
        steady_wheel(WHEEL, soil, 1.01 * float(most), 0.8, EARTH)


def test_what_cannot_be_is_refused() -> None:
    soil = soil_named("grc1")
    for load, slip, word in (
        (0.0, 0.1, "load"),
        (1e-300, 0.1, "hardly touches"),
        (1e5, 0.1, "axle"),
        (80.0, 1.0, "slip"),
        (80.0, math.nan, "slip"),
    ):
        with pytest.raises(InputError, match=word):
            steady_wheel(SMOOTH, soil, load, slip, EARTH)
    with pytest.raises(InputError, match="gravity"):
        steady_wheel(SMOOTH, soil, 80.0, 0.1, -1.0)
    with pytest.raises(InputError, match="lugs"):
        WheelOnSoil(radius=0.1, width=0.1, lugs=-1)
