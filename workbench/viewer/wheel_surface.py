"""The outside of a wheel's hexahedra: flat quadrangles with the part behind each, and what a ray meets first.

Verified by tests/unit/test_viewer_wheel_surface.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from geometry.hexahedra import VTK_FROM_GMSH, reference_nodes

__all__ = ["Probe", "WheelField", "WheelSurface", "wheel_surface"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
_TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)])
_LATTICE = np.lexsort(reference_nodes(27)[list(VTK_FROM_GMSH)].T).reshape(3, 3, 3)
_EIGHTHS = np.array(
    [_LATTICE[k : k + 2, j : j + 2, i : i + 2].ravel()[[0, 1, 3, 2, 4, 5, 7, 6]] for k, j, i in np.ndindex(2, 2, 2)]
)
"""Nodes of the eight hexahedra that VTK's triquadratic one is made of."""
_PLANE = 1e-9
"""Distance from y = 0 within which a face lies on the cut of half a wheel [m]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelField:
    """Fields at the mesh's nodes: displacement (n, 3) [m], von Mises stress (n,) [Pa], and if it is known contact
    pressure (n,) [Pa].
    """

    displacement: FloatArray
    von_mises: FloatArray
    pressure: FloatArray | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelSurface:
    """Both halves of a wheel.

    Attributes
    ----------
    places : (n, 3) float [m], undeformed, of the points that are drawn; the mirror image comes second
    nodes : (n,) int, node of the mesh at each point
    mirror : (n,) float, +1, or -1 for the image at -y
    quads : (m, 4) int, corners among the points
    parts : (m,) int, tag of the part behind each quadrangle
    """

    places: FloatArray
    nodes: IntArray
    mirror: FloatArray
    quads: IntArray
    parts: IntArray

    def displacement(self, field: WheelField) -> FloatArray:
        """Of each point (n, 3) [m]."""
        moved = field.displacement[self.nodes].copy()
        moved[:, 1] *= self.mirror
        return moved

    def probe(self, places: FloatArray, ray: FloatArray) -> Probe | None:
        """The point nearest to where a ray (2, 3) from its first to its second end meets the surface first, or None.

        places (n, 3) [m] are where the points are drawn.
        """
        triangles = self.quads[:, _TRIANGLES].reshape(-1, 3)
        met = _first_hit(places[triangles], ray)
        if met is None:
            return None
        number, place = met
        corners = self.quads[number // 2]
        nearest = int(corners[np.argmin(np.linalg.norm(places[corners] - place, axis=1))])
        return Probe(point=nearest, node=int(self.nodes[nearest]), part=int(self.parts[number // 2]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """A point of the surface: its number, the node of the mesh there, the tag of the part that was met."""

    point: int
    node: int
    part: int


def wheel_surface(points: FloatArray, cells: IntArray, tags: IntArray, moved: FloatArray | None = None) -> WheelSurface:
    """Boundary of hexahedra in VTK's node order, points (n, 3) [m], cells (m, 8 or 27), tags of parts (m,).

    A mesh that ends at y = 0 is half a wheel if no node there is moved (n, 3) across that plane, or nothing is said of
    it: its cut is left out, its mirror image added.
    """
    facets, parts = _outside(points, cells, tags)
    low, high = float(points[:, 1].min()), float(points[:, 1].max())
    across = np.abs(points[:, 1]) <= _PLANE
    whole = min(abs(low), abs(high)) > _PLANE or (moved is not None and bool(moved[across, 1].any()))
    if not whole:
        inside = np.abs(points[facets, 1]).max(axis=1) > _PLANE
        facets, parts = facets[inside], parts[inside]
    nodes, quads = np.unique(facets, return_inverse=True)
    quads, places, n = quads.reshape(-1, 4), points[nodes], len(nodes)
    if whole:
        return WheelSurface(places=places, nodes=nodes, mirror=np.ones(n), quads=quads, parts=parts)
    return WheelSurface(
        places=np.concatenate([places, places * (1.0, -1.0, 1.0)]),
        nodes=np.tile(nodes, 2),
        mirror=np.repeat([1.0, -1.0], n),
        quads=np.concatenate([quads, quads[:, ::-1] + n]),
        parts=np.tile(parts, 2),
    )


def _outside(points: FloatArray, cells: IntArray, tags: IntArray) -> tuple[IntArray, IntArray]:
    """Nodes (k, 4) of the quadrangles outside, turned outwards, and tags (k,); a cell of 27 nodes counts as eight."""
    if cells.shape[1] == 27:
        cells, tags = cells[:, _EIGHTHS].reshape(-1, 8), np.repeat(tags, 8)
    found = pv.UnstructuredGrid({pv.CellType.HEXAHEDRON: cells}, points).extract_surface(algorithm="geometry")
    corners = np.asarray(found.point_data["vtkOriginalPointIds"], dtype=np.int64)[found.regular_faces]
    return corners, tags[found.cell_data["vtkOriginalCellIds"]]


def _first_hit(corners: FloatArray, ray: FloatArray) -> tuple[int, FloatArray] | None:
    """Number of the triangle (n, 3, 3) a ray meets first, and where; Moeller and Trumbore (1997).

    VTK's locators let rays through between triangles that touch, and then tell of the surface behind.
    """
    origin, along = ray[0], ray[1] - ray[0]
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(along, e2)
    det = np.einsum("ij,ij->i", e1, p)
    safe = np.where(np.abs(det) > 0.0, det, np.inf)
    s = origin - a
    u = np.einsum("ij,ij->i", s, p) / safe
    q = np.cross(s, e1)
    v = q @ along / safe
    t = np.einsum("ij,ij->i", e2, q) / safe
    hit = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t >= 0.0) & (np.abs(det) > 0.0)
    if not hit.any():
        return None
    number = int(np.argmin(np.where(hit, t, np.inf)))
    return number, origin + t[number] * along
