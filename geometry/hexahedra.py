"""Hexahedra of 8 and 27 nodes in gmsh's node order: shape functions, faces, Gauss points, Jacobians.

Verified by tests/unit/test_geometry_hexahedra.py.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "FACE_CORNERS",
    "VTK_FROM_GMSH",
    "face_nodes",
    "gauss_points",
    "jacobians",
    "mirror_order",
    "reference_nodes",
    "shape_gradients",
]

Array = NDArray[np.float64]

_CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], dtype=float
)
_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
FACE_CORNERS = ((0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7))
"""Corners of the six faces, anticlockwise seen from outside (gmsh reference manual, node ordering)."""

VTK_FROM_GMSH = (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26)
"""gmsh node at each place of VTK's triquadratic hexahedron (cell type 29)."""


@cache
def reference_nodes(n_nodes: int) -> Array:
    """Reference coordinates of the nodes, shape (n_nodes, 3), in [-1, 1]^3."""
    edges = [_CORNERS[list(edge)].mean(axis=0) for edge in _EDGES]
    faces = [_CORNERS[list(face)].mean(axis=0) for face in FACE_CORNERS]
    return np.vstack([_CORNERS, edges, faces, np.zeros(3)])[:n_nodes]


@cache
def face_nodes(n_nodes: int) -> NDArray[np.int64]:
    """Local nodes of the six faces, shape (6, 4) or (6, 9): corners, then edge middles, then the centre; outward."""
    nodes = reference_nodes(n_nodes)
    faces = []
    for corners in FACE_CORNERS:
        face = list(corners)
        if n_nodes == 27:
            x = nodes[list(corners)]
            extra = [*(0.5 * (x + np.roll(x, -1, axis=0))), x.mean(axis=0)]
            face += [int(np.flatnonzero(np.all(np.abs(nodes - p) < 1e-9, axis=1))[0]) for p in extra]
        faces.append(face)
    return np.array(faces, dtype=np.int64)


@cache
def mirror_order(n_nodes: int) -> NDArray[np.int64]:
    """Order (n_nodes,) that turns a left-handed cell into a right-handed one (first two directions swapped)."""
    nodes = reference_nodes(n_nodes)
    swapped = nodes[:, [1, 0, 2]]
    return np.array([int(np.flatnonzero(np.all(nodes == p, axis=1))[0]) for p in swapped], dtype=np.int64)


def shape_gradients(n_nodes: int, points: Array) -> Array:
    """Gradients of the Lagrange shape functions.

    Parameters
    ----------
    n_nodes : 8 or 27
    points : (q, 3) float, reference points

    Returns
    -------
    gradients : (q, n_nodes, 3) float, d N_a / d xi_j
    """
    nodes = reference_nodes(n_nodes)
    value, slope = np.empty((2, len(points), n_nodes, 3))
    for d in range(3):
        x, at = points[:, d][:, None], nodes[:, d][None, :]
        if n_nodes == 8:
            value[..., d], slope[..., d] = 0.5 * (1.0 + at * x), 0.5 * at + 0.0 * x
        else:
            side = at != 0.0
            value[..., d] = np.where(side, 0.5 * x * (x + at), 1.0 - x * x)
            slope[..., d] = np.where(side, x + 0.5 * at, -2.0 * x)
    gradients = np.empty((len(points), n_nodes, 3))
    for d in range(3):
        others = [k for k in range(3) if k != d]
        gradients[..., d] = slope[..., d] * value[..., others[0]] * value[..., others[1]]
    return gradients


def gauss_points(n: int) -> tuple[Array, Array]:
    """Tensor Gauss rule with n points a direction: points (n^3, 3) and weights (n^3,) on [-1, 1]^3."""
    x, w = np.polynomial.legendre.leggauss(n)
    points = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1).reshape(-1, 3)
    return points, np.einsum("i,j,k->ijk", w, w, w).ravel()


def jacobians(points: Array, cells: NDArray[np.int64], at: Array) -> Array:
    """Jacobian matrices d x_i / d xi_j of all cells at reference points ``at`` (q, 3); shape (n_cells, q, 3, 3) [m]."""
    gradients = shape_gradients(cells.shape[1], at)
    result: Array = np.einsum("cai,qaj->cqij", points[cells], gradients, optimize=True)
    return result
