"""The brush tire: Table II as printed, its radial line, and the values it refuses."""

from __future__ import annotations

import math
import tomllib
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contracts.errors import InputError
from rover_dynamics.tires.brush_tire import (
    THESIS_BRUSH,
    BrushTireParameters,
    radial_load,
    stiffness_curve,
    with_friction,
)

TABLES = Path(__file__).parents[1] / "data" / "thesis_tables.toml"


def test_thesis_parameters_are_the_printed_table() -> None:
    with TABLES.open("rb") as stream:
        printed = tomllib.load(stream)["brush"]
    lateral_per_degree = THESIS_BRUSH.cornering_stiffness * math.pi / 180.0
    assert lateral_per_degree == pytest.approx(printed.pop("lateral_slip_stiffness"), rel=1e-14)
    assert {name: getattr(THESIS_BRUSH, name) for name in printed} == printed
    assert len(fields(BrushTireParameters)) == len(printed) + 3  # the lateral stiffness, the source, the lever


@given(st.floats(-1.0, 1.0))
def test_load_is_the_line_in_compression_and_zero_in_an_open_gap(deflection: float) -> None:
    load = float(radial_load(THESIS_BRUSH, np.array(deflection)))
    assert load >= 0.0
    assert load == (8250.0 * deflection if deflection > 0.0 else 0.0)


def test_known_loads() -> None:
    loads = radial_load(THESIS_BRUSH, np.array([-0.001, 0.0, 0.01, 0.02]))
    np.testing.assert_allclose(loads, [0.0, 0.0, 82.5, 165.0], rtol=1e-14)


def test_curve_is_the_line_through_the_origin() -> None:
    curve = stiffness_curve(THESIS_BRUSH, 0.035)
    assert (curve.model, curve.orientation_deg, curve.partial) == ("brush", None, False)
    assert curve.deflection[0] == 0.0
    assert curve.deflection[-1] == 0.035
    assert curve.initial_tangent(5e-3) == pytest.approx(8250.0, rel=1e-12)
    assert curve.deflection_at(198.0) == pytest.approx(0.024, rel=1e-12)
    assert "Table II" in curve.source
    assert "8250" in curve.source


def test_curve_follows_the_parameters() -> None:
    curve = stiffness_curve(replace(THESIS_BRUSH, radial_stiffness=1000.0, source="test"), 0.01, points=3)
    np.testing.assert_allclose(curve.load, [0.0, 5.0, 10.0], rtol=1e-14)


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("radial_stiffness", 0.0, "radial stiffness = 0 N/m: must be finite and greater than zero"),
        ("radial_stiffness", math.nan, "radial stiffness = nan N/m"),
        ("radial_damping", -1.0, "radial damping = -1 N.s/m: must be finite and at least 0"),
        ("longitudinal_slip_stiffness", math.inf, "longitudinal slip stiffness = inf N"),
        ("cornering_stiffness", -850.0, "cornering stiffness = -850 N/rad"),
        ("friction_min", 0.0, "friction min = 0"),
        ("friction_max", 0.5, "not be below friction_min, 0.597"),
        ("rolling_resistance", -0.01, "rolling resistance = -0.01"),
    ],
)
def test_bad_parameters_are_refused(name: str, value: float, text: str) -> None:
    change: dict[str, Any] = {name: value}
    with pytest.raises(InputError, match=text):
        replace(THESIS_BRUSH, **change)


@pytest.mark.parametrize("max_deflection", [0.0, -0.01, math.nan, math.inf])
def test_bad_range_is_refused(max_deflection: float) -> None:
    with pytest.raises(InputError, match="brush max deflection"):
        stiffness_curve(THESIS_BRUSH, max_deflection)


def test_single_point_is_refused() -> None:
    with pytest.raises(InputError, match="brush curve points = 1: must be 2 or more"):
        stiffness_curve(THESIS_BRUSH, 0.03, points=1)


def test_a_coefficient_of_the_ground_replaces_both_frictions_and_nothing_else() -> None:
    slippery = with_friction(THESIS_BRUSH, 0.2)
    assert (slippery.friction_min, slippery.friction_max) == (0.2, 0.2)
    assert replace(slippery, friction_min=0.597, friction_max=0.757) == THESIS_BRUSH
    assert with_friction(THESIS_BRUSH, None) == THESIS_BRUSH
    with pytest.raises(InputError, match="brush friction min = 0: must be finite and greater than zero"):
        with_friction(THESIS_BRUSH, 0.0)
