"""Bristles of one contact: they stick, slide, are held, spring back, and do so smoothly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rover_dynamics.tires.brush_settings import BrushSettings, SlipLaw, wheel_numbers
from rover_dynamics.tires.brush_standstill import BAND, SMALLEST, bristle_force, held_motion
from rover_dynamics.tires.brush_tire import THESIS_BRUSH

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
    assert held_motion((0.0, 0.0), (1.0, 1.0), 0.0)[0] == (0.0, 0.0)
    assert held_motion((1e-3, 0.0), (0.3, 0.2), 2e-3)[0] == (0.0, 0.0)
    assert held_motion((3e-2, 0.0), (0.3, 0.2), 2e-3)[0] == (0.3, 0.0)
    assert held_motion((3e-2, 0.0), (-0.3, 0.2), 2e-3)[0] == (0.0, 0.0)
