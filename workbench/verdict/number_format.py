"""Numbers as a reader wants them: mm instead of m, percent instead of fractions where that is the habit.

Verified by tests/unit/test_workbench_outputs.py.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from contracts.records import Check

__all__ = ["PERCENT_QUANTITIES", "displayed", "displayed_reference", "largest_by_unit", "power_of_ten"]

_SCALES = {"m": (1e3, "mm"), "N/m": (1e-3, "N/mm"), "Pa": (1e-6, "MPa"), "m^3": (1e6, "cm³")}
PERCENT_QUANTITIES = (
    "spread",
    "difference",
    "relative L2 difference",
    "largest difference / load, 5 N at least",
    "grid convergence index",
    "change of load",
    "part reached",
)
"""Quantities shown in percent."""
_ROUND_OFF = 1e-9
"""What lies below this part of its scale is no more than round-off and solver tolerance."""


class Measured(Protocol):
    """Anything with a value and its unit."""

    @property
    def value(self) -> float: ...

    @property
    def unit(self) -> str: ...


def displayed(value: float | None, unit: str = "-", quantity: str = "", *, scale: float = 0.0) -> str:
    """Text of a value given in SI: four significant digits, in the unit a reader expects.

    Parameters
    ----------
    value : None is a dash
    unit : in SI, ``"-"`` for none
    quantity : decides whether a number is shown in percent
    scale : size that values of its kind have here; what round-off alone can make of it is shown as ``≈ 0``
    """
    if value is None:
        return "–"
    if 0.0 < abs(value) < _ROUND_OFF * scale:
        return "≈ 0" if unit == "-" else f"≈ 0 {_SCALES.get(unit, (1.0, unit))[1]}"
    if unit == "-":
        return f"{_digits(100.0 * value)} %" if quantity in PERCENT_QUANTITIES else _digits(value)
    scale, shown = _SCALES.get(unit, (1.0, unit))
    return f"{_digits(scale * value)} {shown}"


def displayed_reference(check: Check) -> str:
    """Reference of a check: a number, an interval, or nothing."""
    if check.reference is None:
        return "–"
    if isinstance(check.reference, tuple):
        low, high = (displayed(v, check.unit, check.quantity) for v in check.reference)
        return f"{low.split(' ')[0]} … {high}"
    return displayed(check.reference, check.unit, check.quantity)


def largest_by_unit(found: Iterable[Measured]) -> dict[str, float]:
    """Unit -> largest magnitude of a table's values: the scale of `displayed`."""
    scales: dict[str, float] = {}
    for one in found:
        scales[one.unit] = max(scales.get(one.unit, 0.0), abs(one.value))
    return scales


def power_of_ten(value: float, digits: int = 3) -> str:
    """A number as ``2.9·10⁻³``; without its mantissa where that is 1 and one digit is asked for."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = f"10{str(int(exponent)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"
    return power if mantissa == "1" else f"{mantissa}·{power}"


def _digits(value: float) -> str:
    if value != 0.0 and not 1e-3 <= abs(value) < 1e5:
        return power_of_ten(value)
    return f"{value:.4g}"
