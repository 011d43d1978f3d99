"""Geometry of the touching faces: first touch with a plane, contact area and patch length."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh

__all__ = [
    "ContactPatch",
    "contact_faces",
    "distance_at_touch",
    "facet_areas",
    "facet_samples",
    "facet_widths",
    "lattice_order",
    "measure_patch",
]

_SAMPLES = 13
_DENSE_SAMPLES = 25
_GAUSS_POINTS = 9


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactPatch:
    """Where the body touches the obstacle.

    Attributes
    ----------
    area : undeformed area of the touching faces [m^2]
    length : extent of the touching faces along ``tangent`` [m]; 0 without contact
    penetration : largest depth in the obstacle anywhere on the faces, edges included [m], >= 0
    """

    area: float
    length: float
    penetration: float


def contact_faces(mesh: TaggedMesh, names: Iterable[str]) -> NDArray[np.int64]:
    """Node numbers of the facets of the named faces, (n_facets, 4 or 9), or (n_facets, 2 or 3) of a planar mesh."""
    tags = [mesh.faces[name] for name in names]
    return mesh.facets[np.isin(mesh.facet_tags, tags)]


def distance_at_touch(mesh: TaggedMesh, facets: NDArray[np.int64], direction: NDArray[np.float64]) -> float:
    """Distance from the origin to a plane that just touches the undeformed faces.

    Parameters
    ----------
    direction : (dim,) unit vector from the origin to the plane [-]

    Returns
    -------
    distance : largest component of the faces' points along ``direction`` [m], faces sampled on a 13 x 13 lattice
    """
    shape, _ = _lattice(facets.shape[1])
    return float(np.max(np.einsum("sn,fnk,k->fs", shape, mesh.points[facets], direction)))


def facet_samples(
    points: NDArray[np.float64], facets: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points on the facets, edges included, and unit normals there, (n, dim) each, for node positions [m]."""
    shape, derivatives = _lattice(facets.shape[1])
    dim = points.shape[1]
    normals = _area_vectors(derivatives, points[facets]).reshape(-1, dim)
    positions = np.einsum("sn,fnk->fsk", shape, points[facets]).reshape(-1, dim)
    return positions, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def measure_patch(
    mesh: TaggedMesh,
    facets: NDArray[np.int64],
    displacement: NDArray[np.float64],
    gap_of: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    tangent: NDArray[np.float64],
    touch_gap: float = 0.0,
) -> ContactPatch:
    """Contact patch of the deformed faces, from 9 x 9 Gauss points on each facet; its depth from a 25 x 25 lattice.

    Inner points only for the area: a face that meets the ground at its edge, such as a grouser's flank, adds none. The
    depth is looked for up to the edges, where the Gauss points of the contact itself do not reach.

    Parameters
    ----------
    displacement : (n_points, dim) [m] at the mesh's nodes
    gap_of : normal gap (n,) [m] of points (n, dim) [m] from the obstacle
    tangent : (dim,) unit vector in the ground along which the length is measured [-]
    touch_gap : normal gap below which a point counts as touching [m], e.g. the ramp of the contact law
    """
    shape, areas = facet_areas(mesh, facets, _GAUSS_POINTS)
    current = np.einsum("sn,fnk->fsk", shape, (mesh.points + displacement)[facets])
    gap = gap_of(current.reshape(-1, current.shape[-1])).reshape(current.shape[:-1])
    closed = gap < touch_gap
    if not closed.any():
        return ContactPatch(area=0.0, length=0.0, penetration=0.0)
    along = (current @ tangent)[closed]
    area = float(np.sum(np.where(closed, areas, 0.0)))
    near = gap.min(axis=1) < touch_gap + np.ptp(gap, axis=1)
    dense, _ = _lattice(facets.shape[1], _DENSE_SAMPLES)
    points = np.einsum("sn,fnk->fsk", dense, (mesh.points + displacement)[facets[near]])
    lowest = float(gap_of(points.reshape(-1, points.shape[-1])).min())
    return ContactPatch(area=area, length=float(np.ptp(along)), penetration=max(0.0, -lowest))


def facet_areas(
    mesh: TaggedMesh, facets: NDArray[np.int64], points: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shape functions (s, n) at a facet's Gauss points, so many an axis, and their undeformed areas (n_facets, s)."""
    shape, derivatives, weights = _gauss(facets.shape[1], points)
    jacobian = np.linalg.norm(_area_vectors(derivatives, mesh.points[facets]), axis=-1)
    return shape, jacobian * weights * facet_widths(mesh, facets)[:, None]


def facet_widths(mesh: TaggedMesh, facets: NDArray[np.int64]) -> NDArray[np.float64]:
    """Width of the part that each facet of a planar mesh belongs to, (n_facets,) [m]; ones for a solid mesh."""
    widths = np.ones(len(facets))
    for part, width in mesh.widths.items():
        nodes = np.unique(mesh.cells[mesh.cell_tags == mesh.parts[part]])
        widths[np.isin(facets, nodes).all(axis=1)] = width
    return widths


def lattice_order(nodes: int) -> tuple[tuple[int, int], ...]:
    """Place of each of a facet's 4 or 9 nodes on the lattice of its two axes."""
    return _ORDER[nodes]


def _area_vectors(derivatives: NDArray[np.float64], nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normals as long as the area (length of an edge) per reference area, (n_facets, s, dim)."""
    tangents = np.einsum("asn,fnk->afsk", derivatives, nodes)
    if len(tangents) == 1:
        return np.stack([tangents[0, ..., 1], -tangents[0, ..., 0]], axis=-1)
    return np.asarray(np.cross(tangents[0], tangents[1]))


def _lattice(nodes: int, samples: int = _SAMPLES) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Facet sampled up to its edges: shape functions (s, n) and derivatives (dim - 1, s, n)."""
    return _shapes(np.linspace(-1.0, 1.0, samples), nodes)


def _gauss(nodes: int, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Gauss points of a facet: shape functions (s, n), derivatives (dim - 1, s, n), weights (s,)."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return (*_shapes(points, nodes), weights if nodes in _EDGE_ORDER else np.outer(weights, weights).ravel())


def _shapes(edge: NDArray[np.float64], nodes: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shape functions and derivatives on the square lattice over ``edge``, or on the line of a planar mesh's facet."""
    if nodes in _EDGE_ORDER:
        on_line = np.array(_line(edge, nodes))[:, _EDGE_ORDER[nodes]]
        return on_line[0].T, on_line[1:].swapaxes(1, 2)
    a, b = (grid.ravel() for grid in np.meshgrid(edge, edge, indexing="ij"))
    la, da = _line(a, nodes)
    lb, db = _line(b, nodes)
    order = lattice_order(nodes)
    along = np.stack([da[i] * lb[j] for i, j in order], axis=-1)
    across = np.stack([la[i] * db[j] for i, j in order], axis=-1)
    return np.stack([la[i] * lb[j] for i, j in order], axis=-1), np.stack([along, across])


_EDGE_ORDER = {2: [0, 1], 3: [0, 2, 1]}
_ORDER = {
    4: ((0, 0), (1, 0), (1, 1), (0, 1)),
    9: ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)),
}


def _line(s: NDArray[np.float64], nodes: int) -> tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]]:
    """Lagrange polynomials on [-1, 1] at s, and their derivatives: linear (2) or quadratic (3 of them)."""
    if nodes in (2, 4):
        half = np.full_like(s, 0.5)
        return [(1 - s) / 2, (1 + s) / 2], [-half, half]
    return [s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2], [s - 0.5, -2 * s, s + 0.5]
