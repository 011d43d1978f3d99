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
    """Motor numbers are those before the gear."""
    gear, given = row.number("gear") if "gear" in row.content else 1.0, set(row.content)
    if not gear > 0.0:
        raise InputError(f"{row.place}: gear", f"{gear:g}", "must be > 0", "motor turns by wheel turn, e.g. 1000")
    at_wheel = {"torque_limit": gear, "stall_torque": gear, "no_load_speed": 1.0 / gear, "gain": 1.0, "efficiency": 1.0}
    motor = {key: times * row.number(key) for key, times in at_wheel.items() if key in given}
    control: dict[str, Any] = {key: row.number(key) for key in ("allowed_slip", "share_gain") if key in given}
    if "controller" in given:
        word = row.word("controller")
        if word not in list(Controller):
            known = ", ".join(Controller)
            raise InputError(f"{row.place}: controller", repr(word), "is not known", f"give one of {known}")
        control["controller"] = Controller(word)
    for key, needs in (("allowed_slip", Controller.SLIP), ("share_gain", Controller.SHARED)):
        if key in control and control.get("controller", Controller.SPEED) is not needs:
            rule = f"counts with controller = '{needs}' only"
            raise InputError(f"{row.place}: {key}", f"{control[key]:g}", rule, "remove it, or name that controller")
    return WheelDrive(motor=Motor(**motor), control=DriveControl(**control))


def _leg_body(name: str, row: RoverTable) -> BodyRow:
    position = (0.0, 0.0, row.number("above_axle"))
    return BodyRow(name=name, mass=row.number("mass"), inertia=row.inertia(), position=position)
