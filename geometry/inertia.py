"""Mass matrix of parts of a mesh as one rigid body. Verified by tests/unit/test_geometry_inertia.py."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from geometry.hexahedra import gauss_points, jacobians, reference_nodes

__all__ = ["rigid_mass"]

Array = NDArray[np.float64]


def rigid_mass(mesh: TaggedMesh, densities: Mapping[str, float]) -> Array:
    """Mass matrix (6, 6) of some parts as one rigid body [kg; kg m; kg m^2].

    By translations along x, y, z and turns about them through the origin; 4 x 4 x 4 Gauss points a cell.

    densities : part -> density [kg/m^3]; other parts do not count

    Verified by tests/unit/test_geometry_inertia.py.
    """
    at, weights = gauss_points(4)
    shapes = _shapes(mesh.cells.shape[1], at)
    found = np.zeros((6, 6))
    for part, density in densities.items():
        cells = mesh.cells[mesh.cell_tags == mesh.parts[part]]
        mass = density * np.linalg.det(jacobians(mesh.points, cells, at)) * weights
        places = np.einsum("qn,cni->cqi", shapes, mesh.points[cells])
        motions = np.zeros((6, *places.shape))
        for k, axis in enumerate(np.eye(3)):
            motions[k], motions[3 + k] = axis, np.cross(axis, places)
        found += np.einsum("acqi,cq,bcqi->ab", motions, mass, motions)
    return found


def _shapes(n_nodes: int, points: Array) -> Array:
    """Lagrange shape functions of the hexahedron at reference points (q, 3), (q, n_nodes) [-]."""
    at, x = reference_nodes(n_nodes)[None], points[:, None]
    if n_nodes == 8:
        return np.asarray((0.5 * (1.0 + at * x)).prod(axis=2))
    return np.asarray(np.where(at != 0.0, 0.5 * x * (x + at), 1.0 - x * x).prod(axis=2))
