"""Signed distances of the obstacles: derivatives by finite differences, values on shapes whose distance is known."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from reference_fe.contact.obstacles import (
    Cleat,
    HalfRoundRock,
    Obstacle,
    Plane,
    StepEdge,
    piece_gap,
    smallest_gap,
    touch_level,
)

STEP = StepEdge(height=0.03, edge_radius=0.004, position=0.01)
ROCK = HalfRoundRock(radius=0.02, position=-0.005)
CLEAT = Cleat(height=0.02, width=0.03, edge_radius=0.005, position=0.004)
POINTS = [
    (0.05, 0.003),
    (0.011, 0.002),
    (0.003, 0.001),
    (-0.02, -0.01),
    (0.0105, -0.0005),
    (0.04, -0.001),
    (-0.03, 0.01),
    (-0.03, -0.022),
]


@pytest.mark.parametrize("obstacle", [Plane(), STEP, ROCK, CLEAT], ids=["plane", "step", "rock", "cleat"])
@pytest.mark.parametrize("point", POINTS)
def test_normal_and_curvature_are_the_derivatives_of_the_gap(obstacle: Obstacle, point: tuple[float, float]) -> None:
    h = 1e-6
    for piece in obstacle.pieces():
        _, n_s, n_z, curvature = piece_gap(piece, *point)
        assert n_s**2 + n_z**2 == pytest.approx(1.0)
        along, up = (h, 0.0), (0.0, h)
        for step, component in ((along, n_s), (up, n_z)):
            ahead, behind = (piece_gap(piece, point[0] + k * step[0], point[1] + k * step[1]) for k in (1, -1))
            assert (ahead[0] - behind[0]) / (2 * h) == pytest.approx(component, abs=1e-6)
            tangent = (n_z, -n_s)
            share = (tangent[0] * step[0] + tangent[1] * step[1]) / h
            slopes = [(ahead[k] - behind[k]) / (2 * h) for k in (1, 2)]
            np.testing.assert_allclose(slopes, curvature * share * np.array(tangent), atol=1e-4 * max(1.0, curvature))


def test_distances_that_are_known() -> None:
    s = np.array([0.05, -0.05, 0.01 - 0.003, 0.014 - 0.01])
    z = np.array([0.002, -0.029, -0.02, -0.004 + 0.01])
    np.testing.assert_allclose(
        smallest_gap(STEP.pieces(), s, z), [0.002, 0.001, 0.003, 0.01 * np.sqrt(2) - 0.004], atol=1e-15
    )
    s, z = np.array([-0.005, 0.025, 0.1]), np.array([0.001, -0.02 + 0.001, 0.0])
    np.testing.assert_allclose(smallest_gap(ROCK.pieces(), s, z), [0.001, 0.001, 0.02], atol=1e-4)
    s, z = 0.004 + np.array([0.0, 0.018, -0.018, 0.015, -0.015]), np.array([0.002, -0.01, -0.01, 0.0, 0.0])
    corner = 0.005 * (np.sqrt(2.0) - 1.0)
    np.testing.assert_allclose(smallest_gap(CLEAT.pieces(), s, z), [0.002, 0.003, 0.003, corner, corner], atol=1e-15)


def test_the_sides_below_the_axis_are_upright() -> None:
    """A point that slid in beside the rock's foot is pushed out sideways, not down into the ground."""
    gap, n_s, n_z, curvature = piece_gap(ROCK.pieces()[0], 0.0147, -0.024)
    assert gap == pytest.approx(-0.0003)
    assert (n_s, n_z, curvature) == (1.0, 0.0, 0.0)


def test_both_sides_of_a_reentrant_corner_press() -> None:
    """Beside the rock's foot a point inside both pieces has two gaps below zero."""
    gaps = [piece_gap(piece, 0.0300, -0.0203)[0] < 0.0 for piece in HalfRoundRock(radius=0.02).pieces()]
    assert gaps == [False, True]
    gaps = [piece_gap(piece, 0.0195, -0.0203)[0] < 0.0 for piece in HalfRoundRock(radius=0.02).pieces()]
    assert gaps == [True, True]


@pytest.mark.parametrize(
    ("obstacle", "expected"),
    [(Plane(), 0.9), (ROCK, 0.9), (StepEdge(height=0.03, edge_radius=0.004, position=0.3), 0.93)],
)
def test_touch_level_of_a_disc_of_points(obstacle: Obstacle, expected: float) -> None:
    """A disc of radius 0.1 about (0, 1): it meets the plane and the rock's crown at 0.9, the lower ground at 0.93."""
    angle = np.linspace(0.0, 2.0 * np.pi, 20001)
    over = -0.005 if obstacle is ROCK else 0.0
    level = touch_level(obstacle, over + 0.1 * np.sin(angle), 1.0 - 0.1 * np.cos(angle))
    assert level == pytest.approx(expected, abs=1e-7)


def test_impossible_obstacles_are_refused() -> None:
    with pytest.raises(InputError, match="edge radius"):
        StepEdge(height=0.01, edge_radius=0.02)
    with pytest.raises(InputError, match="height and half the width"):
        Cleat(height=0.02, width=0.01, edge_radius=0.006)
    with pytest.raises(InputError, match="rock radius"):
        HalfRoundRock(radius=0.0)
