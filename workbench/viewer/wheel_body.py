"""A wheel's hexahedra with both halves, and what of them is looked at: some parts, on one side of a plane.

Verified by tests/unit/test_viewer_wheel_surface.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.hexahedra import VTK_FROM_GMSH, reference_nodes
from workbench.viewer.wheel_surface import WheelPoints, WheelSurface

__all__ = ["AXES", "STEPS", "Cut", "WheelBody", "wheel_body"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
AXES = ("x", "y", "z")
"""Of the wheel's own frame: forward, along the axle to the left, up where 0 degrees face the ground."""
STEPS = 100
"""Steps of a cutting plane from one end of the wheel to the other; half of them is the middle."""
_NEAR = (1.0, -1.0, 1.0)
"""Side of each axis that is nearer to the eye of the first view, and so taken away."""
_LATTICE = np.lexsort(reference_nodes(27)[list(VTK_FROM_GMSH)].T).reshape(3, 3, 3)
_EIGHTHS = np.array(
    [_LATTICE[k : k + 2, j : j + 2, i : i + 2].ravel()[[0, 1, 3, 2, 4, 5, 7, 6]] for k, j, i in np.ndindex(2, 2, 2)]
)
"""Nodes of the eight hexahedra that VTK's triquadratic one is made of."""
_FACES = np.array([(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)])
"""Corners of VTK's hexahedron around each face, seen from outside."""
_MIRRORED = [1, 0, 3, 2, 5, 4, 7, 6]
"""Corners of a hexahedron in the order that its mirror image has them."""
_PLANE = 1e-9
"""Distance from y = 0 within which a node lies on the cut of half a wheel [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut:
    """What is taken away before the wheel is drawn.

    Attributes
    ----------
    hidden : tags of parts
    axis : of a plane across it, one of `AXES`; none if empty
    step : place of the plane, 0 at the low end to `STEPS` at the high one
    other_side : take away what lies behind the plane instead of what lies before it
    """

    hidden: frozenset[int] = frozenset()
    axis: str = ""
    step: int = STEPS // 2
    other_side: bool = False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelBody(WheelPoints):
    """Cells of a wheel; of half a wheel the mirror image's points and cells come second.

    Attributes
    ----------
    parts : (m,) int, tag of each cell's part
    centres : (m, 3) float [m], of the cells, undeformed
    faces : (k, 4) int, corners of each face between or outside cells, turned outwards of its first cell
    cells : (k, 2) int, the cells on its two sides; -1 for none
    """

    parts: IntArray
    centres: FloatArray
    faces: IntArray
    cells: IntArray

    def place(self, cut: Cut) -> float:
        """Of the plane along its axis [m]."""
        along = self.places[:, AXES.index(cut.axis)]
        low, high = float(along.min()), float(along.max())
        return low + (high - low) * cut.step / STEPS

    def kept(self, cut: Cut) -> NDArray[np.bool_]:
        """Cells (m,) that are drawn: whole ones, by the side on which their undeformed centre lies."""
        kept = ~np.isin(self.parts, sorted(cut.hidden))
        if cut.axis:
            axis = AXES.index(cut.axis)
            before = _NEAR[axis] * (self.centres[:, axis] - self.place(cut)) > 0.0
            kept &= before if cut.other_side else ~before
        return kept

    def surface(self, cut: Cut | None = None) -> WheelSurface:
        """The boundary of what is left, closed: where something was taken away, the inside is seen."""
        kept = np.append(self.kept(cut or Cut()), False)  # at -1 is nothing
        first, second = kept[self.cells].T
        shown = first != second
        quads = np.where(first[shown, None], self.faces[shown], self.faces[shown, ::-1])
        behind = np.where(first, self.cells[:, 0], self.cells[:, 1])[shown]
        numbers, corners = np.unique(quads, return_inverse=True)
        return WheelSurface(
            places=self.places[numbers],
            nodes=self.nodes[numbers],
            mirror=self.mirror[numbers],
            numbers=numbers,
            quads=corners.reshape(-1, 4),
            parts=self.parts[behind],
        )


def wheel_body(points: FloatArray, cells: IntArray, tags: IntArray, moved: FloatArray | None = None) -> WheelBody:
    """Of hexahedra in VTK's node order, points (n, 3) [m], cells (m, 8 or 27), tags of parts (m,).

    A mesh that ends at y = 0 is half a wheel if no node there is moved (n, 3) across that plane, or nothing is said of
    it: its mirror image is added, and nothing is left of the plane between. A cell of 27 nodes counts as eight.
    """
    if cells.shape[1] == 27:
        cells, tags = cells[:, _EIGHTHS].reshape(-1, 8), np.repeat(tags, 8)
    low, high = float(points[:, 1].min()), float(points[:, 1].max())
    across, n = np.abs(points[:, 1]) <= _PLANE, len(points)
    whole = min(abs(low), abs(high)) > _PLANE or (moved is not None and bool(moved[across, 1].any()))
    nodes, mirror, places = np.arange(n), np.ones(n), points
    if not whole:
        beside = np.flatnonzero(~across)
        image = np.arange(n)
        image[beside] = n + np.arange(len(beside))
        cells, tags = np.concatenate([cells, image[cells][:, _MIRRORED]]), np.tile(tags, 2)
        nodes = np.concatenate([nodes, beside])
        mirror = np.concatenate([mirror, np.full(len(beside), -1.0)])
        places = np.concatenate([points, points[beside] * (1.0, -1.0, 1.0)])
    faces, sides = _faces(cells)
    return WheelBody(
        places=places,
        nodes=nodes,
        mirror=mirror,
        parts=tags,
        centres=places[cells].mean(axis=1),
        faces=faces,
        cells=sides,
    )


def _faces(cells: IntArray) -> tuple[IntArray, IntArray]:
    """Every face once (k, 4), turned outwards of its first cell, and the cells on its sides (k, 2), -1 for none."""
    faces = cells[:, _FACES].reshape(-1, 4)
    corners = np.sort(faces, axis=1)
    order = np.lexsort(corners.T)
    again = np.zeros(len(order), dtype=np.bool_)
    again[1:] = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    number = np.cumsum(~again) - 1
    cell = order // len(_FACES)
    sides = np.full((number[-1] + 1, 2), -1)
    sides[:, 0], sides[number[again], 1] = cell[~again], cell[again]
    return faces[order[~again]], sides
