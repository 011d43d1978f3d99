"""The rover's scenarios against statics and closed forms.

Claims and tolerances:
- Wheel loads against the principal body's centre of mass are those of statics on rigid wheels once the tires are a
  hundred times as stiff. Source: statics of the rover computed by an independent code, printed to 0.1 N; 0.06 N is half
  a digit and the 0.01 N by which that code's rover is balanced otherwise. Thesis' tires pitch the rover: up to 1.9 N.
- The damper as printed meets the ground with c sqrt(2 g h), 2 % less at most for what the wheel gives way at once.
- From 80 ms on, 7 ms behind first touch, the wheels' loads in a drop are those of one wheel with a sixth of the mass,
  integrated apart: 0.3 %, and 1 % under the damper as printed, whose force jumps to 2.2 kN within a step.
- 3.5 N m on every drive: the mean tractive force of the last 5 s is that of the balances of wheels and rover in closed
  form, 0.05 % for slip (0.02 %) and the uneven loads; one wheel's is that of its own balance to 1e-6.
- Braked on a slope the loads add up to the weight's share along the normal, and the tractive forces to that along the
  ground; 0.1 % for what 8 s of settling leave.
- A quarter turn on the spot ends within 0.1 degrees.
Negative controls: another damper, a wheel without resistance or inertia are told apart; the thesis' tires miss the
first tolerance, and so does a bogie pivot that is 10 mm off.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.closed_forms import drive_force, single_wheel_drop
from rover_dynamics.rover.scenarios.level_ground import DROP_HEIGHT, TORQUE, all_drives
from rover_dynamics.rover.scenarios.offsets import OFFSETS, with_offset
from rover_dynamics.rover.scenarios.scenario import run_scenario
from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters

FloatArray = NDArray[np.float64]
STIFF = replace(
    THESIS_BRUSH,
    radial_stiffness=100.0 * THESIS_BRUSH.radial_stiffness,
    radial_damping=10.0 * THESIS_BRUSH.radial_damping,
)
TOLERANCE = 0.06


def _miss(design: RoverDesign, tire: BrushTireParameters) -> float:
    """Largest difference from the table [N]; wheels free."""
    found = []
    for offset, front, rear in OFFSETS:
        run = run_scenario(replace(SCENARIOS["static"], settles=8.0, lasts=0.1, tire=tire), with_offset(design, offset))
        found.append(np.abs(run.loads[-1] - (front, front, front, front, rear, rear)).max())
    return float(max(found))


def test_wheel_loads_against_the_centre_of_mass_on_stiff_tires() -> None:
    assert _miss(read_rover(), STIFF) < TOLERANCE


def test_negative_control_soft_tires_and_a_misplaced_pivot_miss_the_table() -> None:
    design = read_rover()
    assert TOLERANCE < _miss(design, THESIS_BRUSH) < 1.9
    pivots = tuple(replace(p, position=(p.position[0] + 0.01, *p.position[1:])) for p in design.pivots)
    assert _miss(replace(design, pivots=pivots), STIFF) > 10.0 * TOLERANCE


def test_the_damper_as_printed_meets_the_ground_with_its_constant_times_the_speed() -> None:
    design = read_rover()
    drop = replace(SCENARIOS["drop"], lasts=0.2, settings=BrushSettings(damper_law=DamperLaw.AS_PRINTED))
    peak = run_scenario(drop, design).loads.max()
    touch = THESIS_BRUSH.radial_damping * math.sqrt(2.0 * design.gravity * DROP_HEIGHT)
    assert 0.98 * touch < peak < touch
    gradual = run_scenario(replace(drop, settings=BrushSettings()), design).loads.max()
    assert gradual < 0.5 * touch  # negative control: the other law does not


def _loads_after_touch(settings: BrushSettings) -> tuple[FloatArray, FloatArray]:
    """Times [s] from 80 ms on, and the mean wheel load then [N], of a drop."""
    run = run_scenario(replace(SCENARIOS["drop"], lasts=0.2, every=2e-3, settings=settings), read_rover())
    late = run.motion.times >= 0.08
    return run.motion.times[late], run.loads[late].mean(axis=1)


def _alone(times: FloatArray, settings: BrushSettings) -> FloatArray:
    before = np.concatenate([[0.0], times])
    return single_wheel_drop(read_rover(), DROP_HEIGHT, before, THESIS_BRUSH, settings)[1:]


@pytest.mark.parametrize(("law", "tolerance"), [(DamperLaw.BUILDS_UP, 3e-3), (DamperLaw.AS_PRINTED, 0.01)])
def test_the_rover_drops_like_a_single_wheel_with_its_share_of_the_mass(law: DamperLaw, tolerance: float) -> None:
    settings = BrushSettings(damper_law=law)
    times, loads = _loads_after_touch(settings)
    assert np.abs(loads / _alone(times, settings) - 1.0).max() < tolerance
    for damaged in (replace(settings, damping_ramp=0.006), replace(settings, damper_law=DamperLaw(1 - law))):
        if law is DamperLaw.BUILDS_UP or damaged.damper_law is not law:  # negative control
            assert np.abs(loads / _alone(times, damaged) - 1.0).max() > 0.03


def test_driven_by_a_torque_the_rover_pulls_as_its_momentum_says() -> None:
    design, scenario = read_rover(), SCENARIOS["traction"]
    run = run_scenario(scenario, design)
    force = run.tractive[run.motion.times >= 5.0].mean()
    assert force == pytest.approx(drive_force(design, scenario.tire, TORQUE), rel=5e-4)
    one = scenario.judge(run)[0]
    assert one.value == pytest.approx(one.reference, rel=1e-6)
    smooth = replace(scenario.tire, rolling_resistance=0.0)  # negative controls: no resistance, wheels without inertia
    assert drive_force(design, smooth, TORQUE) > 1.05 * force
    light = tuple(replace(body, inertia=(0.06, 1e-9, 0.06)) for body in design.leg_bodies)
    assert drive_force(replace(design, leg_bodies=light), scenario.tire, TORQUE) > 1.05 * force


@pytest.mark.parametrize(("name", "forwards"), [("slope_up", 1.0), ("slope_down", -1.0), ("slope_across", 0.0)])
def test_a_braked_rover_on_a_slope_is_in_balance(name: str, forwards: float) -> None:
    design = read_rover()
    braked = replace(
        SCENARIOS[name], settles=8.0, lasts=0.1, actuators=lambda rover: all_drives(rover, Hold()), study=None
    )
    run = run_scenario(braked, design)
    weight, angle = design.mass * design.gravity, math.radians(25.0)
    assert run.loads[-1].sum() == pytest.approx(weight * math.cos(angle), rel=1e-3)
    along = run.motion.wrenches[-1, :, :2].sum(axis=0)
    across = 1.0 if name == "slope_across" else 0.0
    assert along == pytest.approx(weight * math.sin(angle) * np.array([forwards, across]), abs=1e-3 * weight)


def test_a_quarter_turn_on_the_spot_ends_where_its_wheels_roll() -> None:
    scenario = SCENARIOS["point_turn"]
    run = run_scenario(scenario, read_rover())
    turned = next(outcome for outcome in scenario.judge(run) if outcome.quantity == "angle turned")
    assert turned.value == pytest.approx(90.0, abs=0.1)
