"""Lengths of implicit steps: outputs are met, errors shorten, one output's cut does not shorten what follows."""

from __future__ import annotations

import math

import pytest

from contracts.errors import InputError
from rover_dynamics.multibody.implicit_steps import ImplicitSteps

STEPS = ImplicitSteps(tolerance=1e-6, first=1e-4, shortest=1e-9, longest=0.02)


def test_the_last_two_steps_to_an_output_share_what_is_left() -> None:
    assert STEPS.towards(0.010, 0.011) == 0.010
    assert STEPS.towards(0.010, 0.009) == 0.005
    assert STEPS.towards(0.010, 0.001) == 0.001
    assert STEPS.towards(1.0, 0.5) == 0.02


def test_the_length_follows_the_third_root_of_the_error() -> None:
    assert STEPS.after(1e-3, 1e-3, 1e-6) == pytest.approx(0.85e-3)
    assert STEPS.after(1e-3, 1e-3, 8e-6) == pytest.approx(0.425e-3)
    assert STEPS.after(1e-3, 1e-3, 1.0) == pytest.approx(0.2e-3)
    assert STEPS.after(1e-3, 1e-3, math.inf) == pytest.approx(0.25e-3)
    assert STEPS.after(1e-3, 1e-3, 0.0) == pytest.approx(2e-3)


def test_a_step_cut_by_an_output_keeps_the_wish() -> None:
    assert STEPS.after(1e-5, 1e-3, 1e-15) == 1e-3
    assert STEPS.after(1e-5, 1e-3, 1e-6) == pytest.approx(0.85e-5)


def test_fixed_steps_are_judged_by_convergence_only() -> None:
    fixed = ImplicitSteps(fixed=0.3)
    assert fixed.towards(1.0, 1e-4) == 0.3
    assert fixed.towards(0.2, 1e-4) == 0.2
    assert fixed.accepts(1e3)
    assert not fixed.accepts(math.inf)
    assert not STEPS.accepts(1e-3)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"tolerance": 0.0}, "error allowed"),
        ({"tolerance": math.nan}, "error allowed"),
        ({"first": 0.1}, "in this order"),
        ({"shortest": 0.0}, "above zero"),
        ({"longest": math.inf}, "finite"),
        ({"fixed": 0.0}, "fixed step"),
        ({"spectral_radius": 1.1}, "0 ... 1"),
    ],
)
def test_numbers_out_of_range_are_refused(wrong: dict[str, float], words: str) -> None:
    with pytest.raises(InputError, match=words):
        ImplicitSteps(**wrong)
