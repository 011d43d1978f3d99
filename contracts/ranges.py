"""Which numbers can be: ranges of a quantity in its context, and of one number beside another, as rows of a table.

A number outside its possible range is refused: no wheel of any size has it, or it breaks the arithmetic. One outside
its usual range is used, and told: most often a unit was mistaken. The tables are data: ``workbench/data/ranges.toml``
for the study file, ``rover_dynamics/rover/ranges.toml`` for the rover file. Verified by tests/unit/test_ranges.py.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

__all__ = ["Key", "Oddity", "Range", "RangeTable", "Ratio", "dotted", "oddities", "range_table"]

type Key = tuple[str | int, ...]
"""Path of a number in its file: ``("wheel", "springs", 0, "thickness")``."""
type Limits = tuple[float, float]
"""Smallest and largest magnitude, both included."""

_SCALES = {
    **{"": 1.0, "m": 1.0, "mm": 1e-3, "deg": math.pi / 180.0, "K": 1.0, "m/s^2": 1.0},
    **{"kg": 1.0, "kg m^2": 1.0, "kg/m^3": 1.0, "MPa": 1e6, "GPa": 1e9},
    **{"N": 1.0, "N/m": 1.0, "N/m^3": 1.0, "N*s/m": 1.0, "N m": 1.0, "rad/s": 1.0, "N m s/rad": 1.0},
}
"""Unit in which a row states its limits -> its size in SI."""
_SLACK = 1e-9
"""Relative; 0.2 mm is not exactly 0.0002."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """The magnitude of one quantity in one context.

    Attributes
    ----------
    keys : dotted paths of the numbers it holds for; ``*`` stands for any one part
    what : the quantity and its context, as in "unusual for ..."
    unit : of the limits, see `_SCALES`
    possible, usual : limits
    hint : what to try
    zero : whether zero is as good as a usual number; what is all but zero, such as the sine of 180 degrees, is
        then told and never refused
    positive : whether a negative number is unusual, whatever its magnitude
    """

    keys: tuple[str, ...]
    what: str
    unit: str
    possible: Limits
    usual: Limits
    hint: str
    zero: bool = False
    positive: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Ratio:
    """The magnitude of the number at ``key`` over that ``beside`` it; a ``*`` in both stands for the same part."""

    key: str
    beside: str
    possible: Limits
    usual: Limits


@dataclass(frozen=True, slots=True, kw_only=True)
class RangeTable:
    """The rows of one kind of file."""

    ranges: tuple[Range, ...]
    ratios: tuple[Ratio, ...]

    def row(self, key: Key) -> Range | None:
        """The row of a number: the first one that names it; None if none does."""
        return next((row for row in self.ranges if any(_stars(key, own) is not None for own in row.keys)), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Oddity:
    """A number outside one of its ranges: where, the number with its unit, what it breaks, what to try."""

    key: Key
    value: str
    rule: str
    hint: str
    impossible: bool


@cache
def range_table(path: Path) -> RangeTable:
    """The table in a TOML file of the package: ``[[range]]`` and ``[[ratio]]`` with the fields of `Range`, `Ratio`."""
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    return RangeTable(
        ranges=tuple(Range(**_frozen(row)) for row in content["range"]),
        ratios=tuple(Ratio(**_frozen(row)) for row in content["ratio"]),
    )


def _frozen(row: Mapping[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value for name, value in row.items()}


def oddities(numbers: Mapping[Key, float], table: RangeTable) -> Iterator[Oddity]:
    """Each of the ``numbers`` (SI, by their paths) outside a range of its own, then each ratio outside one."""
    for key, number in numbers.items():
        row = table.row(key)
        if row is not None and not (row.zero and number == 0.0):
            yield from _of_range(key, number, row)
    for ratio in table.ratios:
        for key in numbers:
            yield from _of_ratio(key, numbers, ratio)


def dotted(key: Key) -> str:
    """``("wheel", "springs", 0, "count")`` -> ``wheel.springs[0].count``."""
    text = ""
    for part in key:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def _of_range(key: Key, number: float, row: Range) -> Iterator[Oddity]:
    size = abs(number) / _SCALES[row.unit]
    value = _quantity(math.copysign(size, number), row.unit)
    low, high = (_quantity(limit, row.unit) for limit in row.possible)
    if not (_within(size, row.possible) or (row.zero and size < row.possible[0])):
        span = f"must not exceed {high}" if row.zero else f"must lie between {low} and {high}"
        rule = span + (" in magnitude" if number < 0.0 else "")
        yield Oddity(key=key, value=value, rule=rule, hint=row.hint, impossible=True)
    elif not _within(size, row.usual) or (row.positive and number < 0.0):
        low, high = (_quantity(limit, row.unit) for limit in row.usual)
        rule = f"is unusual for {row.what} ({low} to {high})"
        yield Oddity(key=key, value=value, rule=rule, hint=row.hint, impossible=False)


def _of_ratio(key: Key, numbers: Mapping[Key, float], ratio: Ratio) -> Iterator[Oddity]:
    stars = iter(_stars(key, ratio.key) or ())
    if _stars(key, ratio.key) is None:
        return
    other = tuple(next(stars) if part == "*" else part for part in ratio.beside.split("."))
    if not numbers.get(other):
        return
    size = abs(numbers[key] / numbers[other])
    if _within(size, ratio.possible) and _within(size, ratio.usual):
        return
    impossible = not _within(size, ratio.possible)
    low, high = (_quantity(limit) for limit in (ratio.possible if impossible else ratio.usual))
    words = f"must lie between {low} and {high} times" if impossible else f"is unusual beside ({low} to {high} times)"
    rule = f"{words} {dotted(other)}, and is {_quantity(float(f'{size:.3g}'))} times"
    yield Oddity(key=key, value="", rule=rule, hint="check the units of both", impossible=impossible)


def _within(size: float, limits: Limits) -> bool:
    return limits[0] * (1.0 - _SLACK) <= size <= limits[1] * (1.0 + _SLACK)


@lru_cache(200_000)  # a sweep asks the same of each of its points
def _stars(key: Key, pattern: str) -> tuple[str | int, ...] | None:
    """What the stars of a pattern stand for in a key; None if the key is another."""
    parts = pattern.split(".")
    if len(parts) != len(key) or any(part not in ("*", str(own)) for part, own in zip(parts, key, strict=True)):
        return None
    return tuple(own for part, own in zip(parts, key, strict=True) if part == "*")


def _quantity(number: float, unit: str = "") -> str:
    text = f"{number:.6g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")
    return f"{text} {unit}".rstrip()
