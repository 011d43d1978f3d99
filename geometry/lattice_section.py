"""The lattice as blocks of the wheel's section: walls of two halves, joints of three quadrilaterals, feet on the rings.

The three corners of a joint are those in which the sides of neighbouring walls meet. Lines from the joint's middle to
the middles of the three walls' ends divide it into quadrilaterals, so a wall has an even number of elements across and
every edge of a joint is one of a wall. Each cell's walls are a face group of their own: what may touch within it.
Verified by tests/unit/test_geometry_lattice.py and tests/verification/test_lattice_mesh.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geometry.blocks import Block, Curve, Draft, Key
from geometry.division import Ring
from geometry.lattice import CELL, JOINTS, LATTICE, Joint, Lattice, Plan, foot_half_angle, lattice_plan, wall_half_angle
from geometry.springs import polar

__all__ = ["add_lattice"]

_LEAST_PER_WALL = 4
_Side = tuple[Key, Key, str]
"""Corners at the start and the end of one side of a wall, and the cell that it faces."""


def add_lattice(draft: Draft, lattice: Lattice, gap: tuple[float, float], rings: tuple[Ring, Ring]) -> None:
    """Draw feet, joints and walls.

    Parameters
    ----------
    draft : the section that is built; rim and hub share their corners with the feet
    lattice : its numbers
    gap : (hub, rim): radii [m] of the surfaces between which it lies
    rings : divisions of the rim and of the hub, cut where feet and walls end
    """
    drawer = _Drawer(draft=draft, lattice=lattice, plan=lattice_plan(lattice, gap))
    rim, hub = rings
    last = lattice.layers
    feet = {0: drawer.feet(0, hub, "outer_hub_out"), last: drawer.feet(last, rim, "rim_in")}
    for layer, joints in enumerate(drawer.plan.joints):
        for joint in joints:
            for i in range((layer + joint.outer) % 2, 2 * lattice.cells, 2):
                drawer.joint(joint, i)
        for i in range(layer % 2, 2 * lattice.cells, 2):
            drawer.oblique(layer, i)
    for row in range(last + 1):
        for i in range(row % 2, 2 * lattice.cells, 2):
            start = feet[0][i] if row == 0 else drawer.radial_end(drawer.plan.joints[row - 1][1], i)
            end = feet[last][i] if row == last else drawer.radial_end(drawer.plan.joints[row][0], i)
            sides = [_cell(lattice, row, i - 1), None, _cell(lattice, row, i + 1)]
            low, high = drawer.plan.rows[row]
            drawer.wall(start, end, sides, high - low)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Drawer:
    """Draws a lattice; ``i`` counts half pitches from its phase."""

    draft: Draft
    lattice: Lattice
    plan: Plan

    @property
    def _half(self) -> int:
        """Elements across half a wall."""
        return self.draft.size.half_wall_elements

    def _angle(self, i: int) -> float:
        return self.lattice.phase + 0.5 * self.lattice.pitch * i

    def feet(self, row: int, ring: Ring, surface: str) -> dict[int, list[Key]]:
        """Feet on the hub's or the rim's surface; corners of the wall's end on each, from smaller to larger phi."""
        on_hub = surface.startswith("outer_hub")
        radius = self.plan.gap[0 if on_hub else 1]
        top = radius + (1.0 if on_hub else -1.0) * self.lattice.thickness
        name = f"{LATTICE}_{surface}"
        span, wall = foot_half_angle(self.lattice, radius), wall_half_angle(self.lattice, top)
        ends: dict[int, list[Key]] = {}
        for i in range(row % 2, 2 * self.lattice.cells, 2):
            middle = self._angle(i)
            under = set(ring.span(middle - wall, middle + wall))
            before = set(ring.span(middle - span, middle - wall))
            for k in ring.span(middle - span, middle + span):
                cell = _cell(self.lattice, row, i - 1 if k in before else i + 1)
                groups = {} if k in under else {"inner": cell}
                self.draft.add_ring_piece(JOINTS, ((name, surface), (top, radius)), ring, k, groups)
            ends[i] = [(name, ring.index(middle + a)) for a in (-wall, 0.0, wall)]
        return ends

    def joint(self, joint: Joint, i: int) -> None:
        """Three quadrilaterals about the middle, each with one corner."""
        corners, middles = self._corners(joint, i), [self._middle(joint, i, arm) for arm in range(3)]
        centre: Key = (JOINTS, joint.layer, int(joint.outer), self._turn(i))
        points = [self.draft.corners[key] for key in corners]
        self.draft.corner(centre, np.mean(points, axis=0))
        for arm in range(3):
            inner = Curve(start=middles[arm], end=corners[arm])
            outer = Curve(start=centre, end=middles[(arm + 1) % 3])
            self.draft.blocks.append(
                Block(part=JOINTS, inner=inner, outer=outer, n_length=self._half, n_thickness=self._half)
            )

    def oblique(self, layer: int, i: int) -> None:
        """Both walls that leave the inner joint of a layer."""
        inner, outer = self.plan.joints[layer]
        length = self.plan.oblique_lengths(self.lattice.pitch)[layer]
        below, above = (_cell(self.lattice, layer, i + side) for side in (1, -1)), _cell(self.lattice, layer + 1, i)
        for side, under in zip((1, -1), below, strict=True):
            arm = 1 if side > 0 else 2
            far = self._end(outer, i + side, arm)[::-1]
            cells = [under, None, above] if side > 0 else [above, None, under]
            self.wall(self._end(inner, i, arm), far, cells, length)

    def radial_end(self, joint: Joint, i: int) -> list[Key]:
        """Corners of the radial wall's end, from smaller to larger phi."""
        end = self._end(joint, i, 0)
        return end[::-1] if joint.outer else end[:]

    def wall(self, start: Sequence[Key], end: Sequence[Key], cells: Sequence[str | None], length: float) -> None:
        """Two halves; corners and cells in the same order across the wall at both ends."""
        size = self.draft.size
        count = size.refined(max(_LEAST_PER_WALL, math.ceil(length / size.of(LATTICE) - 1e-6)))
        for k in (0, 1):
            sides = {name: cell for name, cell in (("inner", cells[k]), ("outer", cells[k + 1])) if cell is not None}
            inner, outer = (Curve(start=start[n], end=end[n]) for n in (k, k + 1))
            self.draft.blocks.append(
                Block(part=LATTICE, inner=inner, outer=outer, n_length=count, n_thickness=self._half, groups=sides)
            )

    def _end(self, joint: Joint, i: int, arm: int) -> list[Key]:
        """Corners of a wall's end at a joint, anticlockwise: the corner before the arm, the middle, the one behind."""
        corners = self._corners(joint, i)
        return [corners[arm - 1], self._middle(joint, i, arm), corners[arm]]

    def _corners(self, joint: Joint, i: int) -> list[Key]:
        turn = self._turn(i)
        places = joint.corners(self.lattice.thickness)
        keys: list[Key] = [(JOINTS, joint.layer, int(joint.outer), turn, arm) for arm in range(3)]
        return [self.draft.corner(key, self._place(joint, i, at)) for key, at in zip(keys, places, strict=True)]

    def _middle(self, joint: Joint, i: int, arm: int) -> Key:
        before, behind = (self.draft.corners[key] for key in (self._corners(joint, i)[k] for k in (arm - 1, arm)))
        key: Key = (JOINTS, joint.layer, int(joint.outer), self._turn(i), arm, "middle")
        return self.draft.corner(key, 0.5 * (before + behind))

    def _place(self, joint: Joint, i: int, at: np.ndarray) -> np.ndarray:
        """Point (x, z) of a place in (circumferential, outward) directions from a joint's middle [m]."""
        phi = self._angle(i)
        hoop = np.array([math.cos(phi), math.sin(phi)])
        return polar(joint.radius + float(at[1]), phi) + float(at[0]) * hoop

    def _turn(self, i: int) -> int:
        return i % (2 * self.lattice.cells)


def _cell(lattice: Lattice, row: int, i: int) -> str:
    """Face group of the cell of a row whose middle lies ``i`` half pitches from the phase."""
    return f"{CELL}{row}_{(i % (2 * lattice.cells)) // 2}"
