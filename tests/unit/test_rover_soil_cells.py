"""Cells of soil under a wheel.

Claims: cells remember: a second pass sinks little more, what is left shears anew, what comes back does so along its
line; edges press the share of a cell they cover; a wheel feels the same towards every heading; derivatives are those of
the forces; a step that is tried leaves no trace. Sources: the equations of rover_dynamics/soil/cells.py and
docs/theory/soil.md. Negative controls: without memory the second pass would sink as far as the first.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.soil.cells import keep_step, soil_derivatives, soil_forces
from rover_dynamics.soil.field import SoilBed, ruts_of
from rover_dynamics.tires.brush_force import BESIDE, empty_result
from soil.carcass import Carcass
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil, standing_wheel
from tests.wheel_on_cells import SPEED, answer, driven, moving

WHEEL = WheelOnSoil(radius=0.1425, width=0.12)
SOFT = replace(WHEEL, carcass=Carcass(compliance=(0.0, 75e-6, 41e-6, 8e-6), load=198.0))
BED = SoilBed(
    soil=soil_named("ding2011"), wheel=WHEEL, load=198.0, gravity=3.721, low=(-0.3, -0.3), high=(0.8, 0.3), lag=0.0
)
ROLLS = SPEED / 0.1425


def at_rest(height: float, x: float = 0.0, y: float = 0.0) -> tuple[float, float, float]:
    return x, y, height


def test_a_standing_wheel_carries_its_load() -> None:
    fine = replace(BED, cell=0.0025)
    height, state = fine.standing()
    found = answer(fine, fine.ground(1), moving(at_rest(height), 0.0, 0.0, (0.0, 0.0, 0.0)), state)
    assert found.wrench[0, 2] == pytest.approx(198.0, rel=2e-3)
    assert np.abs(found.wrench[0, [0, 1, 3, 4, 5]]).max() < 1e-6
    assert standing_wheel(WHEEL, fine.soil, 198.0).hub_height == pytest.approx(height, abs=1e-12)
    flexible = replace(fine, wheel=SOFT)
    height, state = flexible.standing()
    found = answer(flexible, flexible.ground(1), moving(at_rest(height), 0.0, 0.0, (0.0, 0.0, 0.0)), state)
    assert found.wrench[0, 2] == pytest.approx(198.0, rel=2e-3)
    assert found.output[0, 0] > 0.02
    assert np.abs(found.rate[0]).max() * flexible.settling < 1e-4 * found.output[0, 0] + 2e-5


def test_a_second_pass_sinks_little_more() -> None:
    first = driven(BED, 0.1)
    second = driven(BED, 0.1, ground=first.ground)
    late = (first.way > 0.15) & (first.way < 0.25)  # behind where the first one ended
    sunk = [0.1425 - float(one.height[late].mean()) for one in (first, second)]
    assert sunk[0] < sunk[1] < 1.25 * sunk[0]
    assert second.pull[late].mean() > first.pull[late].mean()  # less of the soil is left to be pressed
    ruts = ruts_of(first.ground.field)
    across = (ruts.deepest > 0.0).any(axis=0)
    middle = ruts.depth[np.abs(ruts.x - 0.1) < 0.03][:, across]
    assert 0.7 * sunk[0] < middle.mean() < sunk[0]
    assert ruts.y[across].min() > -0.0601
    assert across.sum() == 12
    assert min(ruts.y[across].min() - ruts.y[0], ruts.y[-1] - ruts.y[across].max()) > 0.2


def test_a_step_that_is_tried_leaves_no_trace() -> None:
    ground = driven(BED, 0.2, way=0.1).ground
    before = [np.array(one, copy=True) for one in ground.field[3:]]
    ground.field.clock[0] = 0.05
    answer(BED, ground, moving(at_rest(0.11, 0.12), 0.0, ROLLS, (SPEED, 0.0, 0.0)), np.array([0.0, 0.0, 0.2, 1.0]))
    ground.field.clock[0] = before[-1][0]
    assert all(np.array_equal(a, b) for a, b in zip(before, ground.field[3:], strict=True))


def test_soil_comes_back_along_its_line_from_its_largest_pressure() -> None:
    ground = BED.ground(1)
    state = np.zeros((1, 4))
    found = empty_result(1, 4)
    ground.field.clock[0] = 0.1
    pressed = moving(at_rest(0.125), 0.0, 0.0, (0.0, 0.0, 0.0))
    keep_step(pressed, state, ground, found)
    most = found.wrench[0, 2]
    deepest = float(ground.field.deepest.max())
    soil = BED.soil
    pressure, slope = soil.modulus(0.12) * deepest**soil.exponent, soil.unloading_growth * deepest
    assert deepest == pytest.approx(0.0175, abs=1e-4)
    assert deepest - ground.field.carries_from.max() == pytest.approx(pressure / slope, rel=1e-9)
    again = [
        answer(BED, ground, moving(at_rest(h), 0.0, 0.0, (0.0,) * 3), state[0]).wrench[0, 2] for h in (0.125, 0.1255)
    ]
    assert again[0] == pytest.approx(most, rel=1e-3)  # cells at the ends are covered in part
    assert again[1] < 0.9 * most
    assert answer(BED, ground, moving(at_rest(0.131), 0.0, 0.0, (0.0,) * 3), state[0]).wrench[0, 2] == 0.0


def test_what_a_wheel_has_left_shears_anew() -> None:
    first = driven(BED, 0.3, way=0.2)
    sheared = np.abs(first.ground.field.ahead).max()
    second = driven(BED, 0.3, way=0.02, ground=first.ground)
    field = second.ground.field
    last = int(field.clock[1]) % 2
    under = np.abs(field.ahead[last][field.touched[last] == field.clock[1]])
    assert 0.0 < under.max() < 0.5 * sheared


def test_edges_press_the_share_of_a_cell_that_they_cover() -> None:
    loads = []
    for y in np.linspace(0.0, 0.01, 6):
        hub = moving(at_rest(0.127, 0.0, float(y)), 0.0, 0.0, (0.0, 0.0, 0.0))
        loads.append(answer(BED, BED.ground(1), hub, np.zeros(4)).wrench[0, 2])
    assert np.ptp(loads) < 1e-9 * loads[0]


@pytest.mark.parametrize(("lean", "bent"), [(0.0, 0.0), (0.25, 0.0), (-0.25, 0.0), (0.0, 0.012)])
@pytest.mark.parametrize("height", [0.141, 0.125, 0.1])
def test_every_cell_below_the_rim_is_pressed(height: float, lean: float, bent: float) -> None:
    """Of cells that are left out before the rim over them is looked for, none lies below its tangent."""
    coarse = replace(BED, wheel=SOFT if bent else WHEEL, cell=0.02)
    ground, yaw, radius = coarse.ground(1), 0.4, WHEEL.radius
    c, s = math.cos(yaw), math.sin(yaw)
    upright = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    leaning = np.array([[1.0, 0, 0], [0, math.cos(lean), -math.sin(lean)], [0, math.sin(lean), math.cos(lean)]])
    height -= 0.7 * bent
    hub = moving(at_rest(height, 0.013, 0.004), yaw, 0.0, (0.0, 0.0, 0.0))
    hub.rotation[0] = upright @ leaning
    state = np.zeros((1, ground.states))
    count = ground.states // 2 - 1
    if bent:
        state[0, 1:3] = bent, -0.3 * bent
    keep_step(hub, state, ground, empty_result(1, ground.states))
    e, ahead, missed = hub.rotation[0][:, 1], upright[:, 0], []
    down, left, found = np.cross(e, ahead), upright[:, 1], 0
    angles = np.linspace(-1.19, 1.19, 4761)
    k = np.arange(count)[:, None]
    rho = radius - state[0, :count] @ np.cos(k * angles)
    for i, j in np.ndindex(ground.field.deepest.shape):
        x, y = ground.field.x + i * 0.02 - 0.013, ground.field.y + j * 0.02 - 0.004
        ways = rho * np.sin(angles) - (x * ahead[0] + y * ahead[1])
        m = int(np.argmin(np.abs(ways)))
        if abs(ways[m]) > 1e-3:
            continue
        depth = rho[m] * math.cos(angles[m])
        across = (x * left[0] + y * left[1] - depth * (down @ left)) / (e @ left)
        along = np.gradient(rho * np.cos(angles), rho * np.sin(angles))[m]
        below = -height - depth * down[2] - across * e[2] + abs(along) * 0.02 / 3.0
        if below > 2e-4 and abs(across) < 0.5 * WHEEL.width + 0.009:
            found += 1
            missed += [] if ground.field.touched[1, i, j] == 1 else [(i, j)]
    assert found > (5 if height < 0.14 else 0)
    assert not missed


@pytest.mark.parametrize("heading", [0.3, math.pi / 2.0, 2.5])
def test_every_heading_is_alike(heading: float) -> None:
    fine = replace(BED, low=(-0.4, -0.4), high=(0.5, 0.5))
    straight, turned = (driven(fine, 0.2, way=0.2, heading=one) for one in (0.0, heading))
    late = straight.way > 0.15
    for name, within in (("pull", 1.5), ("torque", 0.12), ("height", 2e-4)):
        a, b = (float(getattr(one, name)[late].mean()) for one in (straight, turned))
        assert a == pytest.approx(b, abs=within), name
    assert abs(turned.aside[late].mean()) < 1.0


def test_a_wheel_that_drifts_is_held_back_sideways() -> None:
    left = driven(BED, 0.1, drift=0.2)
    right = driven(BED, 0.1, drift=-0.2)
    late = left.way > 0.2
    assert left.aside[late].mean() < -20.0
    assert right.aside[late].mean() == pytest.approx(-left.aside[late].mean(), rel=0.05)
    assert left.pull[late].mean() < driven(BED, 0.1).pull[late].mean()


@pytest.mark.parametrize("wheel", [WHEEL, SOFT], ids=["rigid", "flexible"])
def test_derivatives_are_those_of_the_forces(wheel: WheelOnSoil) -> None:
    bed = replace(BED, wheel=wheel)
    drive = driven(bed, 0.25, way=0.2)
    ground, states = drive.ground, drive.ground.states
    ground.field.clock[0] = 0.02
    hub = moving((0.2 + 1e-4, 0.0, float(drive.height[-1]) - 1e-4), 0.0, ROLLS / 0.75, (SPEED, 1e-3, 0.0))
    state = drive.state[None].copy()
    D = np.zeros((1, 6 + states, 12 + states))
    soil_derivatives(hub, state, ground, D, empty_result(2, states))
    found = empty_result(1, states)
    for row, column, moved, h in (
        (2, 2, hub.position, 1e-7),
        (0, 6, hub.velocity, 1e-6),
        (1, 7, hub.velocity, 1e-6),
        (4, 10, hub.angular_velocity, 1e-5),
        (0, 10, hub.angular_velocity, 1e-5),
    ):
        at = (0, (column - 6) % 3 if column >= 6 else column)
        sides = []
        for sign in (1.0, -1.0):
            moved[at] += sign * h
            soil_forces(hub, state, ground, found)
            sides.append(found.wrench[0, row])
            moved[at] -= sign * h
        assert D[0, row, column] == pytest.approx((sides[0] - sides[1]) / (2.0 * h), rel=0.12), (row, column)
    sides = []
    for sign in (1.0, -1.0):
        state[0, 1] += sign * 1e-8
        soil_forces(hub, state, ground, found)
        sides.append((found.wrench[0, 2], found.rate[0, 1]))
        state[0, 1] -= sign * 1e-8
    difference = (np.array(sides[0]) - np.array(sides[1])) / 2e-8
    assert D[0, [2, 7], 13] == pytest.approx(difference, rel=0.12)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_slip_and_rolling_follow_along_the_contact(way: float) -> None:
    """Both ways: a wheel at a slip of 0.3 tends to it within the length of its contact."""
    hub = moving(at_rest(0.125), 0.0, way * ROLLS / 0.7, (way * SPEED, 0.0, 0.0))
    length = math.sqrt(0.1425**2 - 0.125**2)
    for sigma, rho in ((0.0, 0.0), (0.3, way), (0.5, 0.2)):
        rates = answer(BED, BED.ground(1), hub, np.array([0.0, 0.0, sigma, rho])).rate[0]
        assert rates[2] * length == pytest.approx(SPEED / 0.7 * (0.3 - sigma), abs=1e-12)
        assert rates[3] * length == pytest.approx(SPEED / 0.7 * (way - rho), abs=1e-12)
    stands = answer(BED, BED.ground(1), moving(at_rest(0.125), 0.0, 0.0, (0.0,) * 3), np.array([0.0, 0.0, 0.4, 1.0]))
    assert not stands.rate[0, 2:].any()


def test_a_hub_beside_the_field_is_marked() -> None:
    hub = moving(at_rest(0.12, 0.75), 0.0, 0.0, (0.0, 0.0, 0.0))
    assert answer(BED, BED.ground(1), hub, np.zeros(4)).output[0, 9] == BESIDE
    in_the_air = answer(BED, BED.ground(1), moving(at_rest(0.2), 0.0, 0.0, (0.0,) * 3), np.zeros(4))
    assert not in_the_air.wrench.any()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"cell": 0.03}, "at most 20 mm"),
        ({"cell": 0.0}, "cell"),
        ({"cell": float("nan")}, "cell"),
        ({"high": (-0.4, 0.3)}, "cells of the soil"),
        ({"high": (90.0, 80.0)}, "cells of the soil"),
        ({"load": -1.0}, "load"),
    ],
)
def test_a_bed_that_cannot_be_is_refused(change: dict[str, object], told: str) -> None:
    with pytest.raises(InputError, match=told):
        replace(BED, **change)  # type: ignore[arg-type]
