"""Claim: on rigid tires the rover stands, rolls and slides as rigid wheels do.

Sources and tolerances:
- Wheel loads against the principal body's centre of mass: statics on rigid wheels, printed to 0.1 N; 0.06 N.
- One wheel through the `Tire` protocol: a load of 197.92 N presses it in by F / k = 24 micrometres, and its force at
  a slip is that of the brush tire under the same load to 1e-9, for both have the same law.
- 70 m/h are 0.1365 rad/s times the radius: speed to 1e-6.
- A braked rover stands on 25 degrees: less than 1 mm a minute.
Negative controls: Table II's tire misses loads, deflection and the creep-free 1e-6 of the speed.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from contracts.terrain import Plane
from contracts.tire import HubMotion, Tire
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_rigid_tires
from rover_dynamics.rover.scenarios.level_ground import SPEED, all_drives
from rover_dynamics.rover.scenarios.offsets import loads_against_offset
from rover_dynamics.rover.scenarios.scenario import Scenario, run_scenario
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from rover_dynamics.tires.brush_wheel import BrushTire
from rover_dynamics.tires.rigid import RigidTire, rigid_parameters

LOAD = 197.92


def miss(tires: str) -> float:
    """Largest difference of the static wheel loads on one kind of tires from the table [N]."""
    rows = [one for one in loads_against_offset(SCENARIOS["static"], read_rover()) if one.quantity.startswith(tires)]
    assert len(rows) == 15
    return max(abs(one.value - one.reference) for one in rows if one.reference is not None)


def speed_error(scenario: Scenario) -> float:
    """Of the mean speed between 15 and 35 s [-]."""
    run = run_scenario(scenario, read_rover())
    return abs(scenario.judge(run)[0].value / SPEED - 1.0)


def steady(tire: Tire, sinks: float, slip: float) -> tuple[float, float]:
    """Load and tractive force of a wheel at 1 m/s, after its bristles have settled [N]."""
    spin = 1.0 / ((1.0 - slip) * 0.1425)
    motion = HubMotion(
        position=np.array([0.0, 0.0, 0.1425 - sinks]),
        rotation=np.eye(3),
        velocity=np.array([1.0, 0.0, 0.0]),
        angular_velocity=np.array([0.0, spin, 0.0]),
    )
    state = tire.initial_state()
    for _ in range(4000):
        state = state + 1e-4 * tire.respond(motion, state, 0.0).state_rate
    output = tire.respond(motion, state, 0.0).output
    return output.normal_load, output.tractive_force


def test_wheel_loads_are_those_of_rigid_wheels() -> None:
    assert miss("rigid") < 0.06
    assert miss("brush") > 1.0  # negative control


@pytest.mark.parametrize("slip", [0.005, 0.02, 0.3])
def test_a_rigid_wheel_has_the_friction_of_its_tire(slip: float) -> None:
    rigid, brush = RigidTire(Plane()), BrushTire(Plane())
    found = steady(rigid, LOAD / rigid_parameters().radial_stiffness, slip)
    soft = steady(brush, LOAD / THESIS_BRUSH.radial_stiffness, slip)
    assert found == pytest.approx((LOAD, soft[1]), rel=1e-9)
    assert soft[0] == pytest.approx(LOAD, rel=1e-9)
    assert steady(rigid, LOAD / THESIS_BRUSH.radial_stiffness, slip)[0] > 100.0 * LOAD  # negative control


def test_a_rigid_wheel_rolls_its_radius() -> None:
    assert speed_error(on_rigid_tires(SCENARIOS["straight"])) < 1e-6
    assert speed_error(SCENARIOS["straight"]) > 1e-5  # negative control


def test_a_braked_rover_on_rigid_tires_stands_on_a_slope() -> None:
    scenario = replace(
        on_rigid_tires(SCENARIOS["slope_up"]),
        settles=5.0,
        lasts=60.0,
        actuators=lambda rover: all_drives(rover, Hold()),
    )
    run = run_scenario(scenario, read_rover())
    assert np.abs(run.place[-1] - run.place[0]).max() < 1e-3
    sliding = replace(scenario, tilt=replace(scenario.tilt, angle=math.radians(45.0)), lasts=1.0)
    assert run_scenario(sliding, read_rover()).place[-1, 0] < -0.1  # negative control
