"""Colour bars: round ends, values with units, colours from light to dark."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.viewer.colours import colour_bar


@pytest.mark.parametrize(("largest", "end"), [(665e6, 700e6), (251e6, 260e6), (19.3e6, 20e6), (0.0, 1e6)])
def test_the_bar_ends_at_a_round_value_at_or_above_the_largest(largest: float, end: float) -> None:
    bar = colour_bar("von Mises stress", "MPa", 1e-6, [np.full(10, largest), np.zeros(10)])
    assert bar.end == pytest.approx(end)


def test_values_have_their_unit_and_the_bar_its_ticks() -> None:
    bar = colour_bar("von Mises stress", "MPa", 1e-6, [np.full(10, 665e6)])
    assert bar.text(118.6e6) == "119 MPa"
    shown = bar.shown(665e6)
    assert shown["title"] == "von Mises stress [MPa]"
    assert shown["ticks"] == ["700", "560", "420", "280", "140", "0"]
    assert shown["above"] == "largest 665 MPa"


def test_colours_run_from_the_first_to_the_last_and_stay_there() -> None:
    bar = colour_bar("displacement", "mm", 1e3, [np.array([0.0, 0.02])])
    colours = bar.colours(np.array([0.0, 0.5 * bar.end, bar.end, 2.0 * bar.end]))
    assert colours[0].tolist() == [255, 255, 217]
    assert colours[1].tolist() == [65, 182, 196]
    assert colours[2].tolist() == colours[3].tolist() == [8, 29, 88]


def test_values_with_a_sign_have_colours_on_both_sides_of_zero() -> None:
    field = np.concatenate([np.full(10, -300e6), np.full(10, 120e6)])
    bar = colour_bar("principal stress", "MPa", 1e-6, [field])
    assert (bar.begin, bar.end) == pytest.approx((-300e6, 300e6))
    below, zero, above = bar.colours(np.array([-150e6, 0.0, 150e6])).astype(int)
    assert zero.tolist() == [247, 247, 247]
    assert below[2] > below[0]
    assert above[0] > above[2]
    shown = bar.shown(120e6, -300e6)
    assert shown["ticks"] == ["300", "150", "0", "-150", "-300"]
    assert shown["above"] == "from -300 MPa to 120 MPa"


def test_round_off_below_zero_is_no_sign() -> None:
    bar = colour_bar("principal stress", "MPa", 1e-6, [np.array([-1e-3, 120e6])])
    assert bar.begin == 0.0
    np.testing.assert_array_equal(bar.colours(np.array([-1e-3])), bar.colours(np.array([0.0])))
