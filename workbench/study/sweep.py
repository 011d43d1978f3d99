"""The section [sweep] of a study file: which keys of the study are varied, over which values, and by which models.

Verified by tests/unit/test_workbench_sweep_points.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Set
from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, StrictInt, model_validator

from contracts.hub_travel import Way
from workbench.study.quantities import Angle, Force, number_and_unit
from workbench.study.section import Positive, Section, in_key
from workbench.study.sections import Drop

__all__ = [
    "MOST_PARAMETERS",
    "MOST_POINTS",
    "MOVED",
    "Aim",
    "SweepRange",
    "SweepSection",
    "SweptModel",
    "Value",
    "checked_range",
    "flattened",
    "tied_keys",
]

type Value = str | int | float | bool
"""A value as the study file has it, with its unit."""
SweptModel = Literal["fe", "section", "ancf_wheel", "ancf", "brush"]
MOST_POINTS, MOST_PARAMETERS = 10_000, 100
MOVED: tuple[SweptModel, ...] = ("fe", "ancf_wheel")
"""Models whose hub can be moved over the ground."""


class SweepRange(Section):
    """Everything from ``low`` to ``high``, both in the same unit: plain numbers, or strings such as ``"0.5 mm"``."""

    low: str | StrictInt | float
    """With its unit."""
    high: str | StrictInt | float
    """In the same unit."""


class Aim(Section):
    """What one number of the table should be: near a target, no more or no less than a limit; SI, as there."""

    target: Annotated[float, Field(allow_inf_nan=False)] | None = None
    """Wanted value."""
    within: Annotated[float, Field(gt=0.0, le=1.0)] | None = None
    """Relative difference from the target that is still good [-]."""
    at_most: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None
    """Largest good value."""
    at_least: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None
    """Smallest good value."""

    @model_validator(mode="after")
    def _one_kind(self) -> Aim:
        given = [name for name in ("target", "at_most", "at_least") if getattr(self, name) is not None]
        if len(given) != 1:
            raise in_key(given[-1] if given else "target", len(given), "must be one of three", "give one of " + _KINDS)
        if (self.within is None) == (self.target is not None) or self.target == 0.0:
            raise in_key(
                "within", self.within, "belongs to a target that is not zero", "e.g. target = 8250, within = 0.03"
            )
        return self

    def miss(self, value: float) -> float:
        """How far a value is from good [-]: 0 at the target, 1 at the limit, more beyond it."""
        if self.target is not None:
            assert self.within is not None
            return abs(value / self.target - 1.0) / self.within
        if self.at_most is not None:
            return max(value, 0.0) / self.at_most
        assert self.at_least is not None
        return self.at_least / value if value > 0.0 else math.inf


_AN_AIM = 'e.g. [sweep.aims] "load_at_20mm_N" = { target = 155.8, within = 0.03 }'
_KINDS = "target (with within), at_most, at_least"


class SweepSection(Section):
    """A parameter study: every other key of the section is a key of the study, or one of some names, and its values.

    Attributes
    ----------
    parameters : dotted key of the study (``"fe.friction"``), or ``strip_thickness``, ``orientation``, ``temperature``,
        ``plates`` or ``obstacle`` -> its values, or the range they are drawn from
    models : which of the models each point runs
    design : every combination of the values, a Latin hypercube of ``samples`` points drawn with ``seed``, or a search
        of so many points for what ``aims`` say
    base : whether the study as it is runs too, as point 0
    deflections : where the load is read [m]
    loads : where deflection, stiffness and stress are read [N]
    travels : ways in which the pressed wheel's hub is then moved over the ground, from the first of the loads
    aims : column of the table -> what it should be; a search makes the largest miss small
    one_of : group -> alternative -> aims: of each group one alternative is enough, with all its aims
    batch : points that a search chooses at once
    first_step : standard deviation of a search's first batch, as a part of each range
    scaled : whether a search reads each point at the strip thickness that meets the aims best: load goes with its cube,
        stress with the thickness itself, as where strips bend
    confirm : points of a search, the best ones, that run again at that thickness, every ``confirm_step``
    """

    parameters: dict[str, Annotated[tuple[Value, ...], Field(min_length=1)] | SweepRange]
    """Every other key of the section: values or a range."""
    models: Annotated[tuple[SweptModel, ...], Field(min_length=1)] = ("section",)
    """What each point runs."""
    design: Literal["grid", "latin-hypercube", "search"] = "grid"
    """Every combination, a Latin hypercube, or a search."""
    samples: Annotated[StrictInt, Field(ge=2, le=MOST_POINTS)] | None = None
    """Points of the hypercube or the search."""
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    """Of the hypercube or the search."""
    base: StrictBool = True
    """Whether the study as it is runs too."""
    deflections: Annotated[tuple[Drop, ...], Field(min_length=1)] = (0.010, 0.020, 0.030)
    """Where the load is read [m]."""
    loads: Annotated[tuple[Annotated[Force, Positive], ...], Field(min_length=1)] = (160.0, 250.0)
    """Where deflection, stiffness and stress are read [N]."""
    travels: tuple[Way, ...] = ()
    """Ways in which the hub is then moved over the ground, from the first of the loads."""

    aims: dict[str, Aim] = Field(default_factory=dict)
    """What a search looks for: column of the table -> aim."""
    one_of: dict[str, Annotated[dict[str, Annotated[dict[str, Aim], Field(min_length=1)]], Field(min_length=1)]] = (
        Field(default_factory=dict)
    )
    """What else: group -> alternatives, each with its aims; the best alternative of a group counts."""
    batch: Annotated[StrictInt, Field(ge=4, le=1000)] = 12
    """Points that a search chooses at once."""
    first_step: Annotated[float, Field(gt=0.0, le=1.0)] = 0.3
    """How far a search's first batch lies around the study as it is, standard deviation over range [-]."""
    scaled: StrictBool = False
    """Whether a search reads each point at the best strip thickness."""
    confirm: Annotated[StrictInt, Field(ge=0, le=MOST_POINTS)] = 0
    """Best points of a search that run again."""
    confirm_step: Annotated[Angle, Positive] = math.radians(5.0)
    """Between their orientations, over the wheel's period."""

    @property
    def moved(self) -> tuple[tuple[Way, ...], float]:
        """Ways of the hub, and the load from which it moves [N]."""
        return self.travels, self.loads[0]

    @property
    def wanted(self) -> dict[str, str]:
        """Every column that an aim names -> key of the first such aim."""
        found = {name: f"aims.{name}" for name in self.aims}
        for group, ways in self.one_of.items():
            for way, aims in ways.items():
                for name in aims:
                    found.setdefault(name, f"one_of.{group}.{way}.{name}")
        return found

    @model_validator(mode="before")
    @classmethod
    def _keys_of_the_study(cls, section: object) -> object:
        """Put every key that is not one of the section's own among the parameters."""
        if not isinstance(section, Mapping):
            return section
        own = cls.model_fields.keys() - {"parameters"}
        others = {key: value for key, value in section.items() if key not in own}
        if not others:
            raise in_key("strip_thickness", "", "must be given, or another key to vary", 'e.g. ["0.5 mm", "0.6 mm"]')
        return {key: value for key, value in section.items() if key in own} | {"parameters": cls.flat(others)}

    @staticmethod
    def flat(given: Mapping[str, Any]) -> dict[str, object]:
        """Keys of the study with their values or ranges, checked as written; keys without quotes made one again."""
        found = dict(flattened("", given, {"low", "high"}))
        if len(found) > MOST_PARAMETERS:
            raise in_key(
                next(iter(found)), "", f"is one of {len(found)} keys, more than {MOST_PARAMETERS}", "vary fewer"
            )
        varied: dict[str, str] = {}
        for keys in found:
            for _, one in tied_keys(keys):
                if one in varied:
                    raise in_key(keys, one, f"is varied twice, by {varied[one]!r} too", "leave one of them out")
                varied[one] = keys
        return {key: _checked_values(key, values) for key, values in found.items()}

    @model_validator(mode="after")
    def _fits_the_design(self) -> SweepSection:
        ranges = [key for key, values in self.parameters.items() if isinstance(values, SweepRange)]
        if self.design == "grid":
            if ranges:
                raise in_key(ranges[0], "a range", "has no grid", 'list its values, or set design = "latin-hypercube"')
            if self.samples is not None:
                raise in_key("samples", self.samples, 'belongs to design = "latin-hypercube"', "remove it")
            if "seed" in self.model_fields_set:
                raise in_key("seed", self.seed, 'belongs to design = "latin-hypercube"', "remove it")
            count = math.prod(len(v) for v in self.parameters.values() if not isinstance(v, SweepRange))
            if count > MOST_POINTS:
                rule = f"makes {count} combinations, more than {MOST_POINTS}"
                raise in_key("design", "grid", rule, 'list fewer values, or use "latin-hypercube"')
        elif self.samples is None:
            raise in_key("samples", "", "must say how many points are drawn", "e.g. samples = 30")
        if (self.design == "search") != bool(self.aims or self.one_of):
            raise in_key("aims", "", 'belongs to design = "search", which needs it', _AN_AIM)
        for group in self.one_of:
            if group in self.wanted:
                raise in_key(f"one_of.{group}", group, "is a column of the table too", "give the group another name")
        if self.design != "search":
            for name in ("batch", "first_step", "scaled", "confirm", "confirm_step"):
                if name in self.model_fields_set:
                    raise in_key(name, getattr(self, name), 'belongs to design = "search"', "remove it")
        else:
            if len(self.models) > 1:
                raise in_key("models", ", ".join(self.models), "must be one for a search", 'e.g. models = ["section"]')
            if len(self.parameters) < 2:
                raise in_key("design", "search", "needs two parameters at least", 'use "latin-hypercube" for one')
        if self.travels and not set(self.models) & set(MOVED):
            rule, hint = "moves no hub of the models", f"add {' or '.join(MOVED)} to models"
            raise in_key("travels", ", ".join(self.travels), rule, hint)
        if len(set(self.travels)) < len(self.travels):
            raise in_key("travels", ", ".join(self.travels), "names a way twice", "give each once")
        if "temperature" in self.parameters and self.models != ("fe",):
            raise in_key("temperature", "given", "acts on the solid model only", 'set models = ["fe"]')
        stand = {"fe", "section", "ancf_wheel"}
        if "obstacle" in self.parameters and not set(self.models) <= stand:
            rule = f"acts on {', '.join(sorted(stand))} only"
            raise in_key("obstacle", "given", rule, "take the others out of models")
        for key in self.parameters:
            if key.startswith("ancf_wheel.") and "ancf_wheel" not in self.models:
                raise in_key(key, "given", "acts on the ANCF wheel only", 'add "ancf_wheel" to models')
        if len(set(self.models)) < len(self.models):
            raise in_key("models", ", ".join(self.models), "names a model twice", "give each once")
        return self


def flattened(prefix: str, table: Mapping[str, Any], last: Set[str]) -> list[tuple[str, Any]]:
    """Keys written without quotes make tables: ``fe.friction = [...]`` is ``{"fe": {"friction": [...]}}``.

    A table with a key among ``last`` is a value.
    """
    found = []
    for key, value in table.items():
        if isinstance(value, Mapping) and not value.keys() & last:
            found += flattened(f"{prefix}{key}.", value, last)
        else:
            found.append((f"{prefix}{key}", value))
    return found


def _checked_values(key: str, values: object) -> object:
    """A range, or a list of plain values without repeats, all with one unit."""
    if isinstance(values, Mapping):
        return checked_range(key, values)
    if not isinstance(values, list | tuple) or not values:
        raise in_key(key, values, "must be a list of values or a range", "e.g. [1, 2] or { low = 1, high = 2 }")
    if any(not isinstance(value, str | int | float | bool) for value in values):
        raise in_key(key, "a list", "must hold plain values", "numbers, strings or true and false")
    shown = ", ".join(map(str, values))
    if len({(type(value), value) for value in values}) < len(values):
        raise in_key(key, shown, "holds a value twice", "give each value once")
    numbers = [number_and_unit(value) for value in values]
    if len({number[1] for number in numbers if number is not None}) > 1:
        raise in_key(key, shown, "mixes units", "write all values in one unit")
    return values


def checked_range(key: str, values: Mapping[str, object]) -> SweepRange:
    """A range, as written: two numbers in one unit, low below high."""
    example = 'e.g. { low = "0.5 mm", high = "0.8 mm" }'
    low, high = values.get("low"), values.get("high")
    ends = number_and_unit(low), number_and_unit(high)
    if values.keys() != {"low", "high"} or ends[0] is None or ends[1] is None:
        raise in_key(key, dict(values), "must have low and high, two numbers and nothing else", example)
    if ends[0][1] != ends[1][1]:
        raise in_key(key, f"{low} to {high}", "has two units", "write low and high in one unit")
    if not ends[0][0] < ends[1][0] or math.isinf(ends[1][0] - ends[0][0]):
        raise in_key(key, f"{low} to {high}", "must have finite ends, low less than high", example)
    return SweepRange.model_validate({"low": low, "high": high})


def tied_keys(key: str) -> list[tuple[float, str]]:
    """``"a.b = -c.d"``, two keys that are varied together, as ``[(1.0, "a.b"), (-1.0, "c.d")]``."""
    names = [part.strip() for part in key.split("=")]
    return [(-1.0, name[1:].strip()) if name.startswith("-") else (1.0, name) for name in names]
