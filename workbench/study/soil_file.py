"""A soil by its name in the table, or from a file of the user's.

    exponent = 1.1
    cohesive_modulus = 15600          # k_c, N/m^(n+1), plain
    frictional_modulus = 2.4074e6     # k_phi, N/m^(n+2), plain
    cohesion = "0.25 kPa"
    friction_angle = "31.9 deg"
    density = "1605 kg/m^3"
    shear_modulus = ["9.7 mm", "13.1 mm"]     # a pair is a range: the middle counts, the ends are computed beside it

What else `soil.soil.Soil` has may be given too; what is left out is usual. Verified by
tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from pydantic_core import PydanticCustomError

from contracts.declared import In, declared_types
from contracts.errors import InputError
from contracts.input_file import input_table
from soil.soil import Soil, known_soils, soil_named, usual_numbers
from workbench.study.quantities import to_si

__all__ = ["soil_of"]

_ENDING = ".toml"
_BY_EXPONENT = ("cohesive_modulus", "frictional_modulus")
"""Numbers whose unit depends on the exponent."""
_CAN_BE = {
    "exponent": (0.05, 5.0),
    "cohesive_modulus": (1e-3, 1e8),
    "frictional_modulus": (1e4, 1e10),
    "cohesion": (1.0, 1e7),
    "density": (100.0, 2e4),
    "shear_modulus": (1e-4, 1.0),
    "unloading_stiffness": (1e3, 1e13),
    "unloading_growth": (1e3, 1e15),
}
"""What numbers of any soil can be, where they are not zero [SI]: a slip of the unit leaves it."""
_SLIPS = {"cohesive_modulus": "1 kPa is 1000 of it", "frictional_modulus": "1 kPa is 1000 of it"} | {
    "cohesion": "1 kPa is 1000 of it",
    "shear_modulus": "write it with its unit, like '18 mm'",
}
"""What slips of the unit are usual."""


def soil_of(name: str, folder: Path = Path()) -> Soil:
    """The soil of a name, or of a file ``NAME.toml`` in a folder.

    Raises
    ------
    InputError
        For an unknown name, and a file that cannot be read or gives what cannot be.
    """
    return _from_file(folder / name) if name.endswith(_ENDING) else soil_named(name)


def _from_file(path: Path) -> Soil:
    given = input_table(path, "soil file", "docs/how_to/soil.md")
    if path.stem in known_soils():
        raise InputError(f"soil file {path}", path.stem, "is the name of a known soil", "rename the file")
    rules = {name: rule for name, one in declared_types(Soil).items() if (rule := _rule(one)) is not None}
    if unknown := sorted(set(given) - set(rules) - {"source"}):
        raise InputError(f"soil file {path}", unknown[0], "is not known", f"give {', '.join(rules)}, source")
    numbers, ranges = usual_numbers(), {}
    for key, value in given.items():
        if key == "source":
            continue
        ends = [_number(path, key, one, rules[key]) for one in (value if isinstance(value, list) else [value])]
        if len(ends) not in (1, 2) or ends[0] > ends[-1]:
            raise InputError(f"{path}: {key}", value, "must be a number or [low, high]", "give one, or two in order")
        numbers[key] = 0.5 * (ends[0] + ends[-1])
        if len(ends) == 2:
            ranges[key] = (ends[0], ends[1])
    if missing := [one.name for one in fields(Soil) if one.name in rules and one.name not in numbers]:
        known = ", ".join(known_soils())
        raise InputError(f"soil file {path}", missing[0], "is missing", f"add it, or take a known soil ({known})")
    source = _source(path, given)
    try:
        found = Soil(name=path.stem, source=source, ranges=ranges, **numbers)
        changes: list[dict[str, Any]] = [{key: end} for key, ends in ranges.items() for end in ends]
        for change in changes:
            replace(found, ranges={}, **change)
    except InputError as error:
        raise InputError(f"{path}: {error.what}", error.value, error.rule, error.hint, key=error.key) from error
    return found


def _rule(declared: Any) -> In | None:
    return next((one for one in getattr(declared, "__metadata__", ()) if isinstance(one, In)), None)


def _number(path: Path, key: str, value: object, rule: In) -> float:
    """SI; the two moduli and A_u plain, as their units are no common ones."""
    plain = key in _BY_EXPONENT or rule.unit == "N/m^4"
    try:
        number = to_si(value, "" if plain else rule.unit.replace("^", "**"))
    except PydanticCustomError as error:
        told = error.context or {}
        what = f"{path}: {key}"
        raise InputError(
            what, repr(value), str(told.get("rule", error)), str(told.get("hint", "see its unit"))
        ) from error
    low, high = _CAN_BE.get(key, (-float("inf"), float("inf")))
    if number and not low <= number <= high:
        limits = f"must lie in {low:g} to {high:g} {rule.unit}".rstrip()
        hint = _SLIPS.get(key, "check its unit")
        raise InputError(f"{path}: {key}", f"{number:g} {rule.unit}".rstrip(), limits, hint)
    return number


def _source(path: Path, given: Mapping[str, Any]) -> str:
    source = given.get("source", "")
    if not isinstance(source, str):
        raise InputError(f"{path}: source", source, "must be a text", 'write it like "my bevameter, June"')
    return " ".join(source.split()) or f"the file {path.name}"
