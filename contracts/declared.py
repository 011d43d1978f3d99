"""What a number of a class of parameters is, said once, where its attribute stands: unit and limits.

    thickness: Annotated[float, In("m", above=0.0)]

`require_declared` holds an object's numbers against that. Who reads such an object from a file
(`workbench.study.declared`) takes unit, limits, default and meaning from the same place.
Verified by tests/unit/test_declared.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cache
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from contracts.errors import InputError

__all__ = [
    "Angle",
    "Count",
    "In",
    "Number",
    "PositiveDensity",
    "PositiveLength",
    "PositivePressure",
    "PositiveStiffness",
    "Whole",
    "declared_types",
    "require_declared",
]


@dataclass(frozen=True, slots=True)
class In:
    """A finite number in an SI unit, perhaps limited.

    Attributes
    ----------
    unit : SI unit, e.g. ``"kg/m^3"``; ``""`` for a plain number
    above, below : limits that are excluded
    least : limit that is included
    """

    unit: str
    above: float | None = None
    below: float | None = None
    least: float | None = None

    def broken(self, value: float) -> str | None:
        """The rule that a value [``unit``] breaks, in words; None if it breaks none."""
        above = self.above is None or value > self.above
        below = self.below is None or value < self.below
        if math.isfinite(value) and above and below and (self.least is None or value >= self.least):
            return None
        if self.below is not None:
            return f"must lie in ({self.above:g}, {self.below:g})"
        if self.least is not None:
            return f"must be finite and at least {self.least:g}"
        words = "" if self.above is None else f" and > {self.above:g}" if self.above else " and greater than zero"
        return f"must be finite{words}"

    def shown(self, value: float) -> str:
        """A value [``unit``] with its unit as one says it: lengths in mm."""
        return f"{1e3 * value:g} mm" if self.unit == "m" else f"{value:g} {self.unit}".rstrip()


@dataclass(frozen=True, slots=True)
class Whole:
    """A whole number of at least ``least``. A file may ask for ``most``, where a slip would fill the memory."""

    least: int
    most: int


Angle = Annotated[float, In("rad")]
Number = Annotated[float, In("")]
PositiveLength = Annotated[float, In("m", above=0.0)]
PositivePressure = Annotated[float, In("Pa", above=0.0)]
PositiveDensity = Annotated[float, In("kg/m^3", above=0.0)]
PositiveStiffness = Annotated[float, In("N/m", above=0.0)]
Count = Annotated[int, Whole(1, 360)]


@cache
def declared_types(kind: type) -> dict[str, Any]:
    """Attribute of a dataclass -> its type with what is declared of it."""
    hints = get_type_hints(kind, include_extras=True)
    return {field.name: hints[field.name] for field in fields(kind)}


def require_declared(owner: Any, of: str = "") -> None:
    """Raise InputError, with the attribute as its key, for the first number of an object that is not as declared.

    Parameters
    ----------
    owner : a dataclass whose attributes are annotated with `In` or `Whole`, also within tuples; None is no number
    of : what the object is called, e.g. ``"tire"``
    """
    for name, declared in declared_types(type(owner)).items():  # type: ignore[arg-type]
        for value, rule in _numbers(getattr(owner, name), declared):
            what = f"{of} {name.replace('_', ' ')}".strip()
            if isinstance(rule, Whole):
                if not isinstance(value, int) or isinstance(value, bool) or value < rule.least:
                    hint = f"give {rule.least} or more, or leave the part out"
                    raise InputError(what, value, f"must be a whole number >= {rule.least}", hint, key=name)
            elif broken := rule.broken(value):
                hint = "give a length such as 2 mm" if rule.unit == "m" else "check its unit"
                raise InputError(what, rule.shown(value), broken, hint, key=name)


def _numbers(value: Any, declared: Any) -> Iterator[tuple[Any, In | Whole]]:
    """Each number of a value with what is declared of it."""
    if value is None:
        return
    if get_origin(declared) is Annotated:
        yield from ((value, rule) for rule in declared.__metadata__ if isinstance(rule, In | Whole))
    elif get_origin(declared) is tuple:
        kinds = get_args(declared)
        each = [kinds[0]] * len(value) if kinds[-1] is Ellipsis else kinds
        for one, kind in zip(value, each, strict=False):
            yield from _numbers(one, kind)
    else:  # one of several types
        for kind in get_args(declared):
            yield from _numbers(value, kind)
