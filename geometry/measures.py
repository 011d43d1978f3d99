"""Volumes, joint areas and quality of a mesh by quadrature on its own (curved) geometry.

Verified by tests/verification/test_mesh_volume.py and tests/unit/test_geometry_measures.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from geometry.hexahedra import face_nodes, gauss_points, jacobians, reference_nodes

__all__ = ["MeshQuality", "joint_areas", "mesh_quality", "mesh_volume", "scaled_jacobians"]

Array = NDArray[np.float64]

_EDGES = np.array([(0, 1), (3, 2), (4, 5), (7, 6), (0, 3), (1, 2), (4, 7), (5, 6), (0, 4), (1, 5), (2, 6), (3, 7)])


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshQuality:
    """How good the cells are.

    Attributes
    ----------
    n_points, n_cells, order : size of the mesh and order of its geometry
    min_scaled_jacobian, mean_scaled_jacobian : det J / (product of the three tangents' lengths), over the 8 corners and
        27 Gauss points of every cell [-]; 1 is a brick, <= 0 is inverted
    min_edge, max_edge : straight distance between neighbouring corners [m]
    max_aspect_ratio : largest longest over shortest edge of a cell [-]
    """

    n_points: int
    n_cells: int
    order: int
    min_scaled_jacobian: float
    mean_scaled_jacobian: float
    min_edge: float
    max_edge: float
    max_aspect_ratio: float


def scaled_jacobians(mesh: TaggedMesh) -> Array:
    """det J over the product of the tangents' lengths at 8 corners and 27 Gauss points, shape (n_cells, 35) [-]."""
    at = np.vstack([reference_nodes(8), gauss_points(3)[0]])
    J = jacobians(mesh.points, mesh.cells, at)
    lengths = np.linalg.norm(J, axis=2)
    result: Array = np.linalg.det(J) / np.prod(lengths, axis=-1)
    return result


def mesh_quality(mesh: TaggedMesh) -> MeshQuality:
    """Return the quality of a mesh's cells."""
    scaled = scaled_jacobians(mesh)
    ends = mesh.points[mesh.cells[:, _EDGES]]
    edges = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1)
    return MeshQuality(
        n_points=len(mesh.points),
        n_cells=len(mesh.cells),
        order=mesh.order,
        min_scaled_jacobian=float(scaled.min()),
        mean_scaled_jacobian=float(scaled.mean()),
        min_edge=float(edges.min()),
        max_edge=float(edges.max()),
        max_aspect_ratio=float((edges.max(axis=1) / edges.min(axis=1)).max()),
    )


def mesh_volume(mesh: TaggedMesh) -> Mapping[str, float]:
    """Volume of each part [m^3]: sum of det J w over 4 x 4 x 4 Gauss points (exact for 27-node cells)."""
    points, weights = gauss_points(4)
    cell_volumes = np.linalg.det(jacobians(mesh.points, mesh.cells, points)) @ weights
    return {name: float(cell_volumes[mesh.cell_tags == tag].sum()) for name, tag in mesh.parts.items()}


def joint_areas(mesh: TaggedMesh) -> Mapping[tuple[str, str], float]:
    """Area [m^2] of the facets that two parts share, by their names in alphabetical order."""
    local = face_nodes(mesh.cells.shape[1])
    corners = np.sort(mesh.cells[:, local[:, :4]], axis=2).reshape(-1, 4)
    _, inverse, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    inner = np.flatnonzero(count[inverse.ravel()] == 2)
    shared = inner[np.argsort(inverse.ravel()[inner], kind="stable")].reshape(-1, 2)
    tags = np.sort(mesh.cell_tags[shared // 6], axis=1)
    between = tags[:, 0] != tags[:, 1]
    pairs, first = tags[between], shared[between, 0]
    areas = _facet_areas(mesh, first // 6, first % 6)
    names = {tag: name for name, tag in mesh.parts.items()}
    result: dict[tuple[str, str], float] = {}
    for a, b in np.unique(pairs, axis=0):
        low, high = sorted((names[int(a)], names[int(b)]))
        result[low, high] = float(areas[np.all(pairs == (a, b), axis=1)].sum())
    return result


def _facet_areas(mesh: TaggedMesh, cells: NDArray[np.int64], faces: NDArray[np.int64]) -> Array:
    """Area of local face ``faces[i]`` of cell ``cells[i]``, shape (n,) [m^2]."""
    x, w = np.polynomial.legendre.leggauss(4)
    s, t = (grid.ravel() for grid in np.meshgrid(x, x, indexing="ij"))
    weights = np.outer(w, w).ravel()
    areas = np.zeros(len(cells))
    for face, corners in enumerate(face_nodes(8)):
        mine = np.flatnonzero(faces == face)
        nodes = reference_nodes(8)[corners]
        fixed = int(np.flatnonzero(np.ptp(nodes, axis=0) == 0.0)[0])
        free = [d for d in range(3) if d != fixed]
        at = np.empty((len(s), 3))
        at[:, fixed], at[:, free[0]], at[:, free[1]] = nodes[0, fixed], s, t
        J = jacobians(mesh.points, mesh.cells[cells[mine]], at)
        areas[mine] = np.linalg.norm(np.cross(J[..., free[0]], J[..., free[1]]), axis=-1) @ weights
    return areas
