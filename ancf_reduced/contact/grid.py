"""Contact points on faces of plates (thesis section 2.4.1, steps 1 and 2): tables for the compiled loops."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import LANES
from ancf_reduced.contact.layout import ContactLayout, regular_points
from ancf_reduced.plates.mesh import PlateMesh
from ancf_reduced.plates.shape_functions import THESIS_SHAPE, PlateShape
from ancf_reduced.plates.tables import in_blocks
from contracts.errors import InputError

__all__ = ["ContactGrid", "GridTables", "build_contact_grid", "contact_grid"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class GridTables(NamedTuple):
    """What the compiled loops read of a grid.

    Attributes
    ----------
    plates : (n_carriers,) int, plates that carry points
    nodes : (n_carriers, 4) int, their nodes
    frame : (n_carriers, 4, 3, 3) float [m], J0 diag(a, b, t) at the nodes
    shape : (n_blocks, 16, LANES) float [-], normalised shape functions at the points, blocks filled up with zeros
    hull : (16, LANES) float [-], Bezier points of the faces: the points lie in their convex hull
    interpolation : (n_carriers, n_points, 16) float [-, m], T folded in: r = interpolation . p of the plate's nodes
    slopes : (n_carriers, n_points, 2, 16) float, r_xi1 and r_xi2 likewise, ordered so that their cross product points
        out of the face
    """

    plates: IntArray
    nodes: IntArray
    frame: FloatArray
    shape: FloatArray
    hull: FloatArray
    interpolation: FloatArray
    slopes: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactGrid:
    """The same points on each of some plates.

    Attributes
    ----------
    n_plates : plates of the whole mesh
    xi : (n_points, 3) float [-], (xi, eta, zeta); zeta is -1/2 or +1/2
    share : (n_points,) float [-], share of the face that a point stands for, sum 1
    tables : for the compiled loops

    Verified by tests/unit/test_ancf_contact_grid.py.
    """

    n_plates: int
    xi: FloatArray
    share: FloatArray
    tables: GridTables

    def positions(self, coordinates: FloatArray) -> FloatArray:
        """Positions (n_carriers, n_points, 3) float [m] at structure coordinates (n_nodes, 4, 3)."""
        p = coordinates[self.tables.nodes].reshape(len(self.tables.nodes), 16, 3)
        return np.asarray(self.tables.interpolation @ p)

    def areas(self, coordinates: FloatArray, carrier: IntArray, point: IntArray) -> FloatArray:
        """Present area of the face that each of some points of carriers stands for, (n,) float [m^2]."""
        p = coordinates[self.tables.nodes[carrier]].reshape(len(carrier), 16, 3)
        a = self.tables.slopes[carrier, point] @ p
        return np.asarray(self.share[point] * np.linalg.norm(np.cross(a[:, 0], a[:, 1]), axis=-1))


def build_contact_grid(
    mesh: PlateMesh,
    plates: IntArray,
    counts: tuple[int, int],
    layout: ContactLayout = "edges",
    shape: PlateShape = THESIS_SHAPE,
) -> ContactGrid:
    """Regular points on the faces zeta = +1/2 of some plates.

    Parameters
    ----------
    mesh : plates; their directors x3 point out of the face that touches the ground
    plates : (n_carriers,) int, plates that carry points
    counts, layout : see `contact.layout.regular_points`
    shape : interpolation, thesis eq. 2.13 by default

    Verified by tests/unit/test_ancf_contact_grid.py.
    """
    return contact_grid(mesh, plates, *regular_points(counts, layout), shape)


def contact_grid(
    mesh: PlateMesh, plates: IntArray, xi: FloatArray, share: FloatArray, shape: PlateShape = THESIS_SHAPE
) -> ContactGrid:
    """Any points on the faces of plates.

    Parameters
    ----------
    mesh, plates, shape : as `build_contact_grid`
    xi, share : (n_points, 3) and (n_points,) float [-], see `ContactGrid`; on either face

    Raises
    ------
    InputError
        For points that are not on a face.
    """
    if xi.ndim != 2 or xi.shape[1] != 3 or share.shape != xi.shape[:1]:
        shapes = f"points {xi.shape}, shares {share.shape}"
        raise InputError("contact points", shapes, "need the shapes (n, 3) and (n,)", "give one share a point")
    faces = np.unique(xi[:, 2])
    if not np.all(np.isin(faces, [-0.5, 0.5])) or not np.all((xi[:, :2] >= 0.0) & (xi[:, :2] <= 1.0)):
        shown = f"xi, eta, zeta from {xi.min(axis=0)} to {xi.max(axis=0)}"
        rule = "must have xi, eta in 0..1 and zeta = -1/2 or +1/2"
        raise InputError("contact points", shown, rule, "place them on the faces of the plates")
    elements, gradients, dimensions = mesh.elements[plates], mesh.gradients[plates], mesh.dimensions[plates]
    carriers = replace(mesh, elements=elements, gradients=gradients, dimensions=dimensions)
    frame, unit = gradients * dimensions[:, None, None, :], np.ones(3)
    value, slopes = shape.value(xi, unit), shape.gradient(xi, unit)[:, :2]
    slopes = np.where(xi[:, 2, None, None] > 0.0, slopes, slopes[:, ::-1])
    folded = carriers.in_structure_coordinates(slopes.reshape(1, -1, 16), frame)
    tables = GridTables(
        plates=np.asarray(plates, dtype=np.int64),
        nodes=elements,
        frame=frame,
        shape=np.ascontiguousarray(np.moveaxis(in_blocks(value.T), 1, 0)),
        hull=_hull(shape, faces),
        interpolation=np.ascontiguousarray(carriers.in_structure_coordinates(value[None], frame)),
        slopes=np.ascontiguousarray(folded.reshape(len(elements), len(xi), 2, 16)),
    )
    return ContactGrid(n_plates=len(mesh.elements), xi=xi, share=share, tables=tables)


def _hull(shape: PlateShape, faces: FloatArray) -> FloatArray:
    """Maps from a plate's coordinates to the 16 Bezier points of each face, filled up by repetition: (16, LANES)."""
    t = np.linspace(0.0, 1.0, 4)
    bernstein = np.column_stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    to_bezier = np.linalg.inv(np.kron(bernstein, bernstein))
    maps = [
        to_bezier @ shape.value(np.stack(np.meshgrid(t, t, [z], indexing="ij"), axis=-1).reshape(-1, 3), np.ones(3))
        for z in np.resize(faces, LANES // 16)
    ]
    return np.ascontiguousarray(np.concatenate(maps).T)
