"""Steps that are halved and doubled only."""

from __future__ import annotations

import math

import pytest

from contracts.errors import InputError
from rover_dynamics.flexible.even_steps import EvenSteps

STEPS = EvenSteps(tolerance=1e-5, first=1e-3, longest=0.05)


def test_an_output_is_reached_by_equal_steps() -> None:
    assert STEPS.towards(0.1, 0.03) == pytest.approx(0.025)
    assert STEPS.towards(0.1, 0.05) == pytest.approx(0.05)
    assert STEPS.towards(0.01, 0.05) == pytest.approx(0.01)


def test_a_step_that_fails_is_halved_and_a_good_one_doubled() -> None:
    assert STEPS.after(0.01, 0.01, math.inf) == 0.005
    assert STEPS.after(0.01, 0.01, 2e-5) == 0.005
    assert STEPS.after(0.01, 0.01, 5e-6) == 0.01
    assert STEPS.after(0.01, 0.01, 1e-8) == 0.02
    assert STEPS.after(0.04, 0.04, 1e-8) == 0.05


def test_a_step_cut_by_an_output_does_not_lengthen_the_wish() -> None:
    assert STEPS.after(0.01, 0.004, 1e-9) == 0.01


def test_not_a_number_counts_as_failure() -> None:
    assert STEPS.after(0.01, 0.01, math.nan) == 0.005


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"tolerance": 0.0}, "error allowed in a step"),
        ({"first": 1.0}, "shortest, first and longest"),
        ({"spectral_radius": 1.5}, "spectral radius"),
    ],
)
def test_bad_numbers_are_refused(numbers: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        EvenSteps(**numbers)
