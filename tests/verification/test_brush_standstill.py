"""Claim: a wheel that stands on a slope of 25 degrees does not creep, up, down or across, with either slip law.

Source: the mission's requirement of 25 degrees; friction 0.757 > tan 25 degrees = 0.466. A sixth of the rover on Mars
settles for 5 s, then its path over 60 s is measured; tolerance 1 mm (aimed at: 1 mm a minute), and for the brush
1 micrometre, since nothing of its law leaks below the sliding limit. Negative control: with friction 0.45 < tan 25
degrees the same wheel slides, with the acceleration (sin - 0.45 cos) g.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.terrain import inclined_plane
from rover_dynamics.tires.brush_settings import BrushSettings, SlipLaw
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from tests.brush_rig import RADIUS, STIFFNESS, Rig, turned

SLOPE = np.radians(25.0)
MARS = 3.711
MASS = 320.0 / 6.0


def standing(heading: float, law: SlipLaw, friction: float) -> Rig:
    """A wheel with its drive locked, upright on the slope."""
    parameters = replace(THESIS_BRUSH, friction_min=friction, friction_max=friction)
    rotation = turned(camber=SLOPE * np.sin(heading))
    terrain = inclined_plane(SLOPE, heading)
    return Rig(terrain=terrain, parameters=parameters, settings=BrushSettings(slip_law=law), rotation=rotation)


def path(rig: Rig, times: np.ndarray) -> np.ndarray:
    """(n, 3) hub positions; set down near its static deflection."""
    n = np.array(rig.terrain.pieces().rows[0, 1:4])
    start = n * (RADIUS - MASS * MARS * np.cos(SLOPE) / STIFFNESS)
    return rig.run(rig.start(tuple(start)), times)[:, :3]


@pytest.mark.parametrize(
    ("law", "tolerance"), [(SlipLaw.BRUSH, 1e-6), pytest.param(SlipLaw.FIALA, 1e-3, marks=pytest.mark.long)]
)
@pytest.mark.parametrize("heading", [0.0, np.pi, np.pi / 2, np.pi / 4], ids=["up", "down", "across", "aslant"])
def test_a_standing_wheel_does_not_creep(heading: float, law: SlipLaw, tolerance: float) -> None:
    places = path(standing(heading, law, 0.757), np.array([0.0, 5.0, 65.0]))
    assert np.linalg.norm(places[2] - places[1]) < tolerance
    assert np.linalg.norm(places[1] - places[0]) < 0.005  # it stands where it was put, up to its bristles' deflection


@pytest.mark.parametrize("heading", [0.0, np.pi / 2])
def test_negative_control_too_little_friction_slides(heading: float) -> None:
    places = path(standing(heading, SlipLaw.BRUSH, 0.45), np.array([0.0, 5.0, 6.0, 7.0]))
    second_difference = np.linalg.norm(places[3] - 2.0 * places[2] + places[1])
    assert second_difference == pytest.approx(MARS * (np.sin(SLOPE) - 0.45 * np.cos(SLOPE)), rel=1e-3)


def test_a_wheel_pushed_and_let_go_comes_to_rest() -> None:
    rig = Rig(push=(60.0, 30.0, 0.0))
    pushed = rig.run(rig.start((0.0, 0.0, RADIUS - 0.024)), np.array([0.0, 3.0]))[-1]
    rig.push = (0.0, 0.0, 0.0)
    after = rig.run(pushed, np.linspace(0.0, 3.0, 31))
    assert np.linalg.norm(pushed[:2]) > 1e-4
    assert np.linalg.norm(after[-1, 3:6]) < 1e-6
    assert np.linalg.norm(after[-1, :2]) < 1e-6  # elastic: below the sliding limit it returns to where it stood
