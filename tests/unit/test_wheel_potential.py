"""A wheel's potential against formulas: a wheel whose stiffness waves around it, with and without grousers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.terrain import Plane, Terrain
from contracts.terrain_ridges import HalfRound
from rover_dynamics.tires.brush_force import DEEP
from rover_dynamics.tires.brush_settings import BrushSettings
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from rover_dynamics.tires.brush_wheel import BrushWheels
from rover_dynamics.tires.wheel_potential import (
    AHEAD,
    MOMENT,
    Tips,
    load_and_slope,
    mean_stiffness,
    raise_and_slope,
    wheel_potential,
)
from tests.brush_rig import RADIUS, motion, turned
from tests.unit.test_brush_derivatives import differences

Array = NDArray[np.float64]
PERIOD = math.radians(120.0)
SMOOTH = Tips(radius=RADIUS, height=0.0, number=1.0, phase=0.0, half=0.0)
GROUSERS = Tips(radius=RADIUS, height=3e-3, number=12.0, phase=math.radians(1.0), half=3.4e-3)
LOSSLESS = replace(THESIS_BRUSH, radial_damping=0.0, rolling_resistance=0.0, friction_min=1e-9, friction_max=1e-9)


def stiffness(orientation: float) -> tuple[float, float]:
    """Of the wheel made up here [N/m], and its slope."""
    return 8000.0 + 800.0 * math.sin(3.0 * orientation), 2400.0 * math.cos(3.0 * orientation)


def curves(tips: Tips, count: int = 24) -> list[StiffnessCurve]:
    """F = k (d + 10 d^2) of the way d since first touch, 40 mm and the grousers' height."""
    d = np.linspace(0.0, 43e-3, 15)
    angles = [120.0 * k / count for k in range(count)]
    loads = [stiffness(math.radians(angle))[0] * (d + 10.0 * d * d) for angle in angles]
    of = zip(angles, loads, strict=True)
    return [StiffnessCurve(model="fe", orientation_deg=a, deflection=d, load=F, source="made up") for a, F in of]


SMOOTH_WHEEL, WHEEL = (
    wheel_potential(curves(SMOOTH), PERIOD, SMOOTH),
    wheel_potential(curves(GROUSERS), PERIOD, GROUSERS),
)


@pytest.mark.parametrize("orientation", [0.0, 0.7, -1.3, 40.0])
def test_load_and_moment_of_a_smooth_wheel_are_the_formulas(orientation: float) -> None:
    k, slope = stiffness(orientation)
    for d in (2e-3, 11e-3, 35e-3):
        found = load_and_slope(SMOOTH_WHEEL, d, orientation)
        assert found[0] == d
        assert found[1] == pytest.approx(k * (d + 10.0 * d * d), rel=1e-4)
        assert found[2] == pytest.approx(slope * (d * d / 2.0 + 10.0 * d**3 / 3.0), abs=1e-3 * 2400.0 * d * d)
    assert load_and_slope(SMOOTH_WHEEL, 0.0, orientation) == (0.0, 0.0, 0.0)


def test_it_goes_through_every_curve_where_grousers_touch_first() -> None:
    for curve in curves(GROUSERS):
        orientation = math.radians(curve.orientation_deg or 0.0)
        raised = raise_and_slope(GROUSERS, orientation)[0]
        for d, load in zip(curve.deflection[1:-1], curve.load[1:-1], strict=True):
            found = load_and_slope(WHEEL, float(d) - raised, orientation)
            assert found[:2] == (pytest.approx(d), pytest.approx(load, rel=2e-3))


def told(tips: Tips, count: int, push: float = 0.0) -> list[StiffnessCurve]:
    """The same with their moments, U = k (d^2 / 2 + 10 d^3 / 3) at equal approach, and a force along the ground."""
    found = []
    for curve in curves(tips, count):
        orientation, d = math.radians(curve.orientation_deg or 0.0), curve.deflection
        turned = stiffness(orientation)[1] * (d * d / 2.0 + 10.0 * d**3 / 3.0)
        moment = -turned - curve.load * raise_and_slope(tips, orientation)[1]
        found.append(replace(curve, columns={MOMENT: moment, AHEAD: push * curve.load}))
    return found


@pytest.mark.parametrize("tips", [SMOOTH, GROUSERS], ids=["smooth", "grousers"])
def test_moments_of_the_curves_are_the_potentials(tips: Tips) -> None:
    """At every curve, few as they are; a spline alone knows them less well, and moments with friction do not count."""
    apart = {}
    for words, given in (
        ("told", told(tips, 12)),
        ("spline", curves(tips, 12)),
        ("friction", told(tips, 12, push=0.1)),
    ):
        wheel, off = wheel_potential(given, PERIOD, tips), []
        for curve in told(tips, 12):
            orientation = math.radians(curve.orientation_deg or 0.0)
            raised = raise_and_slope(tips, orientation)[0]
            for d, moment in zip(curve.deflection[2:-1], curve.columns[MOMENT][2:-1], strict=True):
                off.append(-load_and_slope(wheel, float(d) - raised, orientation)[2] - float(moment))
        apart[words] = np.abs(off).max()
    assert apart["told"] < 5e-3
    assert apart["spline"] > 3.0 * apart["told"]
    assert apart["friction"] == apart["spline"]


def test_a_grouser_raises_the_wheel_as_its_tip_turns() -> None:
    phase, tip = GROUSERS.phase, RADIUS + 3e-3
    assert raise_and_slope(GROUSERS, phase) == (pytest.approx(3e-3), 0.0)
    assert raise_and_slope(GROUSERS, phase + math.radians(15.0)) == (0.0, 0.0)
    for off in (-0.1, 0.05, 0.15):
        away = abs(off) - GROUSERS.half
        raised, slope = raise_and_slope(GROUSERS, phase + 2.0 * math.pi / 12.0 + off)
        assert raised == pytest.approx(tip * math.cos(away) - RADIUS)
        assert slope == pytest.approx(-math.copysign(tip * math.sin(away), off))


@pytest.mark.parametrize("told_moments", [False, True])
@pytest.mark.parametrize("tips", [SMOOTH, GROUSERS], ids=["smooth", "grousers"])
def test_no_way_around_gains_energy(tips: Tips, told_moments: bool) -> None:
    """The control forgets the moment."""
    wheel = wheel_potential(told(tips, 24) if told_moments else curves(tips), PERIOD, tips)
    t = np.linspace(0.0, 2.0 * np.pi, 20001)
    approach, orientation = 15e-3 + 14e-3 * np.cos(t), 0.3 + 0.5 * np.sin(2.0 * t + 1.0)
    _, loads, slopes = np.array([load_and_slope(wheel, *at) for at in zip(approach, orientation, strict=True)]).T
    pressed, turned = loads * np.gradient(approach, t), slopes * np.gradient(orientation, t)
    moved = np.trapezoid(np.abs(pressed), t)
    assert abs(np.trapezoid(pressed + turned, t)) < 1e-5 * moved
    assert abs(np.trapezoid(pressed, t)) > 1e-3 * moved


def spun(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def test_a_wheel_on_the_plane_carries_what_its_position_carries() -> None:
    """Turned forward by an angle it stands on the position of that angle (contracts/frames.py)."""
    wheels = BrushWheels(Plane(), 1, LOSSLESS, BrushSettings(potential=WHEEL))
    for angle, approach in ((0.0, 0.02), (0.4, 0.01), (-0.9, 0.03), (0.1, -1e-3)):
        found = wheels.forces(motion((0.2, 0.1, RADIUS - approach), spun(angle)), np.zeros((1, 2)))
        depth, load, slope = load_and_slope(WHEEL, approach, angle)
        assert found.output[0, 0] == pytest.approx(depth)
        np.testing.assert_allclose(found.wrench[0], [0.0, 0.0, load, 0.0, -slope, 0.0], atol=1e-6)
    assert wheels.forces(motion((0.0, 0.0, RADIUS - 0.05)), np.zeros((1, 2))).output[0, 9] == DEEP


@pytest.mark.parametrize("approach", [0.02, 1e-3])
def test_derivatives_are_those_of_the_forces(approach: float) -> None:
    wheels = BrushWheels(Plane(), 1, settings=BrushSettings(potential=WHEEL))
    at = motion((0.1, 0.2, RADIUS - approach), spun(0.3), (0.1, 0.02, -0.01), (0.05, 0.9, 0.1))
    state = np.array([[1e-4, 5e-5]])
    found, wanted = wheels.derivatives(at, state)[0], differences(wheels, at, state)
    assert np.abs((found - wanted) / np.maximum(np.abs(wanted).max(axis=0), 1.0)).max() < 2e-5


@pytest.mark.parametrize("forgets", [False, True])
def test_a_spinning_wheel_bounces_with_the_energy_it_came_with(forgets: bool) -> None:
    """On a frictionless plane, without damping, spin and bounce exchange energy; the control forgets the moment."""
    wheels = BrushWheels(Plane(), 1, LOSSLESS, BrushSettings(potential=WHEEL))
    mass, inertia, gravity = 20.0, 0.05, 3.711

    def rate(_: float, y: Array) -> Array:
        z, v, angle, spin = y
        hub = motion((0.0, 0.0, z), spun(angle), (0.0, 0.0, v), (0.0, spin, 0.0))
        wrench = wheels.forces(hub, np.zeros((1, 2))).wrench[0]
        return np.array([v, wrench[2] / mass - gravity, spin, 0.0 if forgets else wrench[4] / inertia])

    def energy(y: Array) -> float:
        return float(mass * gravity * y[0] + 0.5 * mass * y[1] ** 2 + 0.5 * inertia * y[3] ** 2)

    start = np.array([RADIUS + 20e-3, 0.0, 0.2, 5.0])
    found = solve_ivp(rate, (0.0, 0.5), start, "DOP853", rtol=1e-9, atol=1e-11, max_step=2e-3)
    free = found.y[:, found.y[0] > RADIUS + 4e-3]
    rebound = free[:, free[1] > 0.01]
    assert rebound.shape[1]
    lost = abs(energy(rebound[:, -1]) - energy(start)) / (mass * gravity * 20e-3)
    assert lost > 1e-2 if forgets else lost < 1e-4


@pytest.mark.parametrize("forgets", [False, True])
def test_on_a_rock_the_way_around_it_is_paid_for(forgets: bool) -> None:
    """A spinning wheel bounces off the side of a half-round; the control forgets the force across the contact."""
    wheels = BrushWheels(HalfRound(radius=0.02), 1, LOSSLESS, BrushSettings(potential=WHEEL))
    mass, inertia, gravity = 20.0, 0.05, 3.711

    def rate(_: float, y: Array) -> Array:
        x, z, v_x, v_z, angle, spin = y
        hub = motion((x, 0.0, z), spun(angle), (v_x, 0.0, v_z), (0.0, spin, 0.0))
        wrench = wheels.forces(hub, np.zeros((1, wheels.n_state))).wrench[0]
        force = np.array([wrench[0], wrench[2]])
        if forgets:
            away = np.array([x, z]) / math.hypot(x, z)
            force = (force @ away) * away
        return np.array([v_x, v_z, force[0] / mass, force[1] / mass - gravity, spin, wrench[4] / inertia])

    def energy(y: Array) -> float:
        return float(mass * gravity * y[1] + 0.5 * mass * (y[2] ** 2 + y[3] ** 2) + 0.5 * inertia * y[5] ** 2)

    start = np.array([0.01, RADIUS + 0.04, 0.0, 0.0, 0.2, 5.0])
    found = solve_ivp(rate, (0.0, 0.4), start, "DOP853", rtol=1e-9, atol=1e-11, max_step=2e-3)
    free = found.y[:, np.hypot(found.y[0], found.y[1]) > RADIUS + 0.02 + 4e-3]
    rebound = free[:, free[3] > 0.01]
    assert rebound.shape[1]
    lost = abs(energy(rebound[:, -1]) - energy(start)) / (mass * gravity * 20e-3)
    assert lost > 3e-3 if forgets else lost < 1e-4


@pytest.mark.parametrize("forgets", ["nothing", "force along the axle", "moment across the axle"])
@pytest.mark.parametrize("terrain", [Plane(), HalfRound(radius=0.05)], ids=["plane", "rock"])
def test_no_way_of_a_wheel_that_leans_and_is_steered_gains_energy(terrain: Terrain, forgets: str) -> None:
    """The hub goes around a loop in all its six freedoms, and the work of the wrench is none; of a wheel without width,
    as across the width the load is that of its middle.
    """
    wheels = BrushWheels(terrain, 1, LOSSLESS, BrushSettings(potential=SMOOTH_WHEEL, wheel_width=1e-6))
    s = np.linspace(0.0, 2.0 * np.pi, 1000, endpoint=False)
    top = RADIUS + (0.05 if isinstance(terrain, HalfRound) else 0.0)
    places = np.stack([0.03 * np.cos(s), 0.02 * np.sin(2.0 * s), top - 0.02 + 6e-3 * np.cos(s + 0.5)], axis=1)
    lean, steer, spin = 0.12 + 0.1 * np.sin(s + 1.0), 0.5 + 0.3 * np.cos(2.0 * s), 0.3 + 0.4 * np.sin(s)
    hubs = np.array([turned(a, b) @ spun(c) for a, b, c in zip(lean, steer, spin, strict=True)])
    wrenches = []
    for place, R in zip(places, hubs, strict=True):
        wrench, e = wheels.forces(motion(place, R), np.zeros((1, wheels.n_state))).wrench[0].copy(), R[:, 1]
        if forgets == "force along the axle":
            wrench[:3] -= (wrench[:3] @ e) * e
        elif forgets == "moment across the axle":
            wrench[3:] = (wrench[3:] @ e) * e
        wrenches.append(wrench)
    ways, turns = np.roll(places, -1, axis=0) - np.roll(places, 1, axis=0), np.roll(hubs, -1, axis=0)
    turns = (turns - np.roll(hubs, 1, axis=0)) @ hubs.swapaxes(1, 2)
    twists = np.concatenate([ways, turns[:, (2, 0, 1), (1, 2, 0)]], axis=1)
    work = np.sum(np.array(wrenches) * twists, axis=1)
    gained = abs(work.sum()) / np.abs(work).sum()
    assert gained < 1e-5 if forgets == "nothing" else gained > 1e-2


def test_a_contact_without_friction_pushes_neither_along_a_rock_nor_about_the_planes_normal() -> None:
    leaning = turned(0.2, 0.5) @ spun(0.1)
    of_rock = BrushWheels(HalfRound(radius=0.05), 1, LOSSLESS, BrushSettings(potential=SMOOTH_WHEEL))
    wrench = of_rock.forces(motion((0.02, 0.0, RADIUS + 0.02), leaning), np.zeros((1, of_rock.n_state))).wrench[0]
    assert abs(wrench[1]) < 1e-5 < 1.0 < abs(wrench[0])
    of_plane = BrushWheels(Plane(), 1, LOSSLESS, BrushSettings(potential=SMOOTH_WHEEL))
    wrench = of_plane.forces(motion((0.0, 0.0, RADIUS - 0.03), leaning), np.zeros((1, 2))).wrench[0]
    assert abs(wrench[5]) < 1e-5 < 1.0 < abs(wrench[4])


def test_ground_that_carries_nothing_turns_nothing() -> None:
    """A wheel that leaves faster than the damper lets its spring follow is free of the moment too."""
    wheels = BrushWheels(Plane(), 1, settings=BrushSettings(potential=WHEEL))
    low, state = (0.0, 0.0, RADIUS - 0.02), np.zeros((1, 2))
    standing = wheels.forces(motion(low, spun(0.3)), state).wrench[0]
    leaving = wheels.forces(motion(low, spun(0.3), (0.0, 0.0, 0.1)), state).wrench[0]
    assert abs(standing[4]) > 0.5
    assert leaving == pytest.approx(np.zeros(6), abs=1e-12)


def test_the_mean_stiffness_is_that_of_the_formula() -> None:
    half = 0.5 * SMOOTH_WHEEL.last
    assert mean_stiffness(SMOOTH_WHEEL) == pytest.approx(8000.0 * (1.0 + 10.0 * half), rel=1e-3)


def test_bad_curves_are_refused() -> None:
    good = curves(GROUSERS)
    with pytest.raises(InputError, match="four or more, spread evenly over the wheel's period of 120 deg"):
        wheel_potential(good[:-1], PERIOD, GROUSERS)
    with pytest.raises(InputError, match="four or more"):
        wheel_potential([], PERIOD, GROUSERS)
    with pytest.raises(InputError, match="orientation of a curve"):
        wheel_potential([replace(good[0], orientation_deg=None), *good[1:]], PERIOD, GROUSERS)
    cut = [replace(one, deflection=one.deflection[:3], load=one.load[:3]) for one in good]
    with pytest.raises(InputError, match="four points or more"):
        wheel_potential(cut, PERIOD, GROUSERS)
    low = [replace(one, deflection=0.05 * one.deflection) for one in good]
    with pytest.raises(InputError, match="longer than the grousers are high"):
        wheel_potential(low, PERIOD, GROUSERS)
