"""A rover described in a TOML file: bodies, pivots and legs as numbers, checked.

Verified by tests/unit/test_rover_file.py.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from contracts.errors import InputError
from contracts.input_file import input_text
from contracts.ranges import Key, dotted, oddities, range_table
from contracts.text import one_line

__all__ = [
    "EXOMARS_ROVER",
    "GRAVITIES",
    "SIDES",
    "BodyRow",
    "Leg",
    "PivotRow",
    "RoverDesign",
    "gravity_named",
    "read_rover",
]

EXOMARS_ROVER = Path(__file__).with_name("exomars_rover.toml")
_RANGES = Path(__file__).with_name("ranges.toml")
SIDES = {"left": 1.0, "right": -1.0}
"""Sign of y on each side."""
GRAVITIES = {"mars": 3.711, "earth": 9.81}
"""[m/s^2]."""
_LEG_BODIES = ("arm", "spindle", "wheel")


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyRow:
    """One body: mass [kg], principal inertia in vehicle axes [kg m^2], centre of mass [m], z above the wheel's axle."""

    name: str
    mass: float
    inertia: tuple[float, float, float]
    position: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class PivotRow:
    """A passive hinge between two bodies; position [m], z above the wheel's axle."""

    name: str
    first: str
    second: str
    position: tuple[float, float, float]
    axis: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """Deployment, steering and drive hinge of one wheel with the bodies between them; places as in `PivotRow`.

    Attributes
    ----------
    name : such as ``"front_left"``
    carrier : body it hangs on
    deployment, steering, drive : points of the three axes
    """

    name: str
    carrier: str
    deployment: tuple[float, float, float]
    steering: tuple[float, float, float]
    drive: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class RoverDesign:
    """A rover as numbers; mirrored rows have become two.

    Attributes
    ----------
    name, gravity : [m/s^2]
    wheel_radius, wheel_width : [m]
    bodies, pivots, legs : see there
    leg_bodies : arm, spindle and wheel of every leg; x and y of their positions are the drive's, z counts from the axle
    warnings : what is unusual in the file, a line each
    """

    name: str
    gravity: float
    wheel_radius: float
    wheel_width: float
    bodies: tuple[BodyRow, ...]
    pivots: tuple[PivotRow, ...]
    legs: tuple[Leg, ...]
    leg_bodies: tuple[BodyRow, ...]
    warnings: tuple[str, ...] = field(default=(), repr=False)

    @property
    def mass(self) -> float:
        """Of all bodies [kg]."""
        return sum(body.mass for body in self.bodies) + len(self.legs) * sum(body.mass for body in self.leg_bodies)

    @property
    def static_load(self) -> float:
        """Weight divided by the number of wheels [N]."""
        return self.mass * self.gravity / len(self.legs)


def gravity_named(name: str, what: str = "gravity") -> float:
    """Gravity of a planet [m/s^2]; raises InputError for one that is not known."""
    if name not in GRAVITIES:
        raise InputError(what, repr(name), "is not known", f"give {' or '.join(GRAVITIES)}")
    return GRAVITIES[name]


def read_rover(path: Path = EXOMARS_ROVER) -> RoverDesign:
    """Read a rover's file.

    Raises
    ------
    InputError
        For a file that cannot be read, a key that is missing or unknown, or a number that is none or that no rover has.
    """
    try:
        content = tomllib.loads(input_text(path, "rover file"))
    except InputError:
        raise
    except (ValueError, RecursionError) as error:  # also numbers of thousands of digits, brackets in thousands
        raise InputError(
            "rover file", path, f"cannot be read ({error})", "copy rover_dynamics' own and edit it"
        ) from error
    rover = _Reader(str(path), content)
    warnings = _unusual(path, content)
    wheel, legs = rover.table("wheel"), rover.some_rows("legs")
    design = RoverDesign(
        warnings=warnings,
        name=rover.word("name"),
        gravity=rover.gravity("gravity"),
        wheel_radius=wheel.number("radius"),
        wheel_width=wheel.number("width"),
        bodies=tuple(body for row in rover.some_rows("bodies") for body in _bodies(row)),
        pivots=tuple(pivot for row in rover.rows("pivots") for pivot in _pivots(row)),
        legs=tuple(leg for row in legs for leg in _legs(row, rover)),
        leg_bodies=tuple(_leg_body(name, rover.table("leg_bodies").table(name)) for name in _LEG_BODIES),
    )
    rover.finished()
    return design


def _unusual(path: Path, content: Mapping[str, Any]) -> tuple[str, ...]:
    """What is unusual, a line each; raises InputError for what is impossible."""
    found = []
    for odd in oddities(dict(_numbers((), content)), range_table(_RANGES)):
        if odd.impossible:
            raise InputError(f"{path}: {dotted(odd.key)}", odd.value, odd.rule, odd.hint)
        found.append(f"{dotted(odd.key)}{f' = {odd.value}' * bool(odd.value)} {odd.rule}; {odd.hint}")
    return tuple(found)


def _numbers(key: Key, value: object) -> Iterator[tuple[Key, float]]:
    """Every finite number by its path; what is none is found where it is asked for."""
    if isinstance(value, dict | list):
        for part, content in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _numbers((*key, part), content)
    elif isinstance(value, int | float) and not isinstance(value, bool) and _finite(value):
        yield key, float(value)


class _Reader:
    """One table of the file; remembers which keys were asked for."""

    def __init__(self, place: str, content: Mapping[str, Any]) -> None:
        self.place, self.content = place, content
        self.asked: set[str] = set()
        self.parts: dict[str, _Reader] = {}

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
        if not _finite(value):
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
        return one_line(str(self.get(key, str, "a word")))

    def flag(self, key: str) -> bool:
        return bool(self.get(key, bool, "true or false")) if key in self.content else False

    def three(self, key: str) -> tuple[float, float, float]:
        values = self.get(key, list, "three numbers")
        if len(values) != 3 or not all(type(v) in (int, float) and _finite(v) for v in values):
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
        """A direction; its length says nothing, but has to be one."""
        direction = self.three("axis")
        if not math.hypot(*direction) > 1e-6:
            raise InputError(f"{self.place}: axis", list(direction), "is no direction", "give one such as [0, 1, 0]")
        return direction

    def table(self, key: str) -> _Reader:
        if key not in self.parts:
            self.parts[key] = _Reader(f"{self.place}: {key}", self.get(key, dict, "a table"))
        return self.parts[key]

    def rows(self, key: str) -> list[_Reader]:
        found = self.get(key, list, "a list of tables")
        for k, row in enumerate(found):
            if not isinstance(row, dict):
                raise InputError(f"{self.place}: {key}[{k}]", row, "must be a table", f"begin it with [[{key}]]")
            self.parts.setdefault(f"{key}[{k}]", _Reader(f"{self.place}: {key}[{k}]", row))
        return [self.parts[f"{key}[{k}]"] for k in range(len(found))]

    def some_rows(self, key: str) -> list[_Reader]:
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


def _finite(value: float) -> bool:
    """Whether a number is finite as a float: an integer of hundreds of digits is not."""
    try:
        return bool(np.isfinite(float(value)))
    except OverflowError:
        return False


def _sides(row: _Reader) -> dict[str, float]:
    """Suffix of the name and sign of y."""
    return {f"_{side}": sign for side, sign in SIDES.items()} if row.flag("mirrored") else {"": 1.0}


def _mirrored(point: tuple[float, float, float], sign: float) -> tuple[float, float, float]:
    return point[0], sign * point[1], point[2]


def _bodies(row: _Reader) -> list[BodyRow]:
    name, mass, inertia, position = row.word("name"), row.number("mass"), row.inertia(), row.three("position")
    return [
        BodyRow(name=name + side, mass=mass, inertia=inertia, position=_mirrored(position, sign))
        for side, sign in _sides(row).items()
    ]


def _pivots(row: _Reader) -> list[PivotRow]:
    name, first, second = row.word("name"), row.word("first"), row.word("second")
    position, axis = row.three("position"), row.axis()
    return [
        PivotRow(name=name + side, first=first, second=second + side, position=_mirrored(position, sign), axis=axis)
        for side, sign in _sides(row).items()
    ]


def _legs(row: _Reader, rover: _Reader) -> list[Leg]:
    name, carrier = row.word("name"), row.word("carrier")
    mirrored = any(body.word("name") == carrier and body.flag("mirrored") for body in rover.rows("bodies"))
    points = {key: row.three(key) for key in ("deployment", "steering", "drive")}
    return [
        Leg(
            name=f"{name}_{side}",
            carrier=f"{carrier}_{side}" if mirrored else carrier,
            **{key: _mirrored(point, sign) for key, point in points.items()},
        )
        for side, sign in SIDES.items()
    ]


def _leg_body(name: str, row: _Reader) -> BodyRow:
    position = (0.0, 0.0, row.number("above_axle"))
    return BodyRow(name=name, mass=row.number("mass"), inertia=row.inertia(), position=position)
