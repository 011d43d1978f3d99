"""A rover and its ground as solids: box, bars between the joints, wheels with grousers, a chequered piece of terrain.

Joints and wheels are where the design puts them. Shapes of the bodies between them are published nowhere; they are
sketched. Verified by tests/unit/test_workbench_rover_animation.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import PieceKind, Terrain
from rover_dynamics.multibody.body import RigidBody
from rover_dynamics.rover.rover import build_rover
from rover_dynamics.rover.rover_file import Leg, RoverDesign
from workbench.charts.solids import WORLD, Quads, Solid, bar, box, joined, tube

__all__ = ["MARKER", "body_names", "ground_solids", "rover_solids", "square_size"]

FloatArray = NDArray[np.float64]

MARKER = "#d55e00"
"""Colour of the one grouser and spoke of each wheel by which its turning is seen."""
_CHASSIS, _BOGIE, _ARM, _SPINDLE, _RIM, _GROUSER = "#e6b84a", "#0072b2", "#56b4e9", "#777777", "#b5b5b5", "#333333"
_GROUND = np.array([(222, 205, 180), (198, 178, 150)], dtype=np.uint8)
_SIDE = "#8a7458"
_BAR = 0.035
_GROUSERS = 18
_MARGIN = 0.25
_CELLS = 300


def body_names(design: RoverDesign) -> tuple[str, ...]:
    """Names of the bodies, in the order of a motion's arrays."""
    return tuple(body.name for body in _bodies(design))


def rover_solids(design: RoverDesign, hub_radius: float | None = None) -> list[Solid]:
    """All bodies, each in its own frame; wheels in three colours.

    hub_radius : of wheels [m] of which only the hub is drawn, because their tires deform; None for whole wheels
    """
    bodies = {body.name: (number, body) for number, body in enumerate(_bodies(design))}
    joints = _joint_points(design)
    solids = []
    for name, (number, body) in bodies.items():
        if len(joints.get(name, ())) > 1:
            first, *others = joints[name]
            solids.append(_solid(number, body, [bar(first, other, _BAR) for other in others], _BOGIE))
        elif not name.startswith(("arm_", "spindle_", "wheel_")):
            solids.append(_solid(number, body, [_chassis(body)], _CHASSIS))
    for leg in design.legs:
        arm, spindle, wheel = (bodies[f"{part}_{leg.name}"] for part in ("arm", "spindle", "wheel"))
        solids.append(_solid(*arm, [bar(leg.deployment, leg.steering, _BAR)], _ARM))
        solids.append(_solid(*spindle, _fork(leg, design.wheel_width), _SPINDLE))
        whole = design.wheel_radius, design.wheel_width
        shown = _wheel(leg.drive, *whole) if hub_radius is None else _hub(leg.drive, hub_radius, design.wheel_width)
        for pieces, colour in shown:
            solids.append(_solid(*wheel, pieces, colour))
    return solids


def ground_solids(terrain: Terrain, places: FloatArray) -> list[Solid]:
    """The terrain under a path as a chequered slab; places (n, 2) float [m], x and y that it has to hold.

    A height field ends where its heights end.
    """
    low, high = _covered(terrain, places.min(axis=0) - _MARGIN, places.max(axis=0) + _MARGIN)
    square = square_size(places)
    x, y = _grid(terrain, low, high, square)
    X, Y = np.meshgrid(x, y, indexing="ij")
    surface = np.stack([X, Y, terrain.height(X, Y)], axis=-1)
    number = np.arange(X.size).reshape(X.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    centres = 0.25 * surface.reshape(-1, 3)[quads].sum(axis=1)
    chequer = np.floor(centres[:, :2] / square).astype(np.int64).sum(axis=1) % 2
    floor = float(surface[..., 2].min()) - 0.05
    borders = [surface[:, 0], surface[-1], surface[::-1, -1], surface[0, ::-1]]
    sides, side_quads = joined([_curtain(border, floor) for border in borders])
    return [
        Solid(body=WORLD, points=surface.reshape(-1, 3), quads=quads, colours=_GROUND[chequer]),
        Solid(body=WORLD, points=sides, quads=side_quads, colours=_SIDE),
    ]


def square_size(places: FloatArray) -> float:
    """Side of a square of the ground [m] under places (n, 2) [m]."""
    return 0.25 if float(np.ptp(places, axis=0).max()) < 8.0 else 1.0


def _bodies(design: RoverDesign) -> tuple[RigidBody, ...]:
    """As they stand with the axles at z = 0, the height the design counts from."""
    return build_rover(design, height=-design.wheel_radius).model.bodies


def _solid(number: int, body: RigidBody, pieces: list[Quads], colour: str) -> Solid:
    """Pieces given where the rover stands at the start, taken into the body's frame."""
    points, quads = joined(pieces)
    return Solid(body=number, points=(points - body.position) @ body.rotation, quads=quads, colours=colour)


def _joint_points(design: RoverDesign) -> dict[str, list[tuple[float, float, float]]]:
    """Of each body on a pivot: the pivot, then the pivots and deployment axes it carries."""
    points = {pivot.second: [pivot.position] for pivot in design.pivots}
    for pivot in design.pivots:
        if pivot.first in points:
            points[pivot.first].append(pivot.position)
    for leg in design.legs:
        if leg.carrier in points:
            points[leg.carrier].append(leg.deployment)
    return points


def _chassis(body: RigidBody) -> Quads:
    """Box with the proportions of the one of equal mass and inertia; smaller, since masts and panels are left out."""
    total = 0.5 * np.trace(body.inertia)
    squares = 12.0 / body.mass * (total - np.diag(body.inertia))
    return box(body.position, 0.6 * np.sqrt(np.maximum(squares, 1e-4)))


def _fork(leg: Leg, width: float) -> list[Quads]:
    """From the steering axis over the wheel's inner side to its axle."""
    axle, top = np.array(leg.drive), np.array(leg.steering)
    inner = axle - (0.0, np.sign(axle[1] or 1.0) * (0.5 * width + _BAR), 0.0)
    corner = np.array([inner[0], inner[1], top[2]])
    return [bar(top, corner, _BAR), bar(corner, inner, _BAR), bar(inner, axle, _BAR)]


def _wheel(centre: tuple[float, float, float], radius: float, width: float) -> list[tuple[list[Quads], str]]:
    """Rim and spokes, grousers, and the marked grouser with its spoke; at the start the mark is ahead of the axle."""
    middle, rim = np.array(centre), 0.93 * radius
    ring = [tube(middle, (0.88 * radius, rim), width), tube(middle, (0.0, 0.25 * radius), width, 24)]
    spokes = [_radial(middle, (0.1 * radius, rim), width, turn) for turn in np.arange(1, 6) * np.pi / 3.0]
    turns = 2.0 * np.pi * np.arange(1, _GROUSERS) / _GROUSERS
    grousers = [_radial(middle, (rim, radius), width, turn) for turn in turns]
    mark = [_radial(middle, (0.2 * radius, radius), width, 0.0)]
    return [(ring + spokes, _RIM), (grousers, _GROUSER), (mark, MARKER)]


def _hub(centre: tuple[float, float, float], radius: float, width: float) -> list[tuple[list[Quads], str]]:
    """A hub on which a tire is tied, with a mark across it; at the start the mark is ahead of the axle."""
    middle = np.array(centre)
    return [
        ([tube(middle, (0.0, radius), width)], _RIM),
        ([_radial(middle, (0.0, 0.98 * radius), 1.02 * width, 0.0)], MARKER),
    ]


def _radial(middle: FloatArray, ends: tuple[float, float], width: float, turn: float) -> Quads:
    """A thin plate across the wheel between two radii, turned about the axle."""
    points, quads = box((0.5 * (ends[0] + ends[1]), 0.0, 0.0), (ends[1] - ends[0], 1.01 * width, 0.01))
    c, s = np.cos(turn), np.sin(turn)
    return middle + points @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]), quads


def _covered(terrain: Terrain, low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A rectangle, cut where height fields end."""
    pieces = terrain.pieces()
    for row in pieces.rows[pieces.rows[:, 0] == PieceKind.HEIGHT_FIELD]:
        end = row[1:3] + row[3:5] * (np.array(pieces.knots.shape) - 3)
        low, high = np.maximum(low, row[1:3]), np.minimum(high, end)
    return low, high


def _grid(terrain: Terrain, low: FloatArray, high: FloatArray, square: float) -> tuple[FloatArray, FloatArray]:
    """Lines of x and of y [m]: all borders of squares, and between them those where the ground bends."""
    cell = max(0.01, float((high - low).max()) / _CELLS)
    borders = [square * np.arange(np.ceil(a / square), b / square) for a, b in zip(low, high, strict=True)]
    fine = [np.linspace(a, b, int((b - a) / cell) + 2) for a, b in zip(low, high, strict=True)]
    x, y = (np.union1d(lines, border) for lines, border in zip(fine, borders, strict=True))
    heights = terrain.height(*np.meshgrid(x, y, indexing="ij"))
    return x[_bends(x, heights) | np.isin(x, borders[0])], y[_bends(y, heights.T) | np.isin(y, borders[1])]


def _bends(lines: FloatArray, heights: FloatArray) -> NDArray[np.bool_]:
    """Whether slopes differ before and behind each line, by more than rounding; the ends count as bends."""
    slopes = np.diff(heights, axis=0) / np.diff(lines)[:, None]
    inside = np.any(np.abs(np.diff(slopes, axis=0)) > 1e-6, axis=1)
    return np.concatenate([[True], inside, [True]])


def _curtain(border: FloatArray, floor: float) -> Quads:
    """Upright side of the slab below one border of its surface."""
    n = len(border)
    k = np.arange(n - 1)
    foot = np.column_stack([border[:, :2], np.full(n, floor)])
    return np.concatenate([foot, border]), np.column_stack([k, k + 1, k + 1 + n, k + n])
