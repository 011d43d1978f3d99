"""The rover set down on soil that is not level.

Claims: every wheel stands as deep as one at rest, on a plane and on ground that rises and falls below each wheel by
itself; joints stay together; heading and place stay. Negative control: a rover that is only leant leaves wheels in the
air.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.height_field import HeightField
from contracts.terrain import Terrain, inclined_plane
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.rover.rover import build_rover, wheel_names
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.set_down import set_down
from rover_dynamics.soil.field import SoilBed
from rover_dynamics.soil.lie import footprint_plane
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil


@pytest.fixture(scope="module")
def design() -> RoverDesign:
    return read_rover()


def hills() -> Terrain:
    x = np.arange(-2.0, 2.01, 0.1)
    heights = 0.08 * np.sin(2.1 * x)[:, None] * np.cos(1.7 * x + 0.4) + 0.05 * x
    return HeightField(heights=heights, spacing=(0.1, 0.1), origin=(-2.0, -2.0))


def lacking(model: MultibodyModel, design: RoverDesign, bed: SoilBed) -> np.ndarray:
    hubs = np.array([body.position for body in model.bodies if body.name in wheel_names(design)])
    ground, normals = footprint_plane(bed.terrain, hubs[:, 0], hubs[:, 1], design.wheel_radius)
    return np.asarray(bed.standing()[0] - (hubs[:, 2] - ground) * normals[:, 2])


@pytest.mark.parametrize("terrain", [inclined_plane(0.2, 0.0), inclined_plane(0.15, 2.0, 0.3), hills()])
def test_all_wheels_stand_equally_deep(design: RoverDesign, terrain: Terrain) -> None:
    wheel = WheelOnSoil(radius=design.wheel_radius, width=design.wheel_width)
    bed = SoilBed(
        soil=soil_named("ding2011"),
        wheel=wheel,
        load=design.static_load,
        gravity=design.gravity,
        low=(-2.0, -2.0),
        high=(2.0, 2.0),
        terrain=terrain,
    )
    level = build_rover(design, height=bed.standing()[0] - design.wheel_radius).model
    model = set_down(level, design, bed)
    assert np.abs(lacking(model, design, bed)).max() < 1e-6
    bodies = {body.name: body for body in model.bodies}
    for joint in model.joints:
        ends = [
            bodies[name].position + bodies[name].rotation @ frame.position
            for name, frame in ((joint.first, joint.first_frame), (joint.second, joint.second_frame))
        ]
        axes = [
            bodies[name].rotation @ frame.rotation[:, 2]
            for name, frame in ((joint.first, joint.first_frame), (joint.second, joint.second_frame))
        ]
        assert ends[0] == pytest.approx(ends[1], abs=1e-12), joint.name
        assert axes[0] == pytest.approx(axes[1], abs=1e-12), joint.name
    ahead = model.bodies[0].rotation[:, 0]
    assert abs(np.arctan2(ahead[1], ahead[0])) < 0.05
    assert np.hypot(*model.bodies[0].position[:2]) < 0.25
    if isinstance(terrain, HeightField):
        flat = replace(design, pivots=())
        assert np.ptp(lacking(set_down(level, flat, bed), design, bed)) > 0.01
