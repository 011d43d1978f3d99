"""How far tetrahedra are from degenerate: their own scaled Jacobian, as the hexahedra they are solved as have another.

Verified by tests/unit/test_own_mesh_completion.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geometry.own_mesh.completion import TETRAHEDRON_EDGES, tetrahedron_gradients

__all__ = ["scaled_jacobians_of_tetrahedra"]

_CORNERS = ((0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (3, 0, 2, 1))
"""A corner and the three others."""


def scaled_jacobians_of_tetrahedra(points: NDArray[np.float64], cells: NDArray[np.int64]) -> NDArray[np.float64]:
    """Smallest over corners and middles of edges of sqrt(2) det J / max_a prod_b |t_ab|, (m,) [-].

    t_ab are the tangents along the three edges at corner a, of the map at that place; the largest of the four products
    counts. 1 for a regular tetrahedron, 0 for a flat one (Stimpson et al. 2007, SAND2007-1751, there of straight ones;
    from memory).

    points : (n, 3) float; cells : (m, 4 or 10) int, gmsh's order
    """
    corners = np.eye(4)
    at = np.vstack([corners, [0.5 * (corners[i] + corners[j]) for i, j in TETRAHEDRON_EDGES]])
    slopes = np.einsum("qnb,cni->cqbi", tetrahedron_gradients(at, cells.shape[1]), points[cells])
    largest = np.zeros(slopes.shape[:2])
    for a, *others in _CORNERS:
        tangents = slopes[:, :, others] - slopes[:, :, a, None]
        largest = np.maximum(largest, np.prod(np.linalg.norm(tangents, axis=-1), axis=-1))
    det = np.linalg.det(slopes[:, :, 1:] - slopes[:, :, :1])
    return np.asarray((np.sqrt(2.0) * det / np.maximum(largest, np.finfo(float).tiny)).min(axis=1))
