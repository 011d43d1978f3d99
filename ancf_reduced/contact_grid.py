"""Contact points on the outer face of plates, against a rigid plane (thesis section 2.4.1, eqs. 2.21 and 2.22).

Statics without friction: f_n = k delta n (thesis eq. 2.22 without its damping term), never tensile. The normal is the
plane's own, not the thesis' r_x1 x r_x2 / |r_x1 x r_x2|: the robust choice of theory notes, section 6.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plate_mesh import PlateMesh
from ancf_reduced.shape_functions import THESIS_SHAPE, PlateShape

__all__ = ["ContactGrid", "ContactLayout", "PlaneContact", "build_contact_grid", "contact_tangent", "plane_contact"]

FloatArray = NDArray[np.float64]
ContactLayout = Literal["edges", "centres"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactGrid:
    """Points on plates' faces, with the linear map from node coordinates to their positions.

    Attributes
    ----------
    plates : (n_points,) int, the plate each point lies on
    xi : (n_points, 3) float [-], its (xi, eta, zeta)
    interpolation : (n_points, 4 n_nodes) float [-, m], T folded in: r = interpolation @ p; column 4 n + c is node n,
        vector c

    Verified by tests/unit/test_ancf_contact_grid.py.
    """

    plates: NDArray[np.int64]
    xi: FloatArray
    interpolation: FloatArray

    def positions(self, coordinates: FloatArray) -> FloatArray:
        """Positions (n_points, 3) float [m] at structure coordinates (n_nodes, 4, 3)."""
        return self.interpolation @ coordinates.reshape(-1, 3)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneContact:
    """Contact of a grid with a plane at one configuration.

    Attributes
    ----------
    gap : (n_points,) float [m], normal gap, open > 0; penetration delta = max(-gap, 0)
    pressure_force : (n_points,) float [N], k delta >= 0, pushes along the plane's normal
    force : (n_nodes, 4, 3) float [N, N m], generalised force of the plane on the mesh
    """

    gap: FloatArray
    pressure_force: FloatArray
    force: FloatArray

    @property
    def load(self) -> float:
        """Sum of the normal forces, ground on wheel [N]."""
        return float(self.pressure_force.sum())

    @property
    def penetration_max(self) -> float:
        """Largest penetration of a point [m]; 0 without contact."""
        return float(max(-self.gap.min(), 0.0))

    @property
    def penetration_mean(self) -> float:
        """Load-weighted mean penetration, sum f delta / sum f [m]; 0 without contact."""
        return float(self.pressure_force @ -self.gap / self.load) if self.load > 0.0 else 0.0


def build_contact_grid(
    mesh: PlateMesh,
    plates: NDArray[np.int64],
    counts: tuple[int, int],
    layout: ContactLayout = "edges",
    shape: PlateShape = THESIS_SHAPE,
) -> ContactGrid:
    """Regular points on the faces zeta = +1/2 of some plates.

    Parameters
    ----------
    mesh : plates; their directors x3 point out of the face that touches the ground
    plates : (n_plates,) int, plates that carry points
    counts : points along x1 and x2
    layout : ``"edges"``: at i/(n-1), so a row shared by two plates counts for both; ``"centres"``: at (i+1/2)/n
    shape : interpolation, thesis eq. 2.13 by default

    Verified by tests/unit/test_ancf_contact_grid.py.
    """
    axes = [np.linspace(0.0, 1.0, n) if layout == "edges" else (np.arange(n) + 0.5) / n for n in counts]
    xi = np.stack(np.meshgrid(*axes, [0.5], indexing="ij"), axis=-1).reshape(-1, 3)
    T = mesh.transform
    interpolation = np.zeros((len(plates) * len(xi), len(mesh.points), 4))
    for row, j in enumerate(plates):
        block = (shape.value(xi, mesh.dimensions[j]) @ T[j]).reshape(-1, 4, 4)
        interpolation[row * len(xi) : (row + 1) * len(xi), mesh.elements[j]] = block
    return ContactGrid(
        plates=np.repeat(plates, len(xi)),
        xi=np.tile(xi, (len(plates), 1)),
        interpolation=interpolation.reshape(len(interpolation), -1),
    )


def plane_contact(
    grid: ContactGrid, coordinates: FloatArray, direction: FloatArray, offset: float, stiffness: float
) -> PlaneContact:
    """Normal gap and penalty force against the plane direction . x = offset.

    Parameters
    ----------
    grid : contact points
    coordinates : (n_nodes, 4, 3) float [m, -]
    direction : (3,) float [-], unit vector from the hub to the ground; the plane's outward normal is its negative
    offset : distance of the plane from the origin along ``direction`` [m]
    stiffness : k per point [N/m]

    Returns
    -------
    PlaneContact
        gap = offset - direction . r; force of each point = k max(-gap, 0) along -direction (thesis eq. 2.22).

    Verified by tests/unit/test_ancf_contact_grid.py (finite differences).
    """
    gap = offset - grid.interpolation @ (coordinates.reshape(-1, 3) @ direction)
    pressure_force = stiffness * np.maximum(-gap, 0.0)
    generalised = pressure_force @ grid.interpolation
    force = np.multiply.outer(generalised.reshape(-1, 4), -direction)
    return PlaneContact(gap=gap, pressure_force=pressure_force, force=force)


def contact_tangent(grid: ContactGrid, contact: PlaneContact, direction: FloatArray, stiffness: float) -> FloatArray:
    """Exact tangent of minus the contact force, -dQ_c/dp, (12 n_nodes, 12 n_nodes) float [N/m, N, N m].

    k sum over closed points of s s^T kron n n^T: symmetric, positive semi-definite, to be added to the elastic tangent.

    Verified by tests/unit/test_ancf_contact_grid.py (finite differences).
    """
    closed = grid.interpolation[contact.gap < 0.0]
    tangent = np.kron(stiffness * (closed.T @ closed), np.outer(direction, direction))
    return np.asarray(tangent, dtype=np.float64)
