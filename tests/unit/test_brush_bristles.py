"""Bristles of one contact: they stick, slide, are held, spring back, and do so smoothly."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.tires.brush_settings import BrushSettings, SlipLaw, WheelNumbers, wheel_numbers
from rover_dynamics.tires.brush_standstill import BAND, SMALLEST, bristle_force, held_motion
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, with_friction

BRUSH = wheel_numbers(THESIS_BRUSH, BrushSettings())
FIALA = wheel_numbers(THESIS_BRUSH, BrushSettings(slip_law=SlipLaw.FIALA))
LOAD = 200.0
LIMIT = 3.0 * 0.757 * LOAD / 275e3


def test_at_rest_the_bristles_hold_what_they_carry() -> None:
    for numbers in (BRUSH, FIALA):
        force, rate, _ = bristle_force(LOAD, (3e-4, -2e-4), (0.0, 0.0), 0.0, numbers)
        assert rate == (0.0, 0.0)
        assert force[0] > 0.0 > force[1]
        assert force[2] == 0.0  # no trail without rolling


def test_force_of_small_deflections_is_that_of_the_bristles_stiffness() -> None:
    for numbers in (BRUSH, FIALA):
        force, _, _ = bristle_force(LOAD, (2e-7, 1e-7), (0.0, 0.0), 0.0, numbers)
        assert force[:2] == (pytest.approx(275e3 * 2e-7, rel=1e-3), pytest.approx(275e3 * 1e-7, rel=1e-3))


def test_deflection_stops_at_the_sliding_limit_and_returns_at_once() -> None:
    u = (LIMIT * (1.0 + BAND) + SMALLEST) * 1.0
    force, rate, _ = bristle_force(LOAD, (u, 0.0), (0.05, 0.0), 0.0, BRUSH)
    assert rate[0] == pytest.approx(0.0, abs=1e-12)
    assert force[0] == pytest.approx(0.597 * LOAD, rel=1e-12)  # sliding without rolling: full slip
    _, rate, _ = bristle_force(LOAD, (u, 0.0), (-0.05, 0.0), 0.0, BRUSH)
    assert rate[0] == -0.05


def test_sliding_turns_the_force_against_the_sliding() -> None:
    u = np.array([2.0 * LIMIT, 0.0])
    for _ in range(12000):  # 24 mm, ten times the deflection
        force, rate, _ = bristle_force(LOAD, (u[0], u[1]), (0.0, 0.02), 0.0, BRUSH)
        u += 1e-4 * np.array(rate)
    assert math.atan2(force[1], force[0]) == pytest.approx(math.pi / 2, abs=1e-3)


def test_deflection_beyond_the_band_returns_when_the_load_falls() -> None:
    _, rate, _ = bristle_force(0.0, (1e-3, 0.0), (0.0, 0.0), 0.0, BRUSH)
    assert rate[0] == pytest.approx(-(1e-3 - SMALLEST) / 0.005)


def test_no_load_no_force() -> None:
    for numbers in (BRUSH, FIALA):
        assert bristle_force(0.0, (1e-4, 1e-4), (0.1, 0.1), 0.1, numbers)[0] == (0.0, 0.0, 0.0)


def test_force_and_rate_are_continuous_in_deflection_and_slip() -> None:
    for numbers in (BRUSH, FIALA):
        u = np.linspace(-0.01, 0.01, 20001)
        force, rate, _ = (
            np.array(part)
            for part in zip(*(bristle_force(LOAD, (x, 3e-4), (0.01, 0.002), 0.02, numbers) for x in u), strict=True)
        )
        assert np.abs(np.diff(force, axis=0)).max() < 275e3 * 4e-6
        assert np.abs(np.diff(rate, axis=0)).max() < 4e-4  # 1 micrometre of 0.5 L = 0.8 mm and of 5 ms


def test_held_motion_acts_outwards_only() -> None:
    assert held_motion((0.0, 0.0), (1.0, 1.0), 0.0, 1e-3, 1.0)[0] == (0.0, 0.0)
    assert held_motion((1e-3, 0.0), (0.3, 0.2), 2e-3, 1e-3, 1.0)[0] == (0.0, 0.0)
    assert held_motion((3e-2, 0.0), (0.3, 0.2), 2e-3, 1e-3, 1.0)[0] == (0.3, 0.0)
    assert held_motion((3e-2, 0.0), (-0.3, 0.2), 2e-3, 1e-3, 1.0)[0] == (0.0, 0.0)


def carcass(ratio: float = 4.0) -> WheelNumbers:
    """Forwards 3 N/mm, sideways 12 N/mm."""
    settings = BrushSettings(slip_law=SlipLaw.CARCASS, relaxation_length=8250.0 / 3e3, lateral_ratio=ratio)
    return wheel_numbers(with_friction(THESIS_BRUSH, 0.6), settings)


def test_a_carcass_yields_in_proportion_up_to_the_friction_circle() -> None:
    """By hand: 3 N/mm forwards, 12 sideways, 120 N at most in every direction."""
    assert bristle_force(LOAD, (10e-3, 0.0), (0.0, 0.0), 0.0, carcass())[0][:2] == pytest.approx((30.0, 0.0))
    assert bristle_force(LOAD, (10e-3, 5e-3), (0.0, 0.0), 0.0, carcass())[0] == pytest.approx((30.0, 60.0, 0.0))
    force, rate, _ = bristle_force(LOAD, (1.02 * 40e-3 + 5e-5, 0.0), (0.02, 0.0), 0.0, carcass())
    assert (force[0], rate[0]) == (pytest.approx(120.0), pytest.approx(0.0, abs=1e-12))


def test_a_carcass_that_rolls_slips_as_its_slip_stiffnesses_say() -> None:
    """Steady at slip 1 %: 82.5 N forwards; the lateral bristles leak over their own length."""
    V, s = 0.02, 0.01
    u = s * 8250.0 / 3e3, 0.001 * 850.0 * 180.0 / math.pi / 12e3
    force, rate, slip = bristle_force(LOAD, u, (s * V, 0.001 * V), V, carcass())
    assert rate == (pytest.approx(0.0, abs=1e-12), pytest.approx(0.0, abs=1e-12))
    assert slip == (pytest.approx(s), pytest.approx(0.001))
    assert force[:2] == (pytest.approx(82.5), pytest.approx(0.001 * 850.0 * 180.0 / math.pi))


def test_sliding_aslant_a_carcass_pulls_against_the_sliding() -> None:
    """And then along it, though its two stiffnesses differ."""
    u, numbers = np.array([40e-3, 0.0]), carcass()
    for _ in range(40000):  # 240 mm of sliding
        force, rate, _ = bristle_force(LOAD, (u[0], u[1]), (0.06, 0.08), 0.0, numbers)
        u += 1e-4 * np.array(rate)
    assert math.atan2(force[1], force[0]) == pytest.approx(math.atan2(0.08, 0.06), abs=1e-3)
    assert math.hypot(force[0], force[1]) == pytest.approx(120.0)


def test_held_motion_of_a_carcass_keeps_the_force_where_it_is() -> None:
    """Fully slid: the rate of (u_x, r u_y) has no part along it left, and h is along the force."""
    u, v, ratio = (30e-3, 5e-3), (0.02, 0.03), 4.0
    f = np.array([u[0], ratio * u[1]])
    h, beyond = held_motion(u, v, 20e-3, 1e-3, ratio)
    left = np.array([v[0] - h[0], ratio * (v[1] - h[1])])
    assert float(left @ f) == pytest.approx(0.0, abs=1e-12)
    assert h[0] * f[1] == pytest.approx(h[1] * f[0])
    assert math.hypot(u[0] - beyond[0], ratio * (u[1] - beyond[1])) == pytest.approx(21e-3)


def test_only_a_carcass_may_differ_sideways() -> None:
    with pytest.raises(InputError, match="lateral ratio = 2: must be 1 for the slip law brush"):
        BrushSettings(lateral_ratio=2.0)


def test_no_loop_of_a_carcass_that_sticks_or_slides_creates_energy() -> None:
    """Closed paths of the tread at rest, some of them into sliding: what the force on it does is never more than 0."""
    numbers, rng = carcass(), np.random.default_rng(4)
    for _ in range(6):
        corners = np.cumsum(rng.normal(0.0, 20e-3, (4, 2)), axis=0)
        ends = itertools.pairwise([*corners, *corners[:2]])
        path = np.concatenate([np.linspace(a, b, 400, endpoint=False) for a, b in ends])
        u, work = np.zeros(2), 0.0
        for before, after in itertools.pairwise(np.concatenate([path, path, path])):
            v = (after - before) / 1e-3
            force, rate, _ = bristle_force(LOAD, (u[0], u[1]), (v[0], v[1]), 0.0, numbers)
            u += 1e-3 * np.array(rate)
            work += float(np.array(force[:2]) @ (after - before))
        assert work > -0.01 * 120.0 * float(np.abs(u).max())
