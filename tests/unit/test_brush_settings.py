"""Settings of the brush tire: what they become for the loops, and what they refuse."""

from __future__ import annotations

import math
from dataclasses import fields

import pytest

from contracts.errors import InputError
from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw, SlipLaw, wheel_numbers
from rover_dynamics.tires.brush_tire import THESIS_BRUSH


def test_bristles_are_as_stiff_in_both_directions() -> None:
    numbers = wheel_numbers(THESIS_BRUSH, BrushSettings(relaxation_length=0.03))
    assert numbers.tangential_stiffness == pytest.approx(275e3)
    assert numbers.tangential_stiffness * numbers.relaxation_x == pytest.approx(8250.0)
    assert numbers.tangential_stiffness * numbers.relaxation_y == pytest.approx(850.0 * 180.0 / math.pi)


def test_choices_reach_the_loops() -> None:
    default = wheel_numbers(THESIS_BRUSH, BrushSettings())
    other = wheel_numbers(THESIS_BRUSH, BrushSettings(slip_law=SlipLaw.FIALA, damper_law=DamperLaw.AS_PRINTED))
    assert (default.law, default.damping_ramp) == (0.0, 0.005)
    assert (other.law, other.damping_ramp) == (1.0, 0.0)


LENGTHS = [field.name for field in fields(BrushSettings) if field.type == "float"]


@pytest.mark.parametrize("value", [0.0, -0.1, math.nan, math.inf])
@pytest.mark.parametrize("name", LENGTHS)
def test_numbers_must_be_above_zero(name: str, value: float) -> None:
    with pytest.raises(InputError, match=name.replace("_", " ")):
        BrushSettings(**{name: value})
