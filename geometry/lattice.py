"""A lattice of straight walls between hub ring and rim: honeycomb or re-entrant cells around the wheel.

Radial walls stand in rows. Between two rows lies a ring of oblique walls, which leads from the outer ends of the inner
row to the inner ends of the outer one, half a pitch further; so three walls meet in every joint. In a honeycomb oblique
walls rise outwards from the inner row's ends; in a re-entrant lattice they fall back inwards, and its cells are bow
ties, which narrow when they are pressed (negative Poisson ratio; Gibson & Ashby, Cellular Solids, 2nd ed., 1997, ch. 4:
h, l, t and theta are the radial and oblique lengths, thickness and angle here).
Verified by tests/unit/test_geometry_lattice.py and tests/verification/test_lattice_frame.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
import shapely  # type: ignore[import-untyped]
from numpy.typing import NDArray

from contracts.declared import Angle, Count, PositiveLength, require_declared
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V, Material
from geometry.parts import Bands
from geometry.rules import require_bands
from geometry.springs import polar

__all__ = [
    "CELL",
    "JOINTS",
    "LATTICE",
    "Joint",
    "Lattice",
    "Plan",
    "foot_half_angle",
    "lattice_plan",
    "require_lattice_fits",
    "wall_half_angle",
]

Array = NDArray[np.float64]

LATTICE, JOINTS = "lattice", "lattice_joints"
"""Names of the parts: walls; what joins them to each other and to the rings."""
CELL = "lattice_cell_"
"""How the face groups of the cells begin: row from the hub and number around the wheel follow, ``lattice_cell_1_0``."""

_SHARPEST = math.radians(30.0)
"""Smallest angle between two walls of a joint."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lattice:
    """Walls of constant thickness that join in threes, on feet on rim and hub.

    A foot is a layer of the walls' thickness on the ring, from whose middle a radial wall rises. Radial walls are all
    of the same length between the middles of their joints, hub or rim.

    Attributes
    ----------
    kind : ``"honeycomb"`` hexagons, convex; ``"re_entrant"`` bow ties, whose oblique walls point back inwards
    cells : number of cells around the wheel [-]
    layers : rings of oblique walls [-]; below, between and above them lie rows of cells, one more than layers
    angle : inclination of oblique walls to the circumference at their middle [rad]
    thickness : of every wall [m]
    weld_length : length of a foot along the circumference, on the rim's inner and the hub's outer surface [m]
    bands : axial bands ``((y0, y1), ...)`` that the lattice occupies [m]
    phase : circumferential position of the first radial wall on the hub [rad]
    material : elastic material
    """

    kind: Literal["honeycomb", "re_entrant"]
    cells: Count
    layers: Count
    thickness: PositiveLength
    weld_length: PositiveLength
    bands: Bands
    angle: Angle = math.pi / 6.0
    phase: Angle = 0.0
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_bands("lattice band", self.bands, key="bands")
        require_declared(self, "lattice")
        if self.kind not in ("honeycomb", "re_entrant"):
            raise InputError("lattice kind", self.kind, "is not known", "give honeycomb or re_entrant", key="kind")
        if self.cells < 3:
            raise InputError("lattice cells", self.cells, "must be at least 3", "12 to 30 are usual", key="cells")
        if not 0.0 < self.angle < math.radians(80.0):
            rule = "must lie between 0 and 80 deg"
            raise InputError(
                "lattice angle", f"{math.degrees(self.angle):g} deg", rule, "30 deg makes regular hexagons", key="angle"
            )
        if self.weld_length < 2.0 * self.thickness:
            rule = f"must be at least two thicknesses, {2e3 * self.thickness:g} mm"
            hint = "lengthen the foot"
            raise InputError("lattice weld length", f"{self.weld_length * 1e3:g} mm", rule, hint, key="weld_length")

    @property
    def pitch(self) -> float:
        """Angle from a radial wall to the next of its row [rad]."""
        return 2.0 * math.pi / self.cells


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A joint of three walls.

    Attributes
    ----------
    layer : ring of oblique walls that it belongs to, from the hub
    outer : whether it is at the inner end of the radial walls outside that ring, else at the outer end of those inside
    radius : of the point in which the three middle lines meet [m]
    arms : (3, 2) float [-], unit vectors along the walls in (circumferential, outward) directions at the joint, the
        radial wall's first, then anticlockwise as one draws these directions to the right and upwards
    """

    layer: int
    outer: bool
    radius: float
    arms: Array

    @property
    def gaps(self) -> Array:
        """Angle from each arm to the next anticlockwise, (3,) [rad]; sum 2 pi."""
        directions = np.arctan2(self.arms[:, 1], self.arms[:, 0])
        return np.asarray(np.mod(np.roll(directions, -1) - directions, 2.0 * math.pi))

    def corners(self, thickness: float) -> Array:
        """Where the side of each arm meets that of the next one, (3, 2) [m] from the joint's middle."""
        ahead = np.arctan2(self.arms[:, 1], self.arms[:, 0]) + 0.5 * self.gaps
        reach = 0.5 * thickness / np.sin(0.5 * self.gaps)
        return np.asarray(reach[:, None] * np.column_stack([np.cos(ahead), np.sin(ahead)]))

    def cuts(self, thickness: float) -> Array:
        """How far from the middle both sides of each wall begin, (3, 2) [m]: that to the arm before, to the next."""
        ahead = 0.5 * thickness / np.tan(0.5 * self.gaps)
        return np.column_stack([np.roll(ahead, 1), ahead])


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """Where a lattice's middle lines lie.

    Attributes
    ----------
    gap : (hub, rim): radii [m] of the surfaces on which its feet stand
    rows : (start, end) radii [m] of the middle lines of each row of radial walls, one more than layers
    joints : (inner, outer) of each layer
    """

    gap: tuple[float, float]
    rows: tuple[tuple[float, float], ...]
    joints: tuple[tuple[Joint, Joint], ...]

    def oblique_lengths(self, pitch: float) -> list[float]:
        """Length of the oblique walls of each layer between the middles of their joints [m]."""
        ends = ((polar(a.radius, 0.0), polar(b.radius, 0.5 * pitch)) for a, b in self.joints)
        return [float(np.linalg.norm(b - a)) for a, b in ends]


def lattice_plan(lattice: Lattice, gap: tuple[float, float]) -> Plan:
    """Lay the lattice out between two radii.

    An oblique wall from radius a to b over half a pitch is inclined at its middle by theta to the circumference where
    (b - a) cos(p/4) = (b + a) sin(p/4) tan(theta), p the pitch; so b = q a with q = (1 + s) / (1 - s),
    s = tan(theta) tan(p/4), theta < 0 if re-entrant. Radial walls of length h then fill the gap from r_h to r_r where
    h (1 + q + ... + q^n) = r_r - q^n r_h, n the number of layers.

    Parameters
    ----------
    lattice : its numbers
    gap : (hub, rim): radii [m] of the surfaces between which it lies

    Raises
    ------
    InputError
        For an angle that leaves no room for radial walls.
    """
    sign = 1.0 if lattice.kind == "honeycomb" else -1.0
    slope = sign * math.tan(lattice.angle) * math.tan(0.25 * lattice.pitch)
    hub, rim = gap
    height = -1.0
    if abs(slope) < 1.0:
        growth = (1.0 + slope) / (1.0 - slope)
        height = (rim - growth**lattice.layers * hub) / sum(growth**k for k in range(lattice.layers + 1))
    if not height > 0.0:
        rule = f"leaves no room for radial walls in the gap of {(rim - hub) * 1e3:.4g} mm between the rings"
        hint = "use a smaller angle, fewer layers or more cells"
        raise InputError("lattice angle", f"{math.degrees(lattice.angle):g} deg", rule, hint, key="lattice.angle")
    rows, joints, start = list[tuple[float, float]](), list[tuple[Joint, Joint]](), hub
    for layer in range(lattice.layers):
        end = start + height
        rows.append((start, end))
        start = growth * end
        joints.append((_joint(lattice, layer, end, start, False), _joint(lattice, layer, start, end, True)))
    return Plan(gap=gap, rows=(*rows, (start, rim)), joints=tuple(joints))


def _joint(lattice: Lattice, layer: int, radius: float, other: float, outer: bool) -> Joint:
    """The joint at ``radius`` [m], from which oblique walls lead to the radius ``other``."""
    x, z = polar(other, 0.5 * lattice.pitch) - polar(radius, 0.0)
    right = np.array([x, -z]) / math.hypot(x, z)
    left = right * [-1.0, 1.0]
    arms = ([0.0, 1.0], left, right) if outer else ([0.0, -1.0], right, left)
    return Joint(layer=layer, outer=outer, radius=radius, arms=np.array(arms))


def foot_half_angle(lattice: Lattice, radius: float) -> float:
    """Half the angle [rad] that a foot covers on a ring's surface of this radius [m]."""
    return 0.5 * lattice.weld_length / radius


def wall_half_angle(lattice: Lattice, radius: float) -> float:
    """Half the angle [rad] that a radial wall's end covers at this radius [m]."""
    return math.asin(0.5 * lattice.thickness / radius)


def require_lattice_fits(lattice: Lattice, gap: tuple[float, float]) -> None:
    """Raise InputError for walls, joints or feet that do not fit between the radii ``gap`` (hub, rim) [m].

    Walls are too thick, meet too sharply, come too close to each other or to the rings; feet are too long.
    """
    plan, t = lattice_plan(lattice, gap), lattice.thickness
    hint = "use thinner walls, another angle, fewer cells or fewer layers"
    inclined, thick = f"{math.degrees(lattice.angle):g} deg", f"{t * 1e3:g} mm"
    sharpest = min(float(joint.gaps.min()) for joints in plan.joints for joint in joints)
    if sharpest < _SHARPEST:
        rule = f"lets walls meet at {math.degrees(sharpest):.3g} deg, less than {math.degrees(_SHARPEST):g} deg"
        raise InputError("lattice angle", inclined, rule, "use flatter oblique walls", key="lattice.angle")
    for what, free in _free_lengths(lattice, plan):
        if free < t:
            rule = f"leaves {what} walls {max(free, 0.0) * 1e3:.3g} mm between their joints, less than a thickness"
            raise InputError("lattice thickness", thick, rule, hint, key="lattice.thickness")
    apart, near = _smallest_distances(lattice, plan)
    if apart < 2.0 * t:
        rule = f"lets walls that are not joined come as near as {apart * 1e3:.3g} mm, less than two thicknesses"
        raise InputError("lattice angle", inclined, rule, hint, key="lattice.angle")
    if near < 2.5 * t:
        rule = f"lets oblique walls come as near as {near * 1e3:.3g} mm to a ring, less than 2.5 thicknesses"
        raise InputError("lattice angle", inclined, rule, hint, key="lattice.angle")
    room = lattice.pitch * gap[0]
    if lattice.weld_length >= room:
        rule = f"must be smaller than the spacing of the feet on the hub, {room * 1e3:.4g} mm"
        value = f"{lattice.weld_length * 1e3:g} mm"
        raise InputError("lattice weld length", value, rule, "shorten the feet", key="lattice.weld_length")


def _free_lengths(lattice: Lattice, plan: Plan) -> Iterator[tuple[str, float]]:
    """Length [m] of each kind of wall between its joints, on its shorter side."""
    t = lattice.thickness
    cuts = [[joint.cuts(t).max(axis=1) for joint in joints] for joints in plan.joints]
    for row, (start, end) in enumerate(plan.rows):
        inner = t if row == 0 else float(cuts[row - 1][1][0])
        outer = t if row == lattice.layers else float(cuts[row][0][0])
        yield "radial", end - start - inner - outer
    for (a, b), length in zip(cuts, plan.oblique_lengths(lattice.pitch), strict=True):
        yield "oblique", length - float(a[1:].max() + b[1:].max())


def _smallest_distances(lattice: Lattice, plan: Plan) -> tuple[float, float]:
    """Smallest distance [m] of middle lines that do not meet, and of the oblique ones from rim or hub."""
    hub, rim = plan.gap
    places = [[(r, i) for r in radii] for i in range(-3, 4) for k, radii in enumerate(plan.rows) if (i - k) % 2 == 0]
    oblique = [
        [(a.radius, i), (b.radius, i + side)]
        for i in range(-3, 4)
        for k, (a, b) in enumerate(plan.joints)
        if (i - k) % 2 == 0
        for side in (-1, 1)
    ]
    half, axle = 0.5 * lattice.pitch, shapely.Point(0.0, 0.0)

    def line(ends: list[tuple[float, int]]) -> shapely.LineString:
        return shapely.LineString([polar(r, half * i) for r, i in ends])

    apart = min(
        line(one).distance(line(other))
        for one, other in combinations([*places, *oblique], 2)
        if not {(r, i) for r, i in one} & {(r, i) for r, i in other}
    )
    heights = [min(axle.distance(line(ends)) - hub, rim - max(r for r, _ in ends)) for ends in oblique]
    return float(apart), float(min(heights))
