"""Claim: a wheel with brush tire rolls, drives, brakes and corners as its steady laws say, and creates no energy.

Sources: the steady laws (verified in test_brush_steady.py), Newton's laws for a mass on a wheel, and the response of a
tire with relaxation length sigma to small slip, F = F_steady (1 - exp(-x / sigma)) (Pacejka 2012, section 7.2.1).
Tolerances: steady rolling 1e-4 N of about 150 N (the regular speed of 1 mm/s against 1 m/s is in it); rolling to rest
and braking 0.5 %, the rest being what the bristles and Fiala's approach to the friction limit do; response 2 %. No loop
of slip at constant load may do negative work, to 1e-9 m times the load. Negative controls: slip forces of the other
law, a wheel braked with the friction of no slip, and bristles read a quarter of a period late.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from contracts.terrain import Plane
from rover_dynamics.tires.brush_settings import BrushSettings, SlipLaw, wheel_numbers
from rover_dynamics.tires.brush_slip import brush_slip, falling_friction, fiala_slip
from rover_dynamics.tires.brush_standstill import bristle_force
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from rover_dynamics.tires.brush_wheel import BrushWheels
from tests.brush_rig import RADIUS, STIFFNESS, Rig, motion

FloatArray = NDArray[np.float64]
MARS, MASS = 3.711, 320.0 / 6.0
DEFLECTION = MASS * MARS / STIFFNESS
LOADED = RADIUS - DEFLECTION
LOAD = MASS * MARS
FIALA, BRUSH = BrushSettings(slip_law=SlipLaw.FIALA), BrushSettings()
EVEN = replace(THESIS_BRUSH, cornering_stiffness=THESIS_BRUSH.longitudinal_slip_stiffness)


def steadily_rolling(wheels: BrushWheels, slip: tuple[float, float], rolling: float, until: float) -> FloatArray:
    """Force (F_x, F_y) and moment M_z after ``until`` seconds at a constant slip.

    The slip is that of the law: over the rolling speed (brush), over the forward speed (Fiala).
    """
    if wheels.numbers.law == SlipLaw.BRUSH:
        forward, sideways = rolling * (1.0 - slip[0]), -rolling * slip[1]
    else:
        forward = rolling / (1.0 + slip[0])
        sideways = -forward * slip[1]
    hub = motion((0.0, 0.0, LOADED), None, (forward, sideways, 0.0), (0.0, rolling / RADIUS, 0.0))
    found = solve_ivp(lambda t, u: wheels.forces(hub, u[None]).rate[0], (0.0, until), np.zeros(2), "LSODA", rtol=1e-9)
    wrench = wheels.forces(hub, np.ascontiguousarray(found.y[:, -1][None])).wrench[0]
    return np.array([wrench[0], wrench[1], wrench[5]])


def expected(law: SlipLaw, slip: tuple[float, float]) -> FloatArray:
    friction = falling_friction(math.hypot(*slip), 0.597, 0.757)
    if law is SlipLaw.BRUSH:
        return np.array(brush_slip(slip, LOAD, 8250.0, friction, 0.03))
    return np.array(fiala_slip(slip, LOAD, (8250.0, THESIS_BRUSH.cornering_stiffness), friction, 0.12))


SLIPS = [(0.002, 0.0), (-0.005, 0.003), (0.0, -0.01), (0.02, 0.02), (0.3, 0.0), (0.1, -0.4), (-0.6, 0.1)]


@pytest.mark.parametrize("slip", SLIPS)
def test_steady_rolling_gives_the_steady_law(slip: tuple[float, float]) -> None:
    for parameters, settings in ((EVEN, BRUSH), (THESIS_BRUSH, FIALA)):
        wheels = BrushWheels(Plane(), 1, parameters, settings)
        found = steadily_rolling(wheels, slip, 1.0, 20.0)
        wanted = expected(settings.slip_law, slip)
        np.testing.assert_allclose(found[:2], wanted[:2], rtol=0, atol=1e-4 * LOAD / 100.0)
        # 1e-6 of M_z: the sign of the rolling direction is V / sqrt(V^2 + v_0^2)
        np.testing.assert_allclose(found[2], wanted[2], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("slip", SLIPS[:4])
def test_negative_control_the_other_law(slip: tuple[float, float]) -> None:
    wheels = BrushWheels(Plane(), 1, EVEN, BRUSH)
    off = steadily_rolling(wheels, slip, 1.0, 20.0) - expected(SlipLaw.FIALA, slip)
    assert np.abs(off).max() > 0.5


def test_brush_with_two_stiffnesses_has_both_at_small_slip() -> None:
    wheels = BrushWheels(Plane(), 1)
    forward, sideways, _ = steadily_rolling(wheels, (1e-6, 2e-6), 1.0, 20.0)
    assert forward == pytest.approx(8250.0 * 1e-6, rel=1e-3)
    assert sideways == pytest.approx(THESIS_BRUSH.cornering_stiffness * 2e-6, rel=1e-3)


def test_rolling_backwards_mirrors_forces_and_moment() -> None:
    wheels = BrushWheels(Plane(), 1)
    ahead, back = (steadily_rolling(wheels, (0.003, 0.001), speed, 20.0) for speed in (1.0, -1.0))
    np.testing.assert_allclose(back, ahead * [-1.0, -1.0, 1.0], rtol=1e-6)


def test_free_wheel_rolls_out_by_rolling_resistance() -> None:
    rig = Rig(torque=lambda t, spin: 0.0)
    y = rig.run(rig.start((0.0, 0.0, LOADED), 0.5, 0.5 / RADIUS), np.array([0.0, 1.0, 3.0]))
    deceleration = 0.015 * LOAD * LOADED / RADIUS / (MASS + rig.inertia / RADIUS**2)
    assert (y[1, 3] - y[2, 3]) / 2.0 == pytest.approx(deceleration, rel=5e-3)


@pytest.mark.parametrize("settings", [BRUSH, FIALA], ids=["brush", "fiala"])
def test_one_turn_lays_down_the_rims_circumference(settings: BrushSettings) -> None:
    rig = Rig(torque=lambda t, spin: 0.015 * LOAD * LOADED, settings=settings)  # just the rolling resistance
    start, end = rig.run(rig.start((0.0, 0.0, LOADED), 0.1365 * RADIUS, 0.1365), np.array([0.0, 10.0]))
    assert end[0] - start[0] == pytest.approx(10.0 * 0.1365 * RADIUS, rel=1e-6)  # 70 m/h


def test_drive_torque_accelerates_as_newton_says() -> None:
    rig = Rig(torque=lambda t, spin: 3.5)
    y = rig.run(rig.start((0.0, 0.0, LOADED)), np.array([0.0, 1.0, 3.0]))
    acceleration = (3.5 - 0.015 * LOAD * LOADED) / RADIUS / (MASS + rig.inertia / RADIUS**2)
    assert (y[2, 3] - y[1, 3]) / 2.0 == pytest.approx(acceleration, rel=1e-2)  # slip grows a little with speed
    assert rig.response(y[2]).output[0, 7] == pytest.approx(MASS * acceleration, rel=1e-2)


def braking(settings: BrushSettings, friction_min: float) -> float:
    """Mean deceleration of a locked wheel between 2 m/s and about 1 m/s [m/s^2]."""
    rig = Rig(parameters=replace(THESIS_BRUSH, friction_min=friction_min), settings=settings)
    y = rig.run(rig.start((0.0, 0.0, LOADED), 2.0), np.array([0.0, 0.1, 0.5]))
    return float((y[1, 3] - y[2, 3]) / 0.4)


@pytest.mark.parametrize("settings", [BRUSH, FIALA], ids=["brush", "fiala"])
def test_locked_wheel_slides_with_the_smallest_friction(settings: BrushSettings) -> None:
    assert braking(settings, 0.597) == pytest.approx(0.597 * MARS, rel=5e-3)


def test_negative_control_braking_with_the_friction_of_no_slip() -> None:
    assert abs(braking(BRUSH, 0.757) / (0.597 * MARS) - 1.0) > 0.2


def test_cornering_force_grows_over_the_relaxation_length() -> None:
    wheels = BrushWheels(Plane(), 1)
    sigma = wheels.numbers.relaxation_y
    assert sigma == pytest.approx(THESIS_BRUSH.cornering_stiffness / 275e3)
    whole = steadily_rolling(wheels, (0.0, 1e-5), 0.1, 200.0 * sigma)[1]
    for lengths in (0.5, 1.0, 2.0):
        part = steadily_rolling(wheels, (0.0, 1e-5), 0.1, lengths * sigma / 0.1)[1]
        assert part / whole == pytest.approx(1.0 - math.exp(-lengths), rel=2e-2)


def loop_work(law: SlipLaw, speed: float, seed: int, late: int = 0) -> float:
    """Work done on the tire [J] over a random loop of slip after one to settle, at the rolling ``speed``.

    ``late`` steps of delay between the bristles and the force damage the model.
    """
    draw = np.random.default_rng(seed)
    numbers = wheel_numbers(THESIS_BRUSH, BrushSettings(slip_law=law))
    steps, period = 4000, draw.uniform(0.1, 1.0)
    phase = 2.0 * np.pi * np.arange(3 * steps) / steps
    size = 10.0 ** draw.uniform(-4.5, -2.0)
    orders = np.arange(1, 4)[:, None]
    v = sum(
        (draw.normal(size=(3, 2))[:, None, :] * np.cos(orders * phase + draw.uniform(0, 6, (3, 1)))[..., None]).sum(0)
        for _ in range(2)
    ) * (size * 2.0 * np.pi / period)
    u, h, work, past = (0.0, 0.0), period / steps, 0.0, []
    for k, slip in enumerate(v):
        (F_x, F_y, _), rate, _ = bristle_force(LOAD, u, (slip[0], slip[1]), speed, numbers)
        past.append((F_x, F_y))
        middle = u[0] + 0.5 * h * rate[0], u[1] + 0.5 * h * rate[1]
        _, rate, _ = bristle_force(LOAD, middle, (slip[0], slip[1]), speed, numbers)
        u = u[0] + h * rate[0], u[1] + h * rate[1]
        if k >= steps:
            force = past[k - late]
            work += h * (force[0] * slip[0] + force[1] * slip[1])
    return work


@pytest.mark.parametrize("speed", [0.0, 0.02])
@pytest.mark.parametrize("law", list(SlipLaw))
def test_a_closed_loop_of_slip_creates_no_energy(law: SlipLaw, speed: float) -> None:
    works = [loop_work(law, speed, seed) for seed in range(12)]
    assert min(works) > -1e-9 * LOAD
    assert max(works) > 1e-6 * LOAD


def test_negative_control_bristles_read_late_create_energy() -> None:
    assert min(loop_work(SlipLaw.BRUSH, 0.0, seed, late=1000) for seed in range(12)) < -1e-6 * LOAD
