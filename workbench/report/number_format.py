"""Numbers as a reader wants them: mm instead of m, percent instead of fractions where that is the habit.

Verified by tests/unit/test_workbench_outputs.py.
"""

from __future__ import annotations

from contracts.records import Check

__all__ = ["PERCENT_QUANTITIES", "displayed", "displayed_reference"]

_SCALES = {"m": (1e3, "mm"), "N/m": (1e-3, "N/mm"), "Pa": (1e-6, "MPa"), "m^3": (1e6, "cm³")}
PERCENT_QUANTITIES = (
    "spread",
    "difference",
    "relative L2 difference",
    "largest difference / load, 5 N at least",
    "grid convergence index",
    "change of load",
)
"""Quantities shown in percent."""


def displayed(value: float | None, unit: str = "-", quantity: str = "") -> str:
    """Text of a value given in SI: four significant digits, in the unit a reader expects."""
    if value is None:
        return "–"
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


def _digits(value: float) -> str:
    if value != 0.0 and not 1e-3 <= abs(value) < 1e5:
        mantissa, exponent = f"{value:.2e}".split("e")
        return f"{mantissa}·10{str(int(exponent)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"
    return f"{value:.4g}"
