"""The rover's scenarios against statics and closed forms.

Claims and tolerances:
- Wheel loads against the principal body's centre of mass are those of statics on rigid wheels once the tires are a
  hundred times as stiff. Source: statics of the rover computed by an independent code, printed to 0.1 N; 0.06 N is half
  a digit and the 0.01 N by which that code's rover is balanced otherwise. Thesis' tires pitch the rover: up to 1.9 N.
- The damper as printed meets the ground with c sqrt(2 g h), 2 % less at most for what the wheel gives way at once.
- Braked on a slope the loads add up to the weight's share along the normal, and the tractive forces to that along the
  ground; 0.1 % for what 8 s of settling leave.
- A quarter turn on the spot ends within 0.1 degrees.
Negative controls: the thesis' tires miss the first tolerance, and so does a bogie pivot that is 10 mm off.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.brush_settings import BrushSettings, DamperLaw
from rover_dynamics.brush_tire import THESIS_BRUSH, BrushTireParameters
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.level_ground import DROP_HEIGHT, FRAME_X, OFFSETS, all_drives
from rover_dynamics.rover.scenarios.scenario import run_scenario

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
        body = replace(design.bodies[0], position=(FRAME_X + offset, *design.bodies[0].position[1:]))
        moved = replace(design, bodies=(body, *design.bodies[1:]))
        run = run_scenario(replace(SCENARIOS["static"], settles=8.0, lasts=0.1, tire=tire), moved)
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
