"""The lever of the tractive force: the wheel's radius or the loaded one, and nothing else of the tire changes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.terrain import Plane
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.closed_forms import drive_force
from rover_dynamics.tires.brush_force import BrushResult, HubMotions
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from rover_dynamics.tires.brush_wheel import BrushWheels
from workbench.study.brush_tire import brush_from, brush_values

RADIUS, DEFLECTION = 0.1425, 0.02
LOADED = replace(THESIS_BRUSH, lever="loaded")


def answer(tire: Any) -> BrushResult:
    """Of a wheel that stands pressed in by 20 mm on bristles bent forward."""
    hub, still = np.array([[0.0, 0.0, RADIUS - DEFLECTION]]), np.zeros((1, 3))
    motions = HubMotions(hub, np.eye(3)[None], still, still)
    return BrushWheels(Plane(), 1, tire).forces(motions, np.array([[2e-4, 0.0]]))


@pytest.mark.parametrize(("tire", "lever"), [(THESIS_BRUSH, RADIUS), (LOADED, RADIUS - DEFLECTION)])
def test_the_moment_about_the_axle_is_the_force_times_the_lever(tire: Any, lever: float) -> None:
    wrench = answer(tire).wrench[0]
    assert wrench[0] > 40.0
    assert wrench[4] == pytest.approx(-lever * wrench[0], rel=1e-12)
    assert tire.lever_at(RADIUS, DEFLECTION) == pytest.approx(lever, rel=1e-15)


def test_only_that_moment_differs() -> None:
    ours, other = answer(THESIS_BRUSH), answer(LOADED)
    np.testing.assert_array_equal(np.delete(ours.wrench, 4, axis=1), np.delete(other.wrench, 4, axis=1))
    np.testing.assert_array_equal(ours.rate, other.rate)
    np.testing.assert_array_equal(ours.output, other.output)


def test_another_lever_is_refused() -> None:
    with pytest.raises(InputError, match=r"brush lever.*'half'.*\"radius\" or \"loaded\""):
        replace(THESIS_BRUSH, lever="half")


def test_a_shorter_lever_pulls_more_by_the_same_torque() -> None:
    """By the closed form with the deflection at rest, 24 mm of 142.5, less what speeds the wheels up."""
    design = read_rover()
    more = drive_force(design, LOADED, 3.5) / drive_force(design, THESIS_BRUSH, 3.5)
    assert more == pytest.approx(RADIUS / (RADIUS - design.static_load / 8250.0), rel=0.02)
    assert more > 1.15


def test_tasks_are_given_the_lever_only_where_it_is_not_the_usual_one() -> None:
    """What was kept before there was a choice still holds."""
    assert "lever" not in brush_values(THESIS_BRUSH)
    assert brush_from(brush_values(LOADED)) == replace(LOADED, source="the study")
