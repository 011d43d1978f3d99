"""Tables against temperature: rows exactly, monotone between them, refused outside; same curve as SciPy's PCHIP."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from contracts.errors import InputError
from contracts.materials_tables import PropertyRow, PropertyTable


def table(temperatures: list[float], values: list[float]) -> PropertyTable:
    pairs = zip(temperatures, values, strict=True)
    return PropertyTable(what="test", rows=tuple(PropertyRow(temperature=T, value=v, source="test") for T, v in pairs))


@given(
    st.lists(st.floats(0.5, 50.0), min_size=2, max_size=7),
    st.lists(st.floats(-5.0, 5.0), min_size=7, max_size=7),
)
def test_the_interpolant_is_scipys_pchip(steps: list[float], values: list[float]) -> None:
    temperatures = list(itertools.accumulate(steps, initial=100.0))
    values = [*values, 0.0][: len(temperatures)]
    ours, theirs = table(temperatures, values), PchipInterpolator(temperatures, values)
    for T in np.linspace(temperatures[0], temperatures[-1], 23):
        assert ours.at(float(T)) == pytest.approx(float(theirs(T)), rel=1e-9, abs=1e-9)


def test_rows_are_met_and_the_curve_is_monotone_between_them() -> None:
    rows = table([20.0, 77.0, 293.0, 423.0], [1.94, 1.58, 1.0, 0.82])
    assert [rows.at(T) for T in (20.0, 77.0, 293.0, 423.0)] == pytest.approx([1.94, 1.58, 1.0, 0.82], abs=1e-15)
    values = [rows.at(float(T)) for T in np.linspace(20.0, 423.0, 200)]
    assert all(b < a for a, b in itertools.pairwise(values))


@pytest.mark.parametrize("temperature", [19.9, 423.1, float("nan")])
def test_outside_is_refused(temperature: float) -> None:
    with pytest.raises(InputError, match="must lie within the data"):
        table([20.0, 423.0], [2.0, 1.0]).at(temperature)


@pytest.mark.parametrize(
    ("temperatures", "values", "text"),
    [
        ([20.0], [1.0], "two or more rows"),
        ([20.0, 20.0], [1.0, 2.0], "increasing temperature"),
        ([20.0, 30.0], [1.0, float("inf")], "finite numbers"),
    ],
)
def test_bad_rows_are_refused(temperatures: list[float], values: list[float], text: str) -> None:
    with pytest.raises(InputError, match=text):
        table(temperatures, values)


def test_a_row_needs_a_source() -> None:
    rows = tuple(PropertyRow(temperature=T, value=1.0, source="") for T in (1.0, 2.0))
    with pytest.raises(InputError, match="a source"):
        PropertyTable(what="test", rows=rows)
