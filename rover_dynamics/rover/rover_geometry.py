"""Whether a rover can be so: wheels apart from each other, bodies above the ground, loads that only push.

Verified by tests/unit/test_rover_geometry.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations

import numpy as np

from contracts.errors import InputError
from rover_dynamics.rover.rover_design import SIDES, BodyRow, PivotRow, RoverDesign

__all__ = ["require_standing", "strange_places"]

_UNBALANCED = 1e-6
"""Metres of the centre of mass, round-off of one that lies on the edge."""
_LEVEL = 0.1
"""Of the wheel's radius."""


def require_standing(place: str, design: RoverDesign) -> None:
    """Raise InputError for a rover that cannot be, or that tips over on level ground.

    Parameters
    ----------
    place : its file, for the message
    design : as read
    """
    _require_apart(place, design)
    ground = -design.wheel_radius
    for name, (_, _, z) in _centres(design):
        if z < ground:
            rule = f"is the centre of mass of {name}, below the ground, which is {-ground:g} m below the wheels' axles"
            raise InputError(f"{place}: height", f"{z:g} m", rule, "heights are counted upwards from the axles")
    wheel = next(body for body in design.leg_bodies if body.name == "wheel")
    if abs(wheel.position[2]) >= design.wheel_radius:
        rule = f"lies outside the wheel, whose radius is {design.wheel_radius:g} m"
        raise InputError(f"{place}: leg_bodies.wheel: above_axle", f"{wheel.position[2]:g} m", rule, "give e.g. 0")
    _require_support(place, design)


def strange_places(design: RoverDesign) -> Iterator[str]:
    """What is unusual in where things are, a line each."""
    lowest, highest = (end(design.legs, key=lambda leg: leg.drive[2]) for end in (min, max))
    if highest.drive[2] - lowest.drive[2] > _LEVEL * design.wheel_radius:
        apart = f"{highest.drive[2] - lowest.drive[2]:.4g} m higher than wheel {lowest.name}"
        yield f"wheel {highest.name} is {apart}: they do not stand on level ground; check the drives' heights"
    yield from _mirrored_in_the_middle(design)
    for row in design.leg_bodies:
        top = max(max(leg.deployment[2], leg.steering[2]) - leg.drive[2] for leg in design.legs)
        beyond = max(row.position[2] - max(top, 0.0), min(top, 0.0) - row.position[2])
        if beyond > design.wheel_radius:
            where = f"{beyond:.4g} m beyond the leg's own hinges"
            yield f"leg_bodies.{row.name}.above_axle = {row.position[2]:g} m lies {where}; check its sign and unit"


def _mirrored_in_the_middle(design: RoverDesign) -> Iterator[str]:
    """Rows of the left that are not on the left; what hangs in the middle is in one place with its mirror image."""
    rows = [("bodies", row.name, row.position) for row in design.bodies]
    rows += [("pivots", row.name, row.position) for row in design.pivots]
    rows += [("legs", leg.name, leg.drive) for leg in design.legs]
    names = {(kind, name) for kind, name, _ in rows}
    left, right = (f"_{side}" for side in SIDES)
    for kind, name, (_, y, _) in rows:
        if name.endswith(left) and (kind, name.removesuffix(left) + right) in names and y <= 0.0:
            where = "on y = 0, in one place with its mirror image" if y == 0.0 else "on the right (y < 0)"
            yield f"{kind} {name} is {where}; a row of a mirrored pair stands for its left side"


def _require_apart(place: str, design: RoverDesign) -> None:
    """No two wheels, as cylinders with axles along y, have a point in common."""
    for one, other in combinations(design.legs, 2):
        x, y, z = (abs(a - b) for a, b in zip(one.drive, other.drive, strict=True))
        if math.hypot(x, z) < design.wheel_radius * 2.0 and y < design.wheel_width:
            size = f"{2.0 * design.wheel_radius:g} m x {design.wheel_width:g} m"
            rule = (
                f"overlap: of {size}, their centres are {math.hypot(x, z):.4g} m apart in plane and {y:.4g} m along y"
            )
            raise InputError(f"{place}: wheels", f"{one.name} and {other.name}", rule, "check the legs' drives")


def _centres(design: RoverDesign) -> Iterator[tuple[str, tuple[float, float, float]]]:
    """Centres of mass by name, z from the axles."""
    yield from ((row.name, row.position) for row in design.bodies)
    for leg in design.legs:
        for row in design.leg_bodies:
            yield f"{row.name}_{leg.name}", _of_leg(row, leg.drive)


def _of_leg(row: BodyRow, drive: tuple[float, float, float]) -> tuple[float, float, float]:
    return drive[0] + row.position[0], drive[1] + row.position[1], drive[2] + row.position[2]


def _require_support(place: str, design: RoverDesign) -> None:
    """Raise InputError where no loads that push balance the weight on level ground.

    Virtual work: in heave, pitch, roll and a turn of each passive hinge with wheels behind it, the loads (n_w,) do as
    much as the weight. The hinges matter: a rear bogie that turns about x shares its load evenly, however far the
    centre of mass lies to one side.
    """
    from scipy.optimize import nnls

    bodies = {body.name for body in design.bodies}
    if not bodies >= {leg.carrier for leg in design.legs} | {p.first for p in design.pivots} | _carried(design).keys():
        return  # told when the vehicle is built
    weights = [(body.name, body.mass, body.position) for body in design.bodies]
    weights += [(leg.carrier, row.mass, _of_leg(row, leg.drive)) for leg in design.legs for row in design.leg_bodies]
    share = np.array([mass for _, mass, _ in weights]) / design.mass
    wheels = np.array([_rises(design, leg.carrier, leg.drive) for leg in design.legs]).T
    weight = np.array([_rises(design, carrier, point) for carrier, _, point in weights]).T @ share
    with_wheels = np.abs(wheels).max(axis=1) > 0.0
    _, missing = nnls(wheels[with_wheels], weight[with_wheels])
    if missing > _UNBALANCED:
        x, y, _ = share @ np.array([point for _, _, point in weights])
        rule = "tips over on level ground: no loads that push on its wheels balance its weight"
        hint = "move it between the wheels"
        raise InputError(f"{place}: centre of mass of the rover", f"x = {x:.4g} m, y = {y:.4g} m", rule, hint)


def _carried(design: RoverDesign) -> dict[str, PivotRow]:
    """The hinge that each body hangs on."""
    return {pivot.second: pivot for pivot in design.pivots}


def _rises(design: RoverDesign, carrier: str, point: tuple[float, float, float]) -> list[float]:
    """How far a point fixed to a body rises: per heave, pitch and roll of all [-, m, m], per turn of each hinge [m]."""
    carried, hinges = _carried(design), list[str]()
    while carrier in carried and carrier not in hinges:
        hinges.append(carrier)
        carrier = carried[carrier].first
    rises = [1.0, point[0], point[1]]
    for pivot in design.pivots:
        x, y = point[0] - pivot.position[0], point[1] - pivot.position[1]
        turned = (pivot.axis[0] * y - pivot.axis[1] * x) / math.hypot(*pivot.axis)
        rises.append(turned if pivot.second in hinges else 0.0)
    return rises
