"""What of a wheel's hexahedra is seen: flat quadrangles with the part behind each, and what a ray meets first.

Verified by tests/unit/test_viewer_wheel_surface.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Probe", "WheelField", "WheelPoints", "WheelSurface"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
_TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelField:
    """Fields at the mesh's nodes.

    Attributes
    ----------
    displacement : (n, 3) float [m]
    von_mises : (n,) float [Pa]
    principal_stress : (n, 3) float [Pa], descending, if it is known
    pressure : (n,) float [Pa], of the ground, if it is known
    """

    displacement: FloatArray
    von_mises: FloatArray
    principal_stress: FloatArray | None = None
    pressure: FloatArray | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelPoints:
    """Points of a wheel, both halves of it.

    Attributes
    ----------
    places : (n, 3) float [m], undeformed
    nodes : (n,) int, node of the mesh at each point
    mirror : (n,) float, +1, or -1 for the image at -y
    """

    places: FloatArray
    nodes: IntArray
    mirror: FloatArray

    def displacement(self, field: WheelField) -> FloatArray:
        """Of each point (n, 3) [m]."""
        moved = field.displacement[self.nodes].copy()
        moved[:, 1] *= self.mirror
        return moved


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelSurface(WheelPoints):
    """The boundary of those cells that are drawn.

    Attributes
    ----------
    numbers : (n,) int, increasing, of the points in the whole body
    quads : (m, 4) int, corners among the points
    parts : (m,) int, tag of the part behind each quadrangle
    """

    numbers: IntArray
    quads: IntArray
    parts: IntArray

    def index(self, number: int) -> int | None:
        """Where among the points that of this number in the body is; None if it is not drawn."""
        place = int(np.searchsorted(self.numbers, number))
        return place if place < len(self.numbers) and self.numbers[place] == number else None

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
        return Probe(point=int(self.numbers[nearest]), part=int(self.parts[number // 2]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """A point of the surface: its number in the body, the tag of the part that was met."""

    point: int
    part: int


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
