"""Stiffness curves: interpolation, inverse, tangent, average and refused values."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contracts.curves import Around, StiffnessCurve, average_curve
from contracts.errors import InputError


def curve(deflection: list[float], load: list[float], **more: Any) -> StiffnessCurve:
    return StiffnessCurve(
        model="test", orientation_deg=0.0, deflection=np.array(deflection), load=np.array(load), **more
    )


LINE = curve([0.0, 0.01, 0.03], [0.0, 82.5, 247.5])
DIPPING = curve([0.0, 0.01, 0.02, 0.03], [0.0, 100.0, 60.0, 200.0])


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"deflection": np.array([0.0])}, "needs two or more points"),
        ({"deflection": np.array([0.0]), "load": np.array([0.0])}, "needs two or more points"),
        ({"deflection": np.zeros((2, 2)), "load": np.zeros((2, 2))}, "needs two or more points"),
        ({"deflection": np.array([0.0, np.nan, 0.03])}, "not finite"),
        ({"load": np.array([0.0, np.inf, 1.0])}, "not finite"),
        ({"deflection": np.array([0.0, 0.01, 0.01])}, "must increase strictly"),
        ({"deflection": np.array([0.0, 0.02, 0.01])}, "must increase strictly"),
        ({"columns": {"newton": np.zeros(2)}}, "curve column newton = shape \\(2,\\): must have one value per point"),
    ],
)
def test_bad_curves_are_refused(change: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        replace(LINE, **change)


def test_load_at_interpolates_linearly() -> None:
    np.testing.assert_allclose(LINE.load_at(np.array([0.0, 0.005, 0.02, 0.03])), [0.0, 41.25, 165.0, 247.5], rtol=1e-14)
    assert float(DIPPING.load_at(0.015)) == pytest.approx(80.0, rel=1e-14)


@pytest.mark.parametrize("deflection", [-1e-6, 0.0301, math.nan, math.inf])
def test_load_outside_the_curve_is_refused(deflection: float) -> None:
    with pytest.raises(InputError, match=r"lies outside the curve \(0..30 mm\)"):
        LINE.load_at(deflection)


@given(st.floats(0.0, 247.5))
def test_deflection_at_inverts_load_at_on_a_rising_curve(load: float) -> None:
    assert float(LINE.load_at(LINE.deflection_at(load))) == pytest.approx(load, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(("load", "first"), [(60.0, 0.006), (80.0, 0.008), (100.0, 0.01), (130.0, 0.025)])
def test_deflection_at_is_the_first_crossing_of_a_curve_that_dips(load: float, first: float) -> None:
    assert DIPPING.deflection_at(load) == pytest.approx(first, rel=1e-12)


def test_deflection_at_the_first_point_is_that_point() -> None:
    assert curve([0.002, 0.01], [5.0, 10.0]).deflection_at(5.0) == 0.002


@pytest.mark.parametrize("load", [-1.0, 248.0, math.nan])
def test_deflection_at_a_load_never_reached_is_refused(load: float) -> None:
    with pytest.raises(InputError, match=r"lies outside the curve \(0..247.5 N\)"):
        LINE.deflection_at(load)


def test_initial_tangent_of_a_line_is_its_slope_at_any_range() -> None:
    for up_to in (1e-4, 5e-3, 0.03):
        assert LINE.initial_tangent(up_to) == pytest.approx(8250.0, rel=1e-12)


def test_initial_tangent_of_a_parabola_is_the_least_squares_slope() -> None:
    """F = a d^2 has the slope a sum d^3 / sum d^2 = a h 3/4 (1 + 1/n) / (1 + 1/(2n)) on n = 100 equal steps of 0..h."""
    d = np.linspace(0.0, 0.01, 4001)
    parabola = curve(list(d), list(3.0e5 * d**2))
    expected = 3.0e5 * 0.01 * 0.75 * (1.0 + 1.0 / 100.0) / (1.0 + 1.0 / 200.0)
    assert parabola.initial_tangent(0.01) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("up_to", [0.0, -0.001, math.nan])
def test_initial_tangent_needs_a_range(up_to: float) -> None:
    with pytest.raises(InputError, match="initial tangent range"):
        LINE.initial_tangent(up_to)


def test_initial_tangent_beyond_the_curve_or_before_its_start_is_refused() -> None:
    with pytest.raises(InputError, match="outside the curve"):
        LINE.initial_tangent(0.04)
    with pytest.raises(InputError, match="outside the curve"):
        curve([0.001, 0.02], [0.0, 1.0]).initial_tangent(0.01)


def test_average_is_the_mean_over_the_common_range() -> None:
    soft, stiff = curve([0.0, 0.03], [0.0, 150.0]), curve([0.001, 0.01, 0.021], [10.0, 100.0, 210.0])
    mean = average_curve([soft, stiff], step=1e-3)
    np.testing.assert_allclose(mean.deflection, np.arange(1, 22) * 1e-3, rtol=1e-12)
    np.testing.assert_allclose(mean.load, 7500.0 * mean.deflection, rtol=1e-12)
    np.testing.assert_allclose(mean.columns["load_min_N"], 5000.0 * mean.deflection, rtol=1e-12)
    np.testing.assert_allclose(mean.columns["load_max_N"], 10000.0 * mean.deflection, rtol=1e-12)
    assert mean.orientation_deg is None
    assert "2 orientations" in mean.source


def test_average_is_partial_if_one_curve_is() -> None:
    assert not average_curve([LINE, LINE]).partial
    assert average_curve([LINE, replace(LINE, partial=True)]).partial


def test_average_of_nothing_or_without_a_common_range_is_refused() -> None:
    with pytest.raises(InputError, match="needs at least one curve"):
        average_curve([])
    with pytest.raises(InputError, match="range common to all curves"):
        average_curve([curve([0.0, 0.01], [0.0, 1.0]), curve([0.02, 0.03], [0.0, 1.0])])


@pytest.mark.parametrize("step", [0.0, -1e-3, 0.04, math.nan])
def test_average_needs_a_step_that_fits(step: float) -> None:
    with pytest.raises(InputError, match="average step"):
        average_curve([LINE], step=step)


def test_only_a_partial_curve_may_be_first_contact_alone() -> None:
    nothing = curve([0.0], [0.0], partial=True)
    assert nothing.unloaded
    assert not LINE.unloaded
    with pytest.raises(InputError, match=r"lies outside the curve \(0..0 mm\)"):
        nothing.load_at(0.001)
    with pytest.raises(InputError, match="lies outside the curve"):
        nothing.deflection_at(1.0)
    with pytest.raises(InputError, match="needs two or more points"):
        replace(nothing, partial=False)


def test_an_average_by_arc_weighs_the_ends_of_a_mirrored_wheel_half() -> None:
    """Period 120 deg, mirrored: 0 and 60 deg are ends, 30 deg stands for half of all; alike they give another mean."""
    curves = [curve([0.0, 0.01], [0.0, load]) for load in (100.0, 40.0, 60.0)]
    weights = Around(period=120.0, mirrored=True).weights([0.0, 30.0, 60.0])
    assert weights == pytest.approx([0.25, 0.5, 0.25])
    assert average_curve(curves, 1e-3, weights).load[-1] == pytest.approx(60.0)
    assert average_curve(curves, 1e-3).load[-1] == pytest.approx(200.0 / 3.0)
    assert Around(period=60.0).weights([5.0, 65.0, 35.0]) == pytest.approx([0.25, 0.25, 0.5])  # 5 and 65 are one place
