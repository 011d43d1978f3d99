"""Cells of soil whose undisturbed ground is not level.

Claims: on an inclined plane a wheel feels what it feels on level ground, turned with the plane, whichever way that
rises, and drives as it does there; on waves the load is that of the depth below the waves. References: frame
indifference, and the integral of b k z^n over the rim. Negative control: the load on a crest is not that on level
ground as high as the waves' mean.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from contracts.height_field import HeightField, sampled_terrain
from contracts.terrain import Terrain, inclined_plane
from rover_dynamics.soil.field import SoilBed, ruts_of
from rover_dynamics.soil.lie import footprint_plane, lie_below
from soil.carcass import Carcass
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil
from tests.wheel_on_cells import answer, driven, moving, turned

WHEEL = WheelOnSoil(radius=0.1425, width=0.12)
SOFT = replace(WHEEL, carcass=Carcass(compliance=(0.0, 75e-6, 41e-6, 8e-6), load=198.0))
BED = SoilBed(
    soil=soil_named("ding2011"), wheel=WHEEL, load=198.0, gravity=3.721, low=(-0.4, -0.4), high=(0.4, 0.4), cell=0.0025
)
AMPLITUDE, WAVE = 0.008, 0.3
AXIS = np.linspace(-0.45, 0.45, 181)


def waves() -> Terrain:
    """A crest at x = 0."""
    heights = AMPLITUDE * np.cos(2.0 * math.pi * AXIS / WAVE)[:, None] + 0.0 * AXIS
    return HeightField(heights=heights, spacing=(0.005, 0.005), origin=(-0.45, -0.45))


def risen(slope: float, rises: float) -> np.ndarray:
    return Rotation.from_rotvec(slope * np.array([math.sin(rises), -math.cos(rises), 0.0])).as_matrix()


@pytest.mark.parametrize("rises", [0.0, 0.5 * math.pi, 2.2])
def test_a_drive_over_an_inclined_plane_is_one_over_level_ground(rises: float) -> None:
    """Its memory included: soil that is pressed is not slid over."""
    level = replace(BED, cell=0.01, high=(0.8, 0.4))
    flat = driven(level, 0.15, way=0.3)
    steep = driven(replace(level, terrain=inclined_plane(0.2, rises)), 0.15, way=0.3, turn=risen(0.2, rises))
    late = flat.way > 0.2
    assert steep.pull[late].mean() == pytest.approx(flat.pull[late].mean(), abs=0.3)
    assert steep.torque[late].mean() == pytest.approx(flat.torque[late].mean(), rel=0.01)
    assert steep.height[late].mean() == pytest.approx(flat.height[late].mean(), abs=5e-5)
    assert abs(steep.aside[late].mean()) < 0.2


@pytest.mark.parametrize("wheel", [WHEEL, SOFT], ids=["rigid", "flexible"])
@pytest.mark.parametrize(("slope", "rises"), [(0.2, 0.0), (0.2, 0.5 * math.pi), (0.3, 0.7), (0.3, -2.5)])
def test_an_inclined_plane_is_level_ground_turned(wheel: WheelOnSoil, slope: float, rises: float) -> None:
    level = replace(BED, wheel=wheel)
    height, state = level.standing()
    state[-2:] = 0.2, 1.0
    hub = moving((0.0, 0.0, height), 0.0, 0.2, (0.02, 0.002, 0.0))
    flat = answer(level, level.ground(1), hub, state)
    bed = replace(level, terrain=inclined_plane(slope, rises, 0.05))
    R = risen(slope, rises)
    hub = turned(hub, R)
    found = answer(bed, bed.ground(1), hub._replace(position=hub.position + np.array([0.0, 0.0, 0.05])), state)
    assert R.T @ found.wrench[0, :3] == pytest.approx(flat.wrench[0, :3], abs=0.02)
    assert R.T @ found.wrench[0, 3:] == pytest.approx(flat.wrench[0, 3:], abs=2e-3)
    assert found.output[0, [0, 1, 7, 8]] == pytest.approx(flat.output[0, [0, 1, 7, 8]], abs=0.02)
    assert found.rate[0] == pytest.approx(flat.rate[0], abs=1e-4)


@pytest.mark.parametrize("x", [0.0, 0.5 * WAVE], ids=["crest", "trough"])
def test_on_waves_the_load_is_that_of_the_depth_below_them(x: float) -> None:
    bed, top = replace(BED, terrain=waves()), AMPLITUDE * math.cos(2.0 * math.pi * x / WAVE)
    hub = top + 0.128
    soil, R = bed.soil, WHEEL.radius

    def pressure(s: float) -> float:
        depth = AMPLITUDE * math.cos(2.0 * math.pi * (x + s) / WAVE) - hub + math.sqrt(R * R - s * s)
        return float(soil.modulus(WHEEL.width) * max(depth, 0.0) ** soil.exponent)

    load = WHEEL.width * quad(pressure, -0.12, 0.12, limit=200)[0]
    found = answer(bed, bed.ground(1), moving((x, 0.0, hub), 0.0, 0.0, (0.0, 0.0, 0.0)), np.zeros(4))
    assert found.wrench[0, 2] == pytest.approx(load, rel=0.01)
    level = answer(BED, BED.ground(1), moving((x, 0.0, 0.128), 0.0, 0.0, (0.0, 0.0, 0.0)), np.zeros(4))
    assert abs(level.wrench[0, 2] - load) > 0.03 * load


def test_ruts_lie_below_the_ground_as_it_was() -> None:
    bed = replace(BED, cell=0.01, terrain=inclined_plane(0.1, 0.0, 1.0))
    ground = bed.ground(1)
    assert ground.field.surface.shape == bed.shape
    assert ruts_of(ground.field).surface.size == 0
    ground.field.deepest[20:23, 30:34] = 0.02
    left = ruts_of(ground.field)
    assert left.surface == pytest.approx(1.0 + math.tan(0.1) * left.x[:, None] + 0.0 * left.y, abs=1e-12)
    flat = replace(BED, cell=0.01)
    assert flat.ground(1).field.surface.size == 0
    assert not ruts_of(driven(replace(flat, lag=0.0), 0.1, way=0.05).ground.field).surface.any()


def test_the_plane_that_is_told_is_that_the_cells_know() -> None:
    """On ground that curves, the sinkage is told from the same plane that a wheel stands on."""
    rough = sampled_terrain(
        HeightField(
            heights=0.02 * np.random.default_rng(3).random((37, 37)), spacing=(0.025, 0.025), origin=(-0.45, -0.45)
        ),
        AXIS,
        AXIS,
    )
    bed = replace(BED, terrain=rough)
    place = np.array([0.03, -0.05])
    mean, normal = footprint_plane(rough, place[:1], place[1:], WHEEL.radius)
    up, height, _ = lie_below((*place, 0.2), WHEEL.radius, bed.ground(1).field)
    assert up == pytest.approx(normal[0], abs=1e-4)
    assert height == pytest.approx((0.2 - mean[0]) * normal[0, 2], abs=1e-5)
    x, y = np.meshgrid(place[0] + np.linspace(-0.5, 0.5, 5) * 0.1425, place[1] + np.linspace(-0.5, 0.5, 5) * 0.1425)
    columns = np.column_stack([x.ravel(), y.ravel(), np.ones(25)])
    slopes = np.linalg.lstsq(columns, rough.height(x, y).ravel(), rcond=None)[0]
    assert -normal[0, :2] / normal[0, 2] == pytest.approx(slopes[:2], abs=1e-9)
