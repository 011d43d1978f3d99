"""Numbers with units: converted to SI, refused when the dimension is another one or the number is not finite."""

from __future__ import annotations

import math

import numpy as np
import pint
import pytest
from pydantic_core import PydanticCustomError

from workbench.study.quantities import USUAL, to_si


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("0.6 mm", "m", 0.6e-3),
        ("142.5mm", "m", 0.1425),
        (0.1425, "m", 0.1425),
        (3, "m", 3.0),
        ("113.8 GPa", "Pa", 113.8e9),
        ("4430 kg/m^3", "kg/m**3", 4430.0),
        ("8.25 N/mm", "N/m", 8250.0),
        ("8140 N*s/m", "N*s/m", 8140.0),
        ("1e11 N/m^3", "N/m**3", 1e11),
        ("180 deg", "rad", math.pi),
        ("0.26 rad", "rad", 0.26),
        ("0.3", "", 0.3),
        ("50 %", "", 0.5),
        (" -1.5e-1 m ", "m", -0.15),
        ("4430 kg m^-3", "kg/m**3", 4430.0),
        ("1e6 kg/(m*s**2)", "Pa", 1e6),
    ],
)
def test_converts_to_si(text: object, unit: str, expected: float) -> None:
    assert to_si(text, unit) == pytest.approx(expected, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    ("value", "unit", "rule"),
    [
        ("0.6 kg", "m", "must be a length"),
        ("0.6", "m", "needs its unit"),
        ("mm", "m", "begin with a number"),
        ("0.6 furlongz", "m", "cannot be read"),
        ("__import__('os')", "m", "begin with a number"),
        ("nan mm", "m", "finite"),
        ("1e999 mm", "m", "finite"),
        (math.nan, "m", "finite"),
        (math.inf, "", "finite"),
        (math.nan, "rad", "finite"),
        (15.0, "rad", "needs its unit"),
        (True, "m", "must be a length"),
        ([1.0], "m", "must be a length"),
        ("3 mm", "", "must be a plain number, not a length"),
        ("850 N/deg", "N", "must be a force, not N/deg"),
        ("850 N/rad", "N", "must be a force, not N/rad"),
        ("0.6 mm*deg", "m", "must be a length, not mm*deg"),
        ("0.6 MPa", "m", "must be a length, not a pressure"),
        ("880 N/mm2", "Pa", "exponents as in m^2"),
        ("0,6 mm", "m", "use a point, not a comma"),
        ("1,000 mm", "m", "use a point, not a comma"),
        ("0.6 mm + 0.1 mm", "m", "one number and at most one unit"),
        ("9**9 mm", "m", "one number and at most one unit"),
        ("9**9**9 mm", "m", "one number and at most one unit"),
        ("9 mm**9**9**9", "m", "one number and at most one unit"),
        ("2 3 mm", "m", "one number and at most one unit"),
        ("1_0 mm", "m", "one number and at most one unit"),
        ("1 " + "m*" * 30 + "m", "m", "one number and at most one unit"),
    ],
)
def test_refuses_with_rule_and_hint(value: object, unit: str, rule: str) -> None:
    with pytest.raises(PydanticCustomError) as caught:
        to_si(value, unit)
    assert rule in str(caught.value)
    assert caught.value.context is not None
    assert caught.value.context["hint"]


@pytest.mark.parametrize(
    ("unit", "given"), [(unit, one) for unit, usual in USUAL.items() for one in usual] + [("K", "degC")]
)
def test_usual_units_are_pint_s_to_the_last_digit(unit: str, given: str) -> None:
    registry, numbers = pint.UnitRegistry(), np.random.default_rng(7)
    for number in [0.1 * k for k in range(-1000, 4000)] + (10.0 ** numbers.uniform(-6.0, 9.0, 1000)).tolist():
        theirs = float(registry.Quantity(number, given).to(unit).magnitude)
        assert to_si(f"{number!r} {given}", unit) == (theirs if unit == "rad" else float(f"{theirs:.15g}"))
    assert all(given not in usual for other, usual in USUAL.items() if other != unit)
