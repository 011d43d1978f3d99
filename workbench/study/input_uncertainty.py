"""The section [input_uncertainty] of a study file: what is not exactly known of a wheel, and how its effect is sampled.

Verified by tests/unit/test_workbench_input_uncertainty.py.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, StrictInt, model_validator

from workbench.study.quantities import Force, number_and_unit
from workbench.study.section import Positive, Section, in_key
from workbench.study.sections import Drop, Orientations
from workbench.study.sweep import MOST_PARAMETERS, MOST_POINTS, checked_range, flattened, tied_keys

__all__ = ["CUT", "InputUncertaintySection", "UncertainInput"]

CUT = 3.0
"""A normal distribution is cut at so many standard deviations: where sheets are refused, as a tolerance says."""
FEWEST = 20
"""Samples whose 5th and 95th percentile lie within them."""
_NOT_ITS_OWN = ("orientation", "orientation_step", "plates", "temperature")
_HELD = ("wheel.cone", "wheel.inner_hub", "wheel.impact_springs", "wheel.outer_hub.thickness", "wheel.outer_hub.width")
"""Parts that the section model holds rigid."""
_STRIPS = {"strip_thickness", "strip_scale"}
"""Keys that stand for the thickness of every strip."""
_PART = re.compile(r"\[(\d+)\]|([^.\[\]]+)")
_WHEEL = ("wheel", "materials", "fe", "strip_thickness", "strip_scale")
"""How keys begin that the section model knows of."""


class UncertainInput(Section):
    """One input: anything from low to high alike, or normal about the study's value with a deviation; and why so."""

    low: str | StrictInt | float | None = None
    """Smallest value, with its unit."""
    high: str | StrictInt | float | None = None
    """Largest value, in the same unit."""
    deviation: str | StrictInt | float | None = None
    """Standard deviation about the study's value, in its unit; cut at three of them."""
    source: Annotated[str, Field(min_length=1)]
    """Where range or deviation come from."""

    @property
    def words(self) -> str:
        """What is drawn: ``"11 mm to 13 mm"``, ``"standard deviation 0.03 mm"``."""
        if self.deviation is None:
            return f"{self.low} to {self.high}"
        return f"standard deviation {self.deviation}"


class InputUncertaintySection(Section):
    """What is not exactly known of the wheel: every other key is a key of the study, or several, as in [sweep].

    `workbench sample` draws a Latin hypercube of these inputs and runs the section model at each point.
    """

    inputs: dict[str, UncertainInput]
    """Every other key of the section: its range or deviation, and the source of that."""
    samples: Annotated[StrictInt, Field(ge=FEWEST, le=MOST_POINTS)] = 200
    """Points of the hypercube."""
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    """Of the hypercube."""
    orientations: Orientations
    """Whose average, weighted by the arcs they stand for, is the wheel's [rad]."""
    max_deflection: Drop
    """Of the sampled curves [m]; soft samples reach the loads late."""
    points: Annotated[StrictInt, Field(ge=2, le=500)] = 20
    """Of the sampled curves, in equal steps."""
    max_load: Annotated[Force, Positive]
    """A sampled curve ends at its first point with this load [N]."""
    deflections: Annotated[tuple[Drop, ...], Field(min_length=1)] = (0.020, 0.030)
    """Where the load is read [m]; at the first one the band is judged."""
    loads: Annotated[tuple[Annotated[Force, Positive], ...], Field(min_length=1)] = (160.0, 250.0)
    """Where the deflection is read [N]."""

    @model_validator(mode="before")
    @classmethod
    def _keys_of_the_study(cls, section: object) -> object:
        """Put every key that is not one of the section's own among the inputs."""
        if not isinstance(section, Mapping):
            return section
        own = cls.model_fields.keys() - {"inputs"}
        others = {key: value for key, value in section.items() if key not in own}
        found = dict(flattened("", others, UncertainInput.model_fields.keys()))
        if not found:
            raise in_key("wheel.tire.thickness", "", "must be given, or another key", _EXAMPLE)
        if len(found) > MOST_PARAMETERS:
            raise in_key(
                next(iter(found)), "", f"is one of {len(found)} keys, more than {MOST_PARAMETERS}", "give fewer"
            )
        for key, value in found.items():
            _check(key, value)
        _each_once(found)
        return {key: value for key, value in section.items() if key in own} | {"inputs": found}

    @model_validator(mode="after")
    def _read_within_the_curves(self) -> InputUncertaintySection:
        """What is stated; defaults beyond short curves are left empty."""
        for name, numbers, end, unit in (
            ("deflections", self.deflections, ("max_deflection", self.max_deflection), "mm"),
            ("loads", self.loads, ("max_load", self.max_load), "N"),
        ):
            scale = 1e3 if unit == "mm" else 1.0
            if name in self.model_fields_set and max(numbers) > end[1]:
                rule = f"lies beyond {end[0]} = {scale * end[1]:g} {unit}, where sampled curves end"
                raise in_key(name, f"{scale * max(numbers):g} {unit}", rule, f"read it within, or raise {end[0]}")
        return self


_EXAMPLE = 'e.g. { deviation = "0.03 mm", source = "..." } or { low = "0.5 mm", high = "0.6 mm", source = "..." }'


def _each_once(inputs: Mapping[str, Any]) -> None:
    """Refuse a key of the study that two inputs draw."""
    seen = dict[tuple[str | int, ...], str]()
    for key in inputs:
        for _, one in tied_keys(key):
            parts = tuple(int(number) if number else name for number, name in _PART.findall(one))
            if parts in seen:
                raise in_key(key, "", f"draws {one}, as {seen[parts]!r} does already", "draw each key once")
            seen[parts] = key
    strips = [key for key in inputs if key in _STRIPS]
    if strips and (len(strips) > 1 or any(parts[-1] == "thickness" for parts in seen)):
        rule, hint = (
            "draws every strip's thickness, as another input does",
            "draw all strips together, or each by itself",
        )
        raise in_key(strips[0], "", rule, hint)


def _check(key: str, value: Any) -> None:
    """Refuse what is neither a range nor a deviation, and keys that the section model does not know."""
    if not isinstance(value, Mapping):
        raise in_key(key, value, "must be a table", _EXAMPLE)
    if key in _NOT_ITS_OWN or not key.startswith(_WHEEL):
        raise in_key(key, "", "is nothing that the section model computes with", "name a key of wheel, materials or fe")
    for _, one in tied_keys(key):
        if one.startswith(_HELD) or one.endswith(".density"):
            raise in_key(key, "", "is nothing that the section model computes with", "leave it out, or name another")
    ranged = {name: value[name] for name in ("low", "high") if name in value}
    if bool(ranged) == ("deviation" in value):
        raise in_key(key, "", "must have low and high, or a deviation", _EXAMPLE)
    if ranged:
        checked_range(key, ranged)
        return
    deviation = number_and_unit(value["deviation"])
    if deviation is None or not 0.0 < deviation[0] < math.inf:
        raise in_key(key, value["deviation"], "must have a deviation greater than zero", _EXAMPLE)
