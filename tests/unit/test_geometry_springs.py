"""Centrelines: where springs begin and end, how they are directed there, how long they are."""

from __future__ import annotations

import math

import numpy as np
import pytest

from geometry.parts import SpringSet
from geometry.springs import Leg, leg_sides, polar, spring_leg, station_angles, weld_angle

GAP = (0.050, 0.1419)
BANDS = ((-0.02, 0.02),)
ARC = SpringSet(name="s", count=3, bands=BANDS, thickness=6e-4, shape="arc", weld_length=8e-3, phase=0.3)
SPLINE = SpringSet(
    name="s",
    count=3,
    bands=BANDS,
    thickness=6e-4,
    shape="spline",
    weld_length=8e-3,
    points=((0.3, 0.55), (0.7, 0.6)),
)


def ends(leg: Leg) -> np.ndarray:
    return np.linalg.norm(leg.points[[0, -1]], axis=1)


@pytest.mark.parametrize("springs", [ARC, SPLINE], ids=["arc", "spline"])
@pytest.mark.parametrize("side", [1, -1])
def test_strip_is_tangential_at_both_rings(springs: SpringSet, side: int) -> None:
    leg = spring_leg(springs, GAP, 0.3, side)
    ray = 0.3 + side * 0.5 * weld_angle(springs, GAP[1])
    assert ends(leg) == pytest.approx([GAP[1] - 3e-4, GAP[0] + 3e-4], rel=1e-12)
    assert leg.points[0] == pytest.approx(polar(GAP[1] - 3e-4, ray), abs=1e-12)
    assert leg.normals[0] == pytest.approx(polar(1.0, ray), abs=1e-12)
    assert leg.normals[-1] == pytest.approx(-polar(1.0, ray), abs=1e-12)
    away = leg.points[1] - leg.points[0]
    assert side * (away @ [math.cos(ray), math.sin(ray)]) > 0.0


def test_arc_is_a_semicircle() -> None:
    leg = spring_leg(ARC, GAP, 0.0, 1)
    radius = 0.5 * (GAP[1] - GAP[0] - 6e-4)
    assert leg.centre is not None
    assert np.linalg.norm(leg.points - leg.centre, axis=1) == pytest.approx(radius, rel=1e-12)
    assert leg.length == pytest.approx(math.pi * radius, rel=1e-12)


def test_spline_passes_through_its_points_at_equal_steps() -> None:
    leg = spring_leg(SPLINE, GAP, 0.0, 1)
    ray = 0.5 * weld_angle(SPLINE, GAP[1])
    high, low = GAP[1] - 3e-4, GAP[0] + 3e-4
    for fraction, angle in SPLINE.points:
        point = polar(high + fraction * (low - high), ray + angle)
        spacing = leg.length / (len(leg.points) - 1)
        assert np.linalg.norm(leg.points - point, axis=1).min() < 0.5001 * spacing
    steps = np.linalg.norm(np.diff(leg.points, axis=0), axis=1)
    assert steps.sum() == pytest.approx(leg.length, rel=1e-3)
    assert steps.max() / steps.min() < 1.01


def test_spline_length_converges_on_that_of_a_semicircle() -> None:
    """A clamped cubic spline through many points of the semicircle has its length."""
    arc = spring_leg(ARC, GAP, 0.0, 1)
    ray = 0.5 * weld_angle(ARC, GAP[1])
    inner = arc.points[2:-2:2]
    radius, phi = np.linalg.norm(inner, axis=1), np.arctan2(inner[:, 0], -inner[:, 1])
    high, low = GAP[1] - 3e-4, GAP[0] + 3e-4
    points = tuple((float((high - r) / (high - low)), float(p - ray)) for r, p in zip(radius, phi, strict=True))
    spline = SpringSet(name="s", count=1, bands=BANDS, thickness=6e-4, shape="spline", weld_length=8e-3, points=points)
    assert spring_leg(spline, GAP, 0.0, 1).length == pytest.approx(arc.length, rel=1e-5)


def test_stations_and_sides() -> None:
    assert station_angles(ARC) == pytest.approx([0.3, 0.3 + 2 * math.pi / 3, 0.3 + 4 * math.pi / 3])
    assert leg_sides(ARC) == (1,)
    hoop = SpringSet(name="h", count=3, bands=BANDS, thickness=6e-4, shape="hoop", weld_length=8e-3)
    assert leg_sides(hoop) == (1, -1)


def test_a_strip_is_kept_and_cannot_be_written() -> None:
    leg = spring_leg(SPLINE, GAP, 0.0, 1)
    assert spring_leg(SPLINE, GAP, 0.0, 1) is leg
    for array in (leg.points, leg.normals):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0
