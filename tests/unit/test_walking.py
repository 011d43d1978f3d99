"""The gait: laws without a jump that repeat themselves, wheels that stay where they stand, rovers that cannot walk."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.motion_law import Turn
from rover_dynamics.rover.planar_pose import PlanarPose, SideView, side_view
from rover_dynamics.rover.rover_design import RoverDesign
from rover_dynamics.rover.rover_file import EXOMARS_ROVER, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.walking import WALKS, walked
from rover_dynamics.rover.walking import Gait, repeated, walking_actuators

FloatArray = NDArray[np.float64]
DESIGN, GAIT = read_rover(), Gait(overdrive=0.1)
TIMES = np.linspace(0.0, GAIT.period, 161)
SHIPPED = EXOMARS_ROVER.read_text(encoding="utf-8")


def turn(angle: float, x: float, z: float) -> FloatArray:
    """(x, z) turned about y."""
    return np.array([math.cos(angle) * x + math.sin(angle) * z, -math.sin(angle) * x + math.cos(angle) * z])


def standing(design: RoverDesign, view: SideView) -> tuple[FloatArray, FloatArray, PlanarPose]:
    body, wheels = GAIT.ways(TIMES, len(view.axles))
    return body, wheels, view.pose(wheels - body[:, None])


def test_every_wheel_is_where_the_gait_has_it() -> None:
    """Front wheel and centre wheel by hand through the bogie; its turn is what both arms turn and their legs do not."""
    body, wheels, pose = standing(DESIGN, side_view(DESIGN))
    bogies = pose.arms[:, :2] - pose.deployment[:, :2] - pose.pitch[:, None]
    np.testing.assert_allclose(bogies[:, 0], bogies[:, 1], atol=1e-14)
    for axle, name in ((0, "front_left"), (1, "center_left")):
        leg = next(leg for leg in DESIGN.legs if leg.name == name)
        for k in range(0, len(TIMES), 8):
            place = np.array([-0.0202 + body[k], 0.43 + pose.rise[k]])
            place += turn(pose.pitch[k], 0.32 + 0.0202, 0.216 - 0.43)
            place += turn(pose.pitch[k] + bogies[k, 0], leg.deployment[0] - 0.32, leg.deployment[2] - 0.216)
            place += turn(pose.arms[k, axle], leg.drive[0] - leg.deployment[0], -leg.deployment[2])
            np.testing.assert_allclose(place, (leg.drive[0] + wheels[k, axle], 0.0), atol=1e-12)


def test_two_upright_legs_swing_as_pendulums(tmp_path: Path) -> None:
    """Four wheels, no pivot, legs of 0.28 m: all wheels u behind the body is asin(u / L), 0.28 (1 - cos) lower."""
    text = SHIPPED.split("[[pivots]]")[0].replace("[0.600,", "[0.640,").replace("[-0.680,", "[-0.720,")
    text = text.replace("gravity = 3.711", "gravity = 3.711\npivots = []", 1)
    bodies = text.index('[[bodies]]\nname = "pivot"'), text.index("[[legs]]")
    text = text[: bodies[0]] + text[bodies[1] :]
    centre = text.index('[[legs]]\nname = "center"'), text.index('[[legs]]\nname = "rear"')
    text = (
        (text[: centre[0]] + text[centre[1] :]).replace('"pivot"', '"principal"').replace('"pivot_rear"', '"principal"')
    )
    (tmp_path / "four.toml").write_text(text, encoding="utf-8")
    four = side_view(read_rover(tmp_path / "four.toml"))
    assert four.axles == ("front", "rear")
    pose = four.pose(np.array([[-0.05, -0.05]]))
    angle = math.asin(0.05 / 0.28)
    np.testing.assert_allclose(pose.deployment, [[angle, angle]], rtol=1e-12)
    assert pose.rise[0] == pytest.approx(-0.28 * (1.0 - math.cos(angle)), rel=1e-12)
    assert pose.pitch[0] == pytest.approx(0.0, abs=1e-14)


def test_a_cycle_moves_one_axle_after_the_other_by_a_stride() -> None:
    body, wheels = GAIT.ways(TIMES, 3)
    assert body[-1] == pytest.approx(GAIT.stride)
    np.testing.assert_allclose(wheels[-1], GAIT.stride)
    moved = np.diff(wheels, axis=0) > 0.0
    assert moved.sum(axis=1).max() == 1
    assert list(dict.fromkeys(np.nonzero(moved)[1].tolist())) == [0, 1, 2]
    middle = 0.5 * (TIMES[1:] + TIMES[:-1])
    np.testing.assert_array_equal(GAIT.stands(middle, 3), ~moved)
    np.testing.assert_array_equal(GAIT.stands(middle + 7.0 * GAIT.period, 3), ~moved)
    assert not np.any(moved.any(axis=1) & (np.diff(body) > 0.0))


@pytest.mark.parametrize("joint", ["deploy_front_left", "deploy_rear_right", "drive_center_left"])
def test_laws_have_no_jump_and_repeat(joint: str) -> None:
    cycles = 3
    law = walking_actuators(DESIGN, GAIT, cycles).laws[joint]
    times = np.linspace(-1.0, cycles * GAIT.period + 1.0, 20001)
    value, rate, acceleration = np.array([law.at(t) for t in times.tolist()]).T
    step = times[1] - times[0]
    np.testing.assert_allclose(np.diff(value) / step, 0.5 * (rate[1:] + rate[:-1]), atol=1e-5)
    np.testing.assert_allclose(np.diff(rate) / step, 0.5 * (acceleration[1:] + acceleration[:-1]), atol=1e-3)
    assert np.abs(np.diff(acceleration)).max() < 0.05 * np.abs(acceleration).max()
    assert law.at(-5.0) == pytest.approx((0.0, 0.0, 0.0), abs=1e-14)
    ahead = GAIT.stride * (1.0 + GAIT.overdrive) / DESIGN.wheel_radius if joint.startswith("drive") else 0.0
    for t in (0.0, 3.7, 11.0, 20.0):
        later = law.at(t + GAIT.period)
        assert later == pytest.approx((law.at(t)[0] + ahead, *law.at(t)[1:]), abs=1e-10)
    assert law.at(1e3) == pytest.approx((cycles * ahead, 0.0, 0.0), abs=1e-12)


def test_a_wheel_that_stands_does_not_turn_and_one_that_moves_rolls() -> None:
    """The drive and all that turns its axle with it, against the ground, between the samples of the laws too."""
    times = np.linspace(0.0, GAIT.period, 337)
    view = side_view(DESIGN)
    body, wheels = GAIT.ways(times, 3)
    arms = view.pose(wheels - body[:, None]).arms
    for overdrive in (0.0, 0.1):
        laws = walking_actuators(DESIGN, replace(GAIT, overdrive=overdrive), 1).laws
        drives = np.array([[laws[f"drive_{axle}_left"].at(t)[0] for axle in view.axles] for t in times.tolist()])
        rolled = wheels * (1.0 + overdrive) / DESIGN.wheel_radius
        np.testing.assert_allclose(drives + arms, rolled, atol=1e-5)  # a micrometre of the rim
    assert np.abs(arms).max() > 0.1  # negative control: drives that stood would turn the wheels by that


def test_a_law_through_samples_of_a_turn_is_that_turn() -> None:
    """A polynomial of degree five at rest at both ends."""
    turn = Turn(end=1.0, lasts=1.0)
    law = repeated(np.array([turn.at(s)[0] for s in np.linspace(0.0, 1.0, 9).tolist()]), 1.0, 2)
    value, rate, acceleration = turn.at(0.37)
    assert law.at(1.37) == pytest.approx((1.0 + value, rate, acceleration), rel=1e-10)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"stride": 0.0}, "stride of a gait = 0 m: must be finite and > 0"),
        ({"period": math.nan}, "period of a gait = nan s"),
        ({"overdrive": -0.1}, "overdrive of a gait = -0.1: must be finite and >= 0"),
    ],
)
def test_a_gait_that_cannot_be_is_refused(numbers: dict[str, float], words: str) -> None:
    with pytest.raises(InputError) as caught:
        Gait(**numbers)
    assert words in str(caught.value)


def test_a_scenario_is_walked_in_whole_cycles_as_far_as_it_is_driven() -> None:
    """20 s at 70 m/h are 0.389 m: four strides, eighty seconds; what is not driven ahead is refused."""
    up = walked(SCENARIOS["slope_up"])
    assert (up.name, up.lasts, up.tilt, up.tire) == ("slope_up_walk", 80.0, SCENARIOS["slope_up"].tilt, up.tire)
    assert up.path is not None
    assert np.ptp(up.path(DESIGN), axis=0)[0] == pytest.approx(1.36 + 0.4)
    assert walked(SCENARIOS["step"], Gait(stride=0.05)).lasts == 59 * 20.0
    assert walked(SCENARIOS["step"]).path is None
    assert walked(SCENARIOS["step"]).search is None
    for name in set(SCENARIOS) - set(WALKS):
        with pytest.raises(InputError, match="is not driven straight ahead; walk one of straight, slope_up"):
            walked(SCENARIOS[name])


def test_rovers_that_cannot_walk_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="further than the legs reach; walk with a shorter stride"):
        walking_actuators(DESIGN, Gait(stride=0.7), 1)
    stiff = replace(DESIGN, pivots=tuple(p for p in DESIGN.pivots if p.name == "bogie_rear"))
    with pytest.raises(InputError, match="3 axles, 0 pivots about y: do not hold it"):
        side_view(stiff)
    legs = tuple(replace(leg, drive=(0.6, *leg.drive[1:])) if leg.name == "front_right" else leg for leg in DESIGN.legs)
    with pytest.raises(InputError, match="has legs that differ from left to right"):
        side_view(replace(DESIGN, legs=legs))
    aslant = tuple(replace(p, axis=(0.0, 1.0, 0.3)) if p.name == "bogie_left" else p for p in DESIGN.pivots)
    with pytest.raises(InputError, match=r"axis = .* of pivot bogie_left is none of x, y and z"):
        side_view(replace(DESIGN, pivots=aslant))
