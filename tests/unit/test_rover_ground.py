"""A scenario on another ground and on rigid tires: where it starts, what is refused, what a field of rocks covers."""

from __future__ import annotations

import math
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
from rover_dynamics.rover.scenarios.ground import (
    on_brush_tires,
    on_friction,
    on_rigid_tires,
    on_terrain,
    on_wheel_curves,
    rocks_on_the_way,
    touching_height,
)
from rover_dynamics.rover.scenarios.scenario import Tilt, run_scenario
from rover_dynamics.tires.brush_settings import BrushSettings, Carcass, wheel_numbers
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from rover_dynamics.tires.wheel_potential import load_and_slope, wheel_potential
from tests.unit.test_wheel_potential import GROUSERS, PERIOD, curves

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


def test_rigid_is_as_rigid_whatever_the_tire_is() -> None:
    """On a softer one it would pitch the rover by more than statics on rigid wheels, to which it is held, allow."""
    soft, hard = (replace(THESIS_BRUSH, radial_stiffness=k) for k in (800.0, 1e9))
    assert on_rigid_tires(on_brush_tires(SCENARIOS["static"], soft)).tire.radial_stiffness == 8.25e6
    assert on_rigid_tires(on_brush_tires(SCENARIOS["static"], hard)).tire.radial_stiffness == 1e9


@pytest.mark.parametrize("rigid", [False, True])
def test_friction_of_the_ground_is_that_of_every_tire(design: RoverDesign, rigid: bool) -> None:
    """It replaces what a scenario asks for and is said; the static stability is asked of a rover that holds fast."""
    found = {name: on_friction(SCENARIOS[name], 0.3) for name in ("straight", "traction", "stability")}
    driven = {name: (on_rigid_tires(one) if rigid else one).vehicle(design).tire for name, one in found.items()}
    frictions = {name: (tire.friction_min, tire.friction_max) for name, tire in driven.items()}
    assert frictions == {"straight": (0.3, 0.3), "traction": (0.3, 0.3), "stability": (10.0, 10.0)}
    assert found["straight"].title.endswith("to stop, friction 0.3")
    assert found["traction"].title.endswith("of settling, friction 0.3")
    assert on_friction(SCENARIOS["traction"], None) == SCENARIOS["traction"]
    own = SCENARIOS["straight"].vehicle(design).tire
    assert own == THESIS_BRUSH


def test_a_tire_that_sinks_in_beyond_its_hub_is_refused(design: RoverDesign) -> None:
    soft = on_brush_tires(SCENARIOS["static"], replace(THESIS_BRUSH, radial_stiffness=1000.0))
    with pytest.raises(
        InputError, match=r"brush tires = 197\.9 mm: at rest must be below the wheel's radius, 142\.5 mm"
    ):
        run_scenario(soft, design)


def test_wheels_that_spin_are_held_against_the_rovers_momentum(design: RoverDesign) -> None:
    """The closed form is that of wheels that roll: of 16 N, which the ground bears, it would be 20 N."""
    run = run_scenario(on_friction(SCENARIOS["traction"], 0.08), design)
    wheel, mean, share, _ = SCENARIOS["traction"].judge(run)
    assert mean.value == pytest.approx(mean.reference, rel=5e-4)
    assert wheel.value == pytest.approx(wheel.reference, rel=1e-4)
    assert mean.value == pytest.approx(0.08 * design.static_load, rel=1e-3)
    assert share.value == pytest.approx(0.08, rel=1e-6)


def test_gravity_by_name() -> None:
    assert (gravity_named("mars"), gravity_named("earth")) == (3.711, 9.81)
    with pytest.raises(InputError, match="'moon': is not known; give mars or earth"):
        gravity_named("moon")


def test_on_its_own_wheels_the_rover_stands_on_their_curves(design: RoverDesign) -> None:
    """Drives held: every wheel still stands on position 0. Curves too short for its weight end it in words."""
    wheel = wheel_potential(curves(GROUSERS), PERIOD, GROUSERS)
    run = run_scenario(on_wheel_curves(SCENARIOS["drop"], wheel, "made up"), design)
    assert (run.stopped, run.scenario.tire_model) == (None, "fe")
    approach = run.deflections[-1] - (GROUSERS.radius + GROUSERS.height) * np.cos(GROUSERS.phase - GROUSERS.half)
    approach += GROUSERS.radius
    found = [load_and_slope(wheel, float(one), 0.0)[1] for one in approach]
    np.testing.assert_allclose(run.loads[-1], found, rtol=2e-3)
    short = [replace(one, deflection=0.4 * one.deflection, load=0.4 * one.load) for one in curves(GROUSERS)]
    shallow = on_wheel_curves(SCENARIOS["drop"], wheel_potential(short, PERIOD, GROUSERS), "made up")
    stopped = run_scenario(shallow, design).stopped
    assert stopped is not None
    assert "N: its curves end at 14.2 mm of the rim, 3 mm more on a grouser" in stopped


def test_its_own_wheels_yield_along_the_ground_as_their_carcass_does(design: RoverDesign) -> None:
    """Held on a slope of 5 degrees it swings about what friction has to hold, m g sin 5 deg, at some 1.2 Hz."""
    wheel = wheel_potential(curves(GROUSERS), PERIOD, GROUSERS)
    carcass = Carcass(forward=3e3, sideways=12e3)
    scenario = on_wheel_curves(SCENARIOS["drop"], wheel, "made up", carcass, "ancf_wheel")
    assert scenario.tire_model == "ancf_wheel"
    numbers = wheel_numbers(scenario.tire, scenario.settings)
    assert (numbers.tangential_stiffness, numbers.lateral_ratio) == (pytest.approx(3e3), pytest.approx(4.0))
    assert numbers.tangential_stiffness * numbers.relaxation_x == pytest.approx(8250.0)
    assert 12e3 * numbers.relaxation_y == pytest.approx(scenario.tire.cornering_stiffness)
    run = run_scenario(replace(scenario, tilt=Tilt(angle=math.radians(5.0), heading=math.pi)), design)
    assert run.stopped is None
    held, pulled = run.loads.sum(axis=1), run.tractive.sum(axis=1)
    period = 2.0 * math.pi * math.sqrt(held.mean() / 3.711 / (6.0 * carcass.forward))
    last = run.motion.times > run.motion.times[-1] - period
    assert run.motion.times[0] < run.motion.times[-1] - period
    assert pulled[last].mean() == pytest.approx(held[last].mean() * math.tan(math.radians(5.0)), rel=0.05)
