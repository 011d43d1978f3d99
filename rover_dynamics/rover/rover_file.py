"""A rover described in a TOML file: bodies, pivots and legs as numbers, checked.

Verified by tests/unit/test_rover_file.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.input_file import input_table
from contracts.ranges import Key, dotted, oddities, range_table
from rover_dynamics.rover.rover_design import SIDES, BodyRow, Leg, PivotRow, RoverDesign, WheelDrive
from rover_dynamics.rover.rover_geometry import require_standing, strange_places
from rover_dynamics.rover.rover_table import RoverTable, is_finite
from rover_dynamics.vehicle.drive_control import Controller, DriveControl
from rover_dynamics.vehicle.motors import Motor

__all__ = [
    "EXOMARS_ROVER",
    "SIDES",
    "BodyRow",
    "Leg",
    "PivotRow",
    "RoverDesign",
    "WheelDrive",
    "read_rover",
]

EXOMARS_ROVER = Path(__file__).with_name("exomars_rover.toml")
_RANGES = Path(__file__).with_name("ranges.toml")
_LEG_BODIES = ("arm", "spindle", "wheel")
_DRIVE_UNITS = {
    "gear": "",
    "torque_limit": "N m",
    "stall_torque": "N m",
    "no_load_speed": "rad/s",
    "gain": "N m s/rad",
    "efficiency": "",
    "allowed_slip": "",
    "share_gain": "N m s/rad",
}
_POWERS_OF_GEAR = {"torque_limit": 1, "stall_torque": 1, "no_load_speed": -1}
"""Of the gear by which the wheel's shaft shows a number of the motor."""
_OF_CONTROL = ("allowed_slip", "share_gain")
_COUNTS_WITH = {
    "gain": (Controller.SPEED, Controller.SLIP),
    "allowed_slip": (Controller.SLIP,),
    "share_gain": (Controller.SHARED,),
}


def read_rover(path: Path = EXOMARS_ROVER) -> RoverDesign:
    """Read a rover's file.

    Raises
    ------
    InputError
        For a file that cannot be read, a key that is missing or unknown, a number that is none or that no rover has,
        or a rover that cannot be so or tips over.
    """
    content = input_table(path, "rover file", "rover_dynamics/rover/exomars_rover.toml")
    rover = RoverTable(str(path), content)
    warnings = _unusual(path, content)
    wheel, legs = rover.table("wheel"), rover.some_rows("legs")
    design = RoverDesign(
        name=rover.word("name"),
        gravity=rover.gravity("gravity"),
        wheel_radius=wheel.number("radius"),
        wheel_width=wheel.number("width"),
        bodies=tuple(body for row in rover.some_rows("bodies") for body in _bodies(row)),
        pivots=tuple(pivot for row in rover.rows("pivots") for pivot in _pivots(row)),
        legs=tuple(leg for row in legs for leg in _legs(row, rover)),
        leg_bodies=tuple(_leg_body(name, rover.table("leg_bodies").table(name)) for name in _LEG_BODIES),
        drive=_drive(rover.table("drive")) if "drive" in content else None,
    )
    rover.finished()
    if path != EXOMARS_ROVER:  # it stands, a test says so; to ask costs a study half a second each time it is planned
        require_standing(str(path), design)
    return replace(design, warnings=(*warnings, *strange_places(design)))


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
    elif isinstance(value, int | float) and not isinstance(value, bool) and is_finite(value):
        yield key, float(value)


def _sides(row: RoverTable) -> dict[str, float]:
    """Suffix of the name and sign of y."""
    return {f"_{side}": sign for side, sign in SIDES.items()} if row.flag("mirrored") else {"": 1.0}


def _mirrored(point: tuple[float, float, float], sign: float) -> tuple[float, float, float]:
    return point[0], sign * point[1], point[2]


def _bodies(row: RoverTable) -> list[BodyRow]:
    name, mass, inertia, position = row.word("name"), row.number("mass"), row.inertia(), row.three("position")
    return [
        BodyRow(name=name + side, mass=mass, inertia=inertia, position=_mirrored(position, sign))
        for side, sign in _sides(row).items()
    ]


def _pivots(row: RoverTable) -> list[PivotRow]:
    name, first, second = row.word("name"), row.word("first"), row.word("second")
    position, axis = row.three("position"), row.axis()
    return [
        PivotRow(name=name + side, first=first, second=second + side, position=_mirrored(position, sign), axis=axis)
        for side, sign in _sides(row).items()
    ]


def _legs(row: RoverTable, rover: RoverTable) -> list[Leg]:
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


def _drive(row: RoverTable) -> WheelDrive:
    """Motor numbers are those before the gear; what is wrong is told as the file has it."""
    numbers = {key: _positive(row, key, unit) for key, unit in _DRIVE_UNITS.items() if key in row.content}
    controller = _controller(row)
    for key, needs in _COUNTS_WITH.items():
        if key in numbers and controller not in needs:
            rule = f"counts with controller = {' or '.join(repr(one.value) for one in needs)} only"
            raise InputError(f"{row.place}: {key}", f"{numbers[key]:g}", rule, "remove it, or name that controller")
    ends = [key for key in ("stall_torque", "no_load_speed") if key not in numbers]
    if len(ends) == 1:
        hint = "stall_torque and no_load_speed are the two ends of one line: give both, or none"
        raise InputError(f"{row.place}: {ends[0]}", "", "is missing", hint)
    gear, control = numbers.pop("gear", 1.0), {key: numbers.pop(key) for key in _OF_CONTROL if key in numbers}
    motor = {key: gear ** _POWERS_OF_GEAR.get(key, 0) * value for key, value in numbers.items()}
    return WheelDrive(motor=Motor(**motor), control=DriveControl(controller=controller, **control))


def _positive(row: RoverTable, key: str, unit: str) -> float:
    value = row.number(key)
    if not value > 0.0:
        hint = "leave it out for the usual one, or for none"
        raise InputError(f"{row.place}: {key}", f"{value:g} {unit}".rstrip(), "must be > 0", hint)
    return value


def _controller(row: RoverTable) -> Controller:
    word = row.word("controller") if "controller" in row.content else Controller.SPEED
    if word not in list(Controller):
        known = ", ".join(Controller)
        raise InputError(f"{row.place}: controller", repr(word), "is not known", f"give one of {known}")
    return Controller(word)


def _leg_body(name: str, row: RoverTable) -> BodyRow:
    position = (0.0, 0.0, row.number("above_axle"))
    return BodyRow(name=name, mass=row.number("mass"), inertia=row.inertia(), position=position)
