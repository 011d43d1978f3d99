"""The rover's scenarios as records, and how their outcomes are read; every motion here is short."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

from contracts.errors import ConvergenceError, InputError
from contracts.terrain_ridges import Crevasse, Step
from rover_dynamics.multibody.motion_law import SpeedTrapezoid
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS, scenario_named
from rover_dynamics.rover.scenarios.level_ground import SPEED, drive_forward
from rover_dynamics.rover.scenarios.obstacles import wheels_passed
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.point_turn import tangents, turn_actuators
from rover_dynamics.rover.scenarios.scenario import Tilt, run_scenario
from rover_dynamics.rover.scenarios.scenario_series import scenario_series
from rover_dynamics.rover.scenarios.slopes import largest_passed, velocity_loss
from rover_dynamics.rover.scenarios.stability import overturned, smallest_tilt


@pytest.fixture(scope="module")
def design() -> RoverDesign:
    return read_rover()


def test_every_scenario_builds_its_vehicle_at_increasing_times(design: RoverDesign) -> None:
    for name, scenario in SCENARIOS.items():
        assert scenario.name == name
        assert np.all(np.diff(scenario.times()) > 0.0), name
        assert scenario.times()[0] == -scenario.settles
        vehicle = scenario.vehicle(design)
        assert np.linalg.norm(vehicle.model.gravity) == pytest.approx(design.gravity, rel=1e-14)
        assert len(vehicle.wheels) == 6
    with pytest.raises(FrozenInstanceError):
        SCENARIOS["drop"].lasts = 1.0  # type: ignore[misc]


def test_an_unknown_scenario_or_a_duration_of_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="'fly': is not known; give one of static, drop"):
        scenario_named("fly")
    with pytest.raises(InputError, match="duration of scenario drop"):
        replace(SCENARIOS["drop"], lasts=0.0)
    with pytest.raises(InputError, match="settling of scenario drop"):
        replace(SCENARIOS["drop"], settles=-1.0)


@pytest.mark.parametrize(
    ("at_least", "value", "margin", "met"),
    [(True, 3.0, 1.0, True), (True, 1.0, -1.0, False), (False, 3.0, -1.0, False)],
)
def test_margins_are_counted_on_the_good_side(at_least: bool, value: float, margin: float, met: bool) -> None:
    outcome = Outcome(quantity="x", value=value, unit="m", limit=2.0, at_least=at_least)
    assert (outcome.margin, outcome.met) == (margin, met)
    free = Outcome(quantity="x", value=value, unit="m")
    assert (free.margin, free.met) == (None, None)
    with pytest.raises(InputError, match="must be finite"):
        replace(outcome, value=math.nan)


def test_tilted_gravity_pulls_towards_its_heading() -> None:
    tilt = Tilt(angle=math.radians(25.0), heading=math.pi)
    assert tilt.gravity(3.711) == pytest.approx((-3.711 * math.sin(tilt.angle), 0.0, -3.711 * math.cos(tilt.angle)))


def test_the_straight_path_asks_for_the_thesis_distance(design: RoverDesign) -> None:
    law = drive_forward(design, ends=40.0).laws["drive_front_left"]
    assert isinstance(law, SpeedTrapezoid)
    assert law.at(-5.0)[1] == 0.0
    assert law.at(20.0)[1] * design.wheel_radius == pytest.approx(70.0 / 3600.0, rel=1e-12)
    assert law.at(40.0)[0] * design.wheel_radius == pytest.approx(35.0 * SPEED, rel=1e-12)


def test_steered_wheels_roll_along_the_tangents(design: RoverDesign) -> None:
    x_c = np.mean([leg.drive[0] for leg in design.legs])
    for leg in design.legs:
        angle, distance = tangents(design)[leg.name]
        rolling = distance * np.array([math.cos(angle), math.sin(angle)])
        assert rolling == pytest.approx([-leg.drive[1], leg.drive[0] - x_c], abs=1e-12)
        assert abs(angle) < 0.5 * math.pi
    assert len(turn_actuators(design).laws) == 12


def test_a_wheel_at_the_centre_of_the_turn_is_refused(design: RoverDesign) -> None:
    legs = tuple(replace(leg, drive=(leg.drive[0], 0.0, 0.0)) for leg in design.legs)
    legs = (*legs[:2], replace(legs[2], drive=(0.0, 0.0, 0.0)), replace(legs[3], drive=(-0.16, 0.0, 0.0)), *legs[4:])
    with pytest.raises(InputError, match="cannot turn on the spot"):
        tangents(replace(design, legs=legs))


def test_bisections_find_a_known_edge(design: RoverDesign) -> None:
    assert 0.29 < largest_passed(lambda x: x < 0.3, 0.0, 1.0, 0.01) < 0.3
    assert largest_passed(lambda x: x < 2.0, 0.0, 1.0, 0.01) == 1.0

    def fails(_: object, __: RoverDesign, tilt: float, heading: float) -> bool:
        return tilt > 50.0 - 10.0 * (heading == 135.0)

    tilt, heading = smallest_tilt(SCENARIOS["stability"], design, fails)
    assert heading == 135.0
    assert 39.75 <= tilt <= 40.0


def test_equilibrium_carries_the_weight_and_its_series_says_so(design: RoverDesign) -> None:
    run = run_scenario(replace(SCENARIOS["static"], lasts=0.5), design)
    assert run.motion.times[0] == 0.0
    assert run.loads[-1].sum() == pytest.approx(design.mass * design.gravity, rel=1e-4)
    assert design.static_load == pytest.approx(197.92, abs=0.005)
    series = scenario_series(run)
    assert series["front_right_load_N"][-1] == run.loads[-1, 1]
    assert not series.partial


def test_a_motion_whose_numbers_overflow_is_one_message(design: RoverDesign, monkeypatch: pytest.MonkeyPatch) -> None:
    def overflow(*_: object) -> None:
        raise np.linalg.LinAlgError("Array must not contain infs or NaNs.")

    monkeypatch.setattr("rover_dynamics.rover.scenarios.scenario.drive_vehicle", overflow)
    with pytest.raises(ConvergenceError, match="scenario drop cannot be followed"):
        run_scenario(SCENARIOS["drop"], design)
    assert overturned(SCENARIOS["stability"], design, 40.0, 0.0)


def test_nothing_falls_at_the_start(design: RoverDesign) -> None:
    for name in ("straight", "slope_up", "slope_across", "stability"):
        scenario = replace(SCENARIOS[name], settles=0.0, lasts=0.02, every=0.01)
        run = run_scenario(scenario, design)
        normal = design.static_load * math.cos(scenario.tilt.angle)
        assert run.loads[0] == pytest.approx(np.full(6, normal), rel=1e-6), name


def test_a_slope_too_steep_for_the_friction_is_not_driven(design: RoverDesign) -> None:
    """Negative control: 45 degrees are more than atan 0.757 = 37 degrees; 5 degrees are driven."""
    scenario = replace(SCENARIOS["slope_up"], lasts=12.0, every=0.5)
    gentle = run_scenario(replace(scenario, tilt=Tilt(angle=math.radians(5.0), heading=math.pi)), design)
    assert gentle.met
    steep = run_scenario(replace(scenario, tilt=Tilt(angle=math.radians(45.0), heading=math.pi)), design)
    assert not steep.met
    assert velocity_loss(steep) > 1.0


@pytest.mark.parametrize("name", ["step", "crevasse"])
def test_a_rover_before_an_obstacle_has_not_passed_it(design: RoverDesign, name: str) -> None:
    terrain = SCENARIOS[name].terrain(design)
    assert isinstance(terrain, Step | Crevasse)
    assert terrain.position > max(leg.drive[0] for leg in design.legs) + design.wheel_radius
    run = run_scenario(replace(SCENARIOS[name], settles=0.0, lasts=0.1), design)
    assert wheels_passed(run, 0.0) == 0
