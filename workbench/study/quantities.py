"""Numbers with units, as a study file may write them: SI numbers or strings such as ``"0.6 mm"``.

This is the one place where units are parsed; everything behind it is SI. Verified by
tests/unit/test_workbench_quantities.py.
"""

from __future__ import annotations

import math
import re
import sys
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator, ValidationInfo
from pydantic_core import PydanticCustomError

if TYPE_CHECKING:
    import pint

__all__ = [
    "USUAL",
    "Angle",
    "Bedding",
    "Density",
    "Force",
    "InUnit",
    "Length",
    "Number",
    "Pressure",
    "Stiffness",
    "Temperature",
    "Viscosity",
    "number_and_unit",
    "to_si",
]

_TEXT = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)\b)\s*(.*)", re.IGNORECASE | re.ASCII)
"""A number, then whatever follows: nothing or a unit."""
_EXPONENT = r"(?:(?:\^|\*\*)-?\d)?"
_FACTOR = rf"\(?(?:[^\W\d_]+|%|°){_EXPONENT}(?:\){_EXPONENT})?"
_UNIT = re.compile(rf"{_FACTOR}(?:\s*[*/\s]\s*{_FACTOR})*")
"""Names of units with one-digit exponents, joined by ``*``, ``/`` or spaces: no arithmetic reaches pint."""
_LONGEST_UNIT = 40
_KINDS = {
    "m": ("a length", "0.6 mm"),
    "rad": ("an angle", "15 deg"),
    "Pa": ("a pressure or modulus", "113.8 GPa"),
    "N": ("a force", "200 N"),
    "kg/m**3": ("a density", "4430 kg/m^3"),
    "N/m**3": ("a stiffness per area", "1e11 N/m^3"),
    "N/m": ("a stiffness", "8.25 N/mm"),
    "N*s/m": ("a viscous coefficient", "100 N*s/m"),
    "K": ("a temperature", "-40 degC"),
    "s": ("a duration", "30 d"),
    "byte": ("a size", "2 GB"),
    "": ("a plain number", "0.3"),
}
USUAL = {
    "m": {"mm": 1e-3, "m": 1.0},
    "rad": {"deg": math.pi / 180.0, "rad": 1.0},
    "Pa": {"MPa": 1e6, "GPa": 1e9, "kPa": 1e3, "Pa": 1.0},
    "N": {"N": 1.0, "kN": 1e3},
    "kg/m**3": {"kg/m^3": 1.0},
    "N/m**3": {"N/m^3": 1.0},
    "N/m": {"N/m": 1.0, "N/mm": 1e3},
    "N*s/m": {"N*s/m": 1.0},
    "K": {"K": 1.0},
    "s": {"s": 1.0},
}
"""What most studies are written in, read without pint: to make its registry takes longer than to read a study."""


@cache
def _registry() -> pint.UnitRegistry:
    import pint

    return pint.UnitRegistry()


def _refuse(rule: str, hint: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{rule}; {hint}", {"rule": rule, "hint": hint})


def to_si(value: object, unit: str) -> float:
    """Convert a number or a string with a unit to SI, checking its dimension.

    Parameters
    ----------
    value : number taken as SI, or a string such as ``"0.6 mm"``; an angle must be a string, because a plain
        number could be meant in degrees, and so must a temperature
    unit : SI unit wanted, in pint's spelling; ``""`` for a plain number

    Returns
    -------
    number : the value in ``unit``, finite

    Raises
    ------
    PydanticCustomError
        If it is not a number, has another dimension, or is NaN or infinite; carries ``rule`` and ``hint``.
    """
    kind, example = _KINDS[unit]
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise _refuse(f"must be {kind}", f"write it like {example!r}")
    try:
        number = _from_text(value, unit) if isinstance(value, str) else float(value)
    except OverflowError as error:  # an integer of hundreds of digits
        raise _refuse("is too large", f"write {kind} like {example!r}") from error
    if not math.isfinite(number):
        raise _refuse("must be a finite number", f"write {kind} like {example!r}")
    if unit == "rad" and not isinstance(value, str):
        raise _refuse("an angle needs its unit", f"write it like {example!r} or '0.26 rad'")
    if unit == "K" and not isinstance(value, str):
        raise _refuse("a temperature needs its unit", f"write it like {example!r} or '233 K'")
    return number


def _from_text(text: str, unit: str) -> float:
    """Split ``text`` into one number and its unit, and convert it to ``unit``; only the unit is read by pint."""

    kind, example = _KINDS[unit]
    number, given = _split(text, unit)
    if not given and unit and math.isfinite(number):
        raise _refuse(f"{kind} in a string needs its unit", f"write it like {example!r}")
    if not given or not math.isfinite(number):
        return number
    if (unit, given) == ("K", "degC"):
        return _rounded(number + 273.15, unit)
    if (factor := USUAL.get(unit, {}).get(given)) is not None:
        return _rounded(number * factor, unit)
    try:
        quantity = _registry().Quantity(number, given)
        _refuse_another_kind(quantity, unit, given)
        return _rounded(float(quantity.to(unit or "dimensionless").magnitude), unit)
    except PydanticCustomError:
        raise
    except Exception as error:  # pint raises many kinds for text it cannot read
        raise _refuse(f"cannot be read as {kind} ({error})", f"write it like {example!r}") from error


def _rounded(number: float, unit: str) -> float:
    """142.5 mm is 0.1425 m to the last digit."""
    return number if unit == "rad" else float(f"{number:.15g}")


def _refuse_another_kind(quantity: pint.Quantity[float], unit: str, given: str) -> None:
    """pint counts an angle as a plain number: percent and counts are no angle to us, N/deg and N/rad no force."""
    root = quantity.to_root_units().units
    if root != _root(unit):
        kind, example = _KINDS[unit]
        other = next((words for known, (words, _) in _KINDS.items() if _root(known) == root), given)
        raise _refuse(f"must be {kind}, not {other}", f"write it like {example!r}")


@cache
def _root(unit: str) -> object:
    return _registry().Quantity(1.0, unit or "dimensionless").to_root_units().units


def _split(text: str, unit: str) -> tuple[float, str]:
    """The number that ``text`` begins with, and the text of the unit behind it."""
    kind, example = _KINDS[unit]
    if "," in text:
        raise _refuse(f"must be {kind} without a comma", f"use a point, not a comma, like {example!r}")
    found = _TEXT.fullmatch(text.strip())
    if found is None:
        raise _refuse(f"must be {kind}", f"begin with a number, like {example!r}")
    given = found[2]
    if len(given) > _LONGEST_UNIT or (given and not _UNIT.fullmatch(given)):
        rule = f"cannot be read as {kind}: it must be one number and at most one unit"
        power = ", exponents as in m^2" if re.search(r"[^\W\d_]\d", given) else ""
        raise _refuse(rule, f"write it like {example!r}, without arithmetic{power}")
    return float(found[1]), given


@dataclass(frozen=True, slots=True)
class InUnit:
    """Validator of one unit; with the context ``{"si": True}`` the values are SI already, angles included."""

    unit: str

    def __call__(self, value: Any, info: ValidationInfo) -> float:
        """The value in SI."""
        already_si = bool(info.context) and isinstance(value, float)
        return to_si(value, "" if already_si else self.unit)


def number_and_unit(value: object) -> tuple[float, str] | None:
    """A plain number, or a string of one number and its unit as written: ``(0.6, "mm")``; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    if not isinstance(value, str):
        return (float(value), "") if abs(value) <= sys.float_info.max else None
    found = _TEXT.fullmatch(value.strip())
    return (float(found[1]), found[2].strip()) if found and math.isfinite(float(found[1])) else None


Length = Annotated[float, BeforeValidator(InUnit("m"))]
Angle = Annotated[float, BeforeValidator(InUnit("rad"))]
Pressure = Annotated[float, BeforeValidator(InUnit("Pa"))]
Bedding = Annotated[float, BeforeValidator(InUnit("N/m**3"))]
Force = Annotated[float, BeforeValidator(InUnit("N"))]
Density = Annotated[float, BeforeValidator(InUnit("kg/m**3"))]
Stiffness = Annotated[float, BeforeValidator(InUnit("N/m"))]
Viscosity = Annotated[float, BeforeValidator(InUnit("N*s/m"))]
Temperature = Annotated[float, BeforeValidator(InUnit("K"))]
Number = Annotated[float, BeforeValidator(InUnit(""))]
