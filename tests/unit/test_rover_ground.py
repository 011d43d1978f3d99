"""A scenario on another ground and on rigid tires: where it starts, what is refused, what a field of rocks covers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import Plane, inclined_plane
from contracts.terrain_cover import check_covered
from rover_dynamics.rover.planets import gravity_named
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_rigid_tires, on_terrain, rocks_on_the_way, touching_height
from rover_dynamics.rover.scenarios.scenario import run_scenario
from rover_dynamics.tires.brush_settings import BrushSettings
from rover_dynamics.tires.brush_tire import THESIS_BRUSH

DRIVES = ("straight", "traction", "slope_up", "slope_down", "slope_across", "point_turn")


@pytest.fixture(scope="module")
def design() -> RoverDesign:
    return read_rover()


def bump(place: tuple[float, float]) -> HeightField:
    """Level at 0.3 m with a hump of 0.1 m."""
    x, y = np.meshgrid(np.arange(-2.0, 2.01, 0.02), np.arange(-1.0, 1.01, 0.02), indexing="ij")
    hump = 0.1 * np.exp(-((x - place[0]) ** 2 + (y - place[1]) ** 2) / 0.1**2)
    return HeightField(heights=0.3 + hump, spacing=(0.02, 0.02), origin=(-2.0, -1.0))


def test_the_first_wheel_touches(design: RoverDesign) -> None:
    assert touching_height(Plane(offset=0.7), design) == pytest.approx(0.7, abs=1e-12)
    leg = next(leg for leg in design.legs if leg.name == "front_left")
    assert touching_height(bump(leg.drive[:2]), design) == pytest.approx(0.4, abs=1e-5)
    assert touching_height(bump((0.3, 0.0)), design) == pytest.approx(0.3, abs=1e-3)
    slope = 0.1  # the front wheels' rims touch a slope behind their lowest point: R (1 / cos - 1) and x tan
    front = leg.drive[0] * np.tan(slope) + design.wheel_radius * (1.0 / np.cos(slope) - 1.0)
    assert touching_height(inclined_plane(slope), design) == pytest.approx(front, abs=2e-5)


@pytest.mark.parametrize("name", DRIVES)
def test_rocks_reach_as_far_as_the_wheels(design: RoverDesign, name: str) -> None:
    scenario = SCENARIOS[name]
    rocks, again, other = (rocks_on_the_way(scenario, design, seed) for seed in (1, 1, 2))
    assert scenario.path is not None
    check_covered(rocks, scenario.path(design), design.wheel_radius)
    assert np.array_equal(rocks.pieces().knots, again.pieces().knots)
    assert not np.array_equal(rocks.pieces().knots, other.pieces().knots)


def test_scenarios_with_a_ground_of_their_own_keep_it(design: RoverDesign) -> None:
    for name in set(SCENARIOS) - set(DRIVES):
        with pytest.raises(InputError, match=f"terrain of scenario {name}"):
            on_terrain(SCENARIOS[name], design, Plane(), "a plane")


def test_a_field_too_short_is_refused_before_and_behind_the_start(design: RoverDesign) -> None:
    field = bump((0.0, 0.9))
    on_terrain(SCENARIOS["straight"], design, field, "a field")
    with pytest.raises(InputError, match="inside the terrain"):
        on_terrain(SCENARIOS["traction"], design, field, "a field")
    short = replace(SCENARIOS["traction"], path=SCENARIOS["straight"].path)
    with pytest.raises(InputError, match="lies beside the terrain, which the rover left by t = "):
        run_scenario(on_terrain(short, design, field, "a field"), design)


def test_rigid_tires_change_the_radial_contact_only() -> None:
    before, after = SCENARIOS["traction"], on_rigid_tires(SCENARIOS["traction"])
    assert after.tire_model == "rigid"
    assert on_rigid_tires(after) == after
    assert after.tire.radial_stiffness == 1e3 * THESIS_BRUSH.radial_stiffness
    radial = {"radial_stiffness": 1.0, "radial_damping": 1.0, "source": ""}
    assert replace(after.tire, **radial) == replace(before.tire, **radial)
    assert after.settings.damping_ramp == pytest.approx(5e-6, rel=1e-12)
    assert after.settings.touch_depth == pytest.approx(1e-7, rel=1e-12)
    depths = {"damping_ramp": 0.005, "touch_depth": 1e-4}
    assert replace(after.settings, **depths) == BrushSettings(**depths)


def test_gravity_by_name() -> None:
    assert (gravity_named("mars"), gravity_named("earth")) == (3.711, 9.81)
    with pytest.raises(InputError, match="'moon': is not known; give mars or earth"):
        gravity_named("moon")
