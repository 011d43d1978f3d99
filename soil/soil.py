"""A soil as numbers, and the table of known ones (``soils.toml``).

Verified by tests/unit/test_soil_numbers.py.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Annotated, Any

from contracts.declared import In, require_declared
from contracts.errors import InputError

__all__ = ["Soil", "known_soils", "soil_named", "usual_numbers", "with_ends_of_ranges"]

_TABLE = Path(__file__).parent / "soils.toml"
_STEEPEST = 5.0
"""Largest power of Lyasko's factor: soil that a slip of 0.2 digs four times deeper."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Soil:
    """Numbers of a dry soil, SI.

    Attributes
    ----------
    name : of the table or of its file
    exponent : n of p = (k_c / b + k_phi) z^n [-]
    cohesive_modulus : k_c [N/m^(n+1)]
    frictional_modulus : k_phi [N/m^(n+2)]
    cohesion : c [Pa]
    friction_angle : phi [rad]
    density : [kg/m^3]
    shear_modulus : K, shear deformation modulus of Janosi and Hanamoto [m]
    unloading_stiffness, unloading_growth : k_0 [N/m^3] and A_u [N/m^4] of k_u = k_0 + A_u z_u (Wong)
    peak_rolling, peak_slipping : c_1 and c_2 of theta_m = (c_1 + c_2 s) theta_1, where the pressure is largest (Wong
        and Reece 1967) [-]
    rim_friction : angle of friction at a bare rim over that of the soil [-]
    slip_sinkage : power of Lyasko's factor (`soil.laws.slip_sinkage`) [-]: 1 as he has it, 0 for none
    ranges : attribute -> smallest and largest value its source gives
    source : where the numbers are from

    Raises
    ------
    InputError
        For a number out of its range; where the pressure would be largest beyond the first contact; a range that does
        not hold the number.
    """

    name: str
    exponent: Annotated[float, In("", above=0.0)]
    cohesive_modulus: Annotated[float, In("N/m^(n+1)", least=0.0)]
    frictional_modulus: Annotated[float, In("N/m^(n+2)", least=0.0)]
    cohesion: Annotated[float, In("Pa", least=0.0)]
    friction_angle: Annotated[float, In("rad", above=0.0, below=1.5)]
    density: Annotated[float, In("kg/m^3", above=0.0)]
    shear_modulus: Annotated[float, In("m", above=0.0)]
    unloading_stiffness: Annotated[float, In("N/m^3", least=0.0)]
    unloading_growth: Annotated[float, In("N/m^4", least=0.0)]
    peak_rolling: Annotated[float, In("", above=0.0)]
    peak_slipping: Annotated[float, In("", least=0.0)]
    rim_friction: Annotated[float, In("", above=0.0)]
    slip_sinkage: Annotated[float, In("", least=0.0)]
    source: str
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        require_declared(self, "soil")
        if self.cohesive_modulus + self.frictional_modulus <= 0.0:
            rule = "must carry: k_c or k_phi above zero"
            raise InputError("soil", self.name, rule, "give Bekker's moduli", key="frictional_modulus")
        if self.unloading_stiffness + self.unloading_growth <= 0.0:
            rule = "must have a slope of unloading: k_0 or A_u above zero"
            raise InputError("soil", self.name, rule, "leave both out for usual ones", key="unloading_growth")
        if self.peak_rolling + self.peak_slipping >= 1.0:
            value = f"{self.peak_rolling:g} + {self.peak_slipping:g}"
            raise InputError("soil peak", value, "must add up to less than 1", "0.18 and 0.32", key="peak_slipping")
        if self.rim_friction > 1.0:
            rule = "must be at most 1: soil shears on soil before it holds the rim faster"
            raise InputError("soil rim friction", f"{self.rim_friction:g}", rule, "0.76 is usual", key="rim_friction")
        if self.slip_sinkage > _STEEPEST:
            rule = f"must be at most {_STEEPEST:g}"
            raise InputError("slip sinkage", f"{self.slip_sinkage:g}", rule, "1 is Lyasko's", key="slip_sinkage")
        for key, (low, high) in self.ranges.items():
            if not low <= getattr(self, key) <= high:
                value = f"{low:g} to {high:g}"
                rule = f"must hold the number itself, {getattr(self, key):g}"
                raise InputError(f"range of {key}", value, rule, "mend one of them", key="ranges")

    def modulus(self, width: float) -> float:
        """k = k_c / b + k_phi [N/m^(n+2)] under something b [m] wide, the smaller of its sides."""
        return self.cohesive_modulus / width + self.frictional_modulus

    @property
    def rim_angle(self) -> float:
        """Angle of friction at a bare rim [rad]."""
        return self.rim_friction * self.friction_angle


@cache
def known_soils() -> dict[str, Soil]:
    """Soils of the table by name, in its order."""
    rows = tomllib.loads(_TABLE.read_text(encoding="utf-8"))
    usual = rows.pop("usual")
    return {name: _soil(name, row, usual) for name, row in rows.items()}


def soil_named(name: str) -> Soil:
    """A soil of the table; InputError for another name."""
    if name not in known_soils():
        known = ", ".join(known_soils())
        raise InputError("soil", repr(name), "is not known", f"give {known}, or a soil's file (name.toml)", key="soil")
    return known_soils()[name]


def usual_numbers() -> dict[str, float]:
    """What a soil has that does not say otherwise, by attribute."""
    usual = tomllib.loads(_TABLE.read_text(encoding="utf-8"))["usual"]
    return {key: float(value) for key, value in usual.items() if key != "source"}


def with_ends_of_ranges(soil: Soil) -> Iterator[Soil]:
    """The soil itself, and with each combination of ends of its ranges."""
    yield soil
    if soil.ranges:
        keys = tuple(soil.ranges)
        for ends in product(*(soil.ranges[key] for key in keys)):
            changed: dict[str, Any] = dict(zip(keys, ends, strict=True))
            yield replace(soil, **changed)


def _soil(name: str, row: Mapping[str, Any], usual: Mapping[str, Any]) -> Soil:
    numbers = {key: value for key, value in usual.items() if key != "source"} | dict(row)
    missing = [one.name for one in fields(Soil) if one.name not in numbers and one.name not in ("name", "ranges")]
    assert not missing, f"{name} lacks {missing}"
    ranges = {key: (float(low), float(high)) for key, (low, high) in numbers.pop("ranges", {}).items()}
    taken = sorted(key for key in usual if key != "source" and key not in row)
    source = row["source"] + (f"; {', '.join(taken).replace('_', ' ')}: {usual['source']}" if taken else "")
    return Soil(**(numbers | {"name": name, "source": source, "ranges": ranges}))
