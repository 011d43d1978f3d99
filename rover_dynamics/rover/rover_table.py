"""Tables of a rover's file, read key by key: what is missing, of another kind or unknown is told with its place.

Verified by tests/unit/test_rover_file.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from contracts.errors import InputError
from contracts.text import one_line
from rover_dynamics.rover.planets import gravity_named

__all__ = ["RoverTable", "is_finite"]


class RoverTable:
    """One table of the file; remembers which keys were asked for."""

    def __init__(self, place: str, content: Mapping[str, Any]) -> None:
        self.place, self.content = place, content
        self.asked: set[str] = set()
        self.parts: dict[str, RoverTable] = {}

    def get(self, key: str, kind: type | tuple[type, ...], words: str) -> Any:
        self.asked.add(key)
        if key not in self.content:
            raise InputError(f"{self.place}: {key}", "", "is missing", f"give {words}")
        value = self.content[key]
        if not isinstance(value, kind) or isinstance(value, bool) != (kind is bool):
            raise InputError(f"{self.place}: {key}", value, f"must be {words}", "see the file that ships")
        return value

    def number(self, key: str) -> float:
        value = self.get(key, (int, float), "a number")
        if not is_finite(value):
            raise InputError(f"{self.place}: {key}", value, "must be finite", "give a number")
        return float(value)

    def gravity(self, key: str) -> float:
        if isinstance(self.content.get(key), str):
            return gravity_named(self.word(key), f"{self.place}: {key}")
        value = self.number(key)
        if value <= 0.0:
            raise InputError(f"{self.place}: {key}", f"{value:g} m/s^2", "must be > 0", "give e.g. 3.711 or 'mars'")
        return value

    def word(self, key: str) -> str:
        word = one_line(str(self.get(key, str, "a word")))
        if not word.strip():
            raise InputError(f"{self.place}: {key}", repr(word), "is empty", "give a word")
        return word

    def flag(self, key: str) -> bool:
        return bool(self.get(key, bool, "true or false")) if key in self.content else False

    def three(self, key: str) -> tuple[float, float, float]:
        values = self.get(key, list, "three numbers")
        if len(values) != 3 or not all(type(v) in (int, float) and is_finite(v) for v in values):
            raise InputError(f"{self.place}: {key}", values, "must be three finite numbers", "x, y, z in SI")
        x, y, z = (float(v) for v in values)
        return x, y, z

    def inertia(self) -> tuple[float, float, float]:
        """Principal moments [kg m^2] that a rigid body can have: none is greater than the sum of the others."""
        moments = self.three("inertia")
        if min(moments) <= 0.0:
            rule, hint = "must be greater than zero", "give the moments about x, y, z in kg m^2"
            raise InputError(f"{self.place}: inertia", list(moments), rule, hint)
        if 2.0 * max(moments) > 1.01 * sum(moments):
            rule, hint = "one moment is greater than the sum of the others, as in no body", "check order and units"
            raise InputError(f"{self.place}: inertia", list(moments), rule, hint)
        return moments

    def axis(self) -> tuple[float, float, float]:
        """A direction [-] of any length above 1e-6."""
        direction = self.three("axis")
        if not math.hypot(*direction) > 1e-6:
            raise InputError(f"{self.place}: axis", list(direction), "is no direction", "give one such as [0, 1, 0]")
        return direction

    def table(self, key: str) -> RoverTable:
        if key not in self.parts:
            self.parts[key] = RoverTable(f"{self.place}: {key}", self.get(key, dict, "a table"))
        return self.parts[key]

    def rows(self, key: str) -> list[RoverTable]:
        found = self.get(key, list, "a list of tables")
        for k, row in enumerate(found):
            if not isinstance(row, dict):
                raise InputError(f"{self.place}: {key}[{k}]", row, "must be a table", f"begin it with [[{key}]]")
            self.parts.setdefault(f"{key}[{k}]", RoverTable(f"{self.place}: {key}[{k}]", row))
        return [self.parts[f"{key}[{k}]"] for k in range(len(found))]

    def some_rows(self, key: str) -> list[RoverTable]:
        found = self.rows(key)
        if not found:
            raise InputError(f"{self.place}: {key}", "", "must be one or more", f"give a table [[{key}]]")
        return found

    def finished(self) -> None:
        """Refuse keys nobody asked for."""
        unknown = sorted(set(self.content) - self.asked)
        if unknown:
            raise InputError(f"{self.place}: {unknown[0]}", self.content[unknown[0]], "is not a known key", "remove it")
        for part in self.parts.values():
            part.finished()


def is_finite(value: float) -> bool:
    """Whether a number is finite as a float: an integer of hundreds of digits is not."""
    try:
        return bool(np.isfinite(float(value)))
    except OverflowError:
        return False
