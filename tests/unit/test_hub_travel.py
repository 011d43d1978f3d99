"""A travel of the hub: its control parameter, the ground's motion, and what is refused."""

from __future__ import annotations

import itertools
import math

import pytest

from contracts.errors import InputError
from contracts.hub_travel import GroundMotion, HubPlace, HubTravel, Leg, Way


def travel(way: Way) -> HubTravel:
    return HubTravel.along(way=way, start=0.02, steps=(0.001, 0.004))


@pytest.mark.parametrize("way", list(Way))
def test_steps_are_found_again_at_their_controls(way: Way) -> None:
    one = travel(way)
    assert [one.at(control) for control in one.controls] == pytest.approx(one.legs[0].steps, rel=1e-12)
    assert all(a < b for a, b in zip((one.start, *one.controls), one.controls, strict=False))


@pytest.mark.parametrize("way", list(Way))
def test_up_to_its_start_the_ground_only_rises(way: Way) -> None:
    assert travel(way).ground(0.01) == GroundMotion(0.0, 0.0, 0.01)


def test_the_ground_moves_against_the_hub() -> None:
    ends = {way: travel(way).ground(travel(way).controls[-1]) for way in Way}
    assert ends[Way.FORE_AFT] == pytest.approx((-0.004, 0.0, 0.02, 0.0, 0.0, 0.0), abs=1e-15)
    assert ends[Way.LATERAL] == pytest.approx((0.0, -0.004, 0.02, 0.0, 0.0, 0.0), abs=1e-15)
    assert ends[Way.RADIAL] == pytest.approx((0.0, 0.0, 0.024, 0.0, 0.0, 0.0), abs=1e-15)
    assert ends[Way.LEANING] == pytest.approx((0.0, 0.0, 0.02, -0.004, 0.0, 0.0), abs=1e-15)
    assert ends[Way.WIND_UP] == pytest.approx((0.0, 0.0, 0.02, 0.0, -0.004, 0.0), abs=1e-15)
    assert ends[Way.TURNING] == pytest.approx((0.0, 0.0, 0.02, 0.0, 0.0, -0.004), abs=1e-15)


PATH = HubTravel.through(
    [
        {Way.RADIAL: 0.01},
        {Way.LATERAL: 0.005},
        {Way.RADIAL: 0.008, Way.LEANING: 0.1},
        {Way.LATERAL: -0.001},
    ],
    longest=1e-3,
)


def test_a_path_goes_straight_from_place_to_place() -> None:
    first, second, third = PATH.legs
    assert (len(first.steps), len(second.steps), len(third.steps)) == (5, 6, 6)  # 5, 5.39 and 6 mm
    ends = [len(first.steps), len(first.steps) + len(second.steps), len(PATH.controls)]
    places = [PATH.place(PATH.controls[end - 1]) for end in ends]
    assert places[0] == pytest.approx(HubPlace(lateral=0.005, radial=0.01), abs=1e-15)
    assert places[1] == pytest.approx(HubPlace(lateral=0.005, radial=0.008, leaning=0.1), abs=1e-15)
    assert places[2] == pytest.approx(HubPlace(lateral=-0.001, radial=0.008, leaning=0.1), abs=1e-15)
    middle = PATH.place(0.5 * (PATH.controls[ends[0] - 1] + PATH.controls[ends[1] - 1]))
    assert middle == pytest.approx(HubPlace(lateral=0.005, radial=0.009, leaning=0.05), abs=1e-15)
    assert all(0.0 < b - a <= 1e-3 * (1.0 + 1e-9) for a, b in itertools.pairwise((0.01, *PATH.controls)))
    assert (PATH.ways, PATH.slides) == ((Way.LATERAL, Way.RADIAL, Way.LEANING), True)


def test_on_a_path_the_ground_moves_against_the_hub() -> None:
    assert PATH.ground(0.004) == GroundMotion(0.0, 0.0, 0.004)
    assert PATH.ground(PATH.controls[-1]) == pytest.approx((0.0, 0.001, 0.008, -0.1, 0.0, 0.0), abs=1e-15)


def test_a_path_is_pressed_first_and_no_leg_stands_still() -> None:
    with pytest.raises(InputError, match="radial way alone"):
        HubTravel.through([{Way.LATERAL: 0.01}], longest=1e-3)
    with pytest.raises(InputError, match="goes nowhere"):
        HubTravel.through([{Way.RADIAL: 0.01}], longest=1e-3)
    with pytest.raises(InputError, match="ends where it begins"):
        HubTravel.through([{Way.RADIAL: 0.01}, {Way.RADIAL: 0.01}], longest=1e-3)
    assert not HubTravel(start=0.01, legs=(Leg.along(Way.LEANING, (0.1,)),)).slides


@pytest.mark.parametrize("start", [0.0, -1.0, math.nan, math.inf])
def test_a_start_that_presses_nothing_is_refused(start: float) -> None:
    with pytest.raises(InputError, match="start of a travel"):
        HubTravel.along(way=Way.LATERAL, start=start, steps=(0.001,))


@pytest.mark.parametrize("steps", [(), (0.0,), (0.002, 0.001), (math.nan,), (0.001, math.inf)])
def test_steps_that_do_not_rise_are_refused(steps: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="increase from above zero"):
        HubTravel.along(way=Way.LATERAL, start=0.02, steps=steps)
