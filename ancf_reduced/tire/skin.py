"""The outside of a deformed tire as quadrangles, with the strain on it, for pictures and for how far it is strained.

Each plate shows both faces (zeta = -1/2 and +1/2) and both edges across (x2 = 0 and b), on a grid of points of its own
shape functions: what is drawn is what is computed. Verified by tests/unit/test_ancf_tire_skin.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.vector_coordinates import VectorCoordinates, with_reference_node
from ancf_reduced.plates.shape_functions import plate_shape, plate_shape_gradient
from ancf_reduced.tire.mesh import Tire

__all__ = ["TireSkin", "tire_skin"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class TireSkin:
    """Constant data of one tire.

    Attributes
    ----------
    coordinates : from the vectors of `contracts.nodal_tires` to the nodes
    elements : (n_plates, 4) int, nodes of each plate
    shape : (n_plates, n, 16) float, r = shape . p of the plate's nodes
    gradient : (n_plates, n, 3, 16) float, deformation gradient's columns dr/dX_k = gradient[k] . p
    quads : (m, 4) int, corners among the (n_plates n) points
    """

    coordinates: VectorCoordinates
    elements: IntArray
    shape: FloatArray
    gradient: FloatArray
    quads: IntArray

    def points(self, vectors: FloatArray) -> FloatArray:
        """Places (n_plates n, 3) [m] from a tire's vectors (n_vectors, 3)."""
        return np.asarray(self.shape @ self._nodes(vectors)).reshape(-1, 3)

    def strains(self, vectors: FloatArray) -> FloatArray:
        """Green-Lagrange strains E = (F^T F - I) / 2, (n_plates n, 3, 3) float [-], wheel frame."""
        F_T = self.gradient @ self._nodes(vectors)[:, None]
        return np.asarray(0.5 * (F_T @ np.swapaxes(F_T, -1, -2) - np.eye(3))).reshape(-1, 3, 3)

    def largest_strain(self, vectors: FloatArray) -> FloatArray:
        """Size of the principal strain that is largest in size, (n_plates n,) float [-]."""
        return np.asarray(np.abs(np.linalg.eigvalsh(self.strains(vectors))).max(axis=-1))

    def _nodes(self, vectors: FloatArray) -> FloatArray:
        p = self.coordinates.expand(np.ascontiguousarray(vectors))
        return p[self.elements].reshape(len(self.elements), 16, 3)


def tire_skin(tire: Tire, along: int = 13, across: int = 3) -> TireSkin:
    """The skin on a grid of points along and across each plate, two or more each."""
    mesh, (xi, quads) = tire.mesh, _plate_grid(along, across)
    T = mesh.transform
    shape = np.array([plate_shape(xi, size) for size in mesh.dimensions]) @ T
    by_x = np.array([plate_shape_gradient(xi, size) for size in mesh.dimensions]) @ T[:, None]
    p = mesh.reference_coordinates()[mesh.elements].reshape(len(T), 16, 3)
    base = by_x @ p[:, None]
    return TireSkin(
        coordinates=with_reference_node(tire.tie),
        elements=mesh.elements,
        shape=shape,
        gradient=np.linalg.solve(base, by_x),
        quads=np.concatenate([quads + len(xi) * plate for plate in range(len(T))]),
    )


def _plate_grid(along: int, across: int) -> tuple[FloatArray, IntArray]:
    """Points (n, 3) and quadrangles (m, 4) of one plate, corners counter-clockwise seen from outside."""
    line = [np.linspace(0.0, 1.0, n) for n in (along, across)]
    u, v, z = np.meshgrid(*line, [-0.5, 0.5], indexing="ij")
    number = np.arange(u.size).reshape(u.shape)
    faces = [_cells(number[..., 1]), _cells(number[..., 0].T), _cells(number[:, 0]), _cells(number[:, -1, ::-1])]
    return np.column_stack([u.ravel(), v.ravel(), z.ravel()]), np.concatenate(faces)


def _cells(number: IntArray) -> IntArray:
    corners = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    return np.stack(corners, axis=-1).reshape(-1, 4)
