"""A travel of the hub: its control parameter, the ground's motion, and what is refused."""

from __future__ import annotations

import math

import pytest

from contracts.errors import InputError
from contracts.hub_travel import GroundMotion, HubTravel, Way


def travel(way: Way) -> HubTravel:
    return HubTravel(way=way, start=0.02, steps=(0.001, 0.004))


@pytest.mark.parametrize("way", list(Way))
def test_steps_are_found_again_at_their_controls(way: Way) -> None:
    one = travel(way)
    assert [one.at(control) for control in one.controls] == pytest.approx(one.steps, rel=1e-12)
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


@pytest.mark.parametrize("start", [0.0, -1.0, math.nan, math.inf])
def test_a_start_that_presses_nothing_is_refused(start: float) -> None:
    with pytest.raises(InputError, match="start of a travel"):
        HubTravel(way=Way.LATERAL, start=start, steps=(0.001,))


@pytest.mark.parametrize("steps", [(), (0.0,), (0.002, 0.001), (math.nan,), (0.001, math.inf)])
def test_steps_that_do_not_rise_are_refused(steps: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="increase from above zero"):
        HubTravel(way=Way.LATERAL, start=0.02, steps=steps)
