"""How deep the bodies of a mesh lie in one another, from their deformed shape alone.

Neither the contact's lists of faces nor its search is asked: points on every free facet of every body are looked for in
every cell of every other body. A body is a connected piece of a part, such as one strip of a spring set.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from contracts.mesh import TaggedMesh
from geometry.hexahedra import face_nodes, jacobians, reference_nodes, shape_gradients

__all__ = ["Overlap", "PartsOverlap"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_LATTICE = np.linspace(-1.0, 1.0, 9)
_STEPS = 5
_FOUND = 1e-7
"""How near a point must come to its place in a cell [m]."""
_CENTRE = np.zeros((1, 3))


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlap:
    """The deepest point of one body in another: depth [m], 0 where there is none, both parts, its place [m]."""

    depth: float
    parts: tuple[str, str] = ("", "")
    place: tuple[float, ...] = ()


class PartsOverlap:
    """Bodies of a mesh of hexahedra, and their free facets; a plane of symmetry is none.

    A point counts with its distance from the nearest face of the body in whose cell it lies, welds included. Where a
    body has passed right through a thin one the depth is at most the thin one's thickness: enough to tell that it has.

    Verified by tests/unit/test_fe_parts_overlap.py and tests/verification/test_fe_touching_parts.py.
    """

    def __init__(self, mesh: TaggedMesh) -> None:
        self._mesh, self._body = mesh, _bodies(mesh)
        local = face_nodes(mesh.cells.shape[1])
        facets = mesh.cells[:, local].reshape(-1, local.shape[1])
        corners = np.sort(facets[:, :4], axis=1)
        real = np.ones(len(facets), dtype=np.bool_)
        if "symmetry" in mesh.faces:
            real = ~(np.abs(mesh.points[facets, 1]) < 1e-9).all(axis=1)
        ends = _alone(np.column_stack([corners, np.repeat(self._body, 6)])) & real
        self._ends = ends.reshape(-1, 6)
        free = np.flatnonzero(_alone(corners) & real)
        self._facets, self._owner, self._side = facets[free], free // 6, free % 6

    def deepest(self, displacement: Array) -> Overlap:
        """Deepest of 9 x 9 points of each free facet in another body, for displacements (n_points, 3) [m]."""
        current = self._mesh.points + displacement
        points, owner, cell = self._candidates(current)
        depth = self._depths(current, cell, _reference_places(points, current[self._mesh.cells[cell]]))
        if depth.max(initial=0.0) <= 0.0:
            return Overlap(depth=0.0)
        worst = int(depth.argmax())
        names = {tag: name for name, tag in self._mesh.parts.items()}
        first, second = (names[int(self._mesh.cell_tags[c])] for c in (owner[worst], cell[worst]))
        return Overlap(depth=float(depth[worst]), parts=(first, second), place=tuple(points[worst].tolist()))

    def _candidates(self, current: Array) -> tuple[Array, Index, Index]:
        """Points (m, 3) [m] on free facets, the facets' cells, and the cells of other bodies in whose box they lie.

        A cell's box is along the axes of its middle; facets are tried before their points.
        """
        nodes = current[self._mesh.cells]
        middle, axes = nodes.mean(axis=1), jacobians(current, self._mesh.cells, _CENTRE)[:, 0]
        inverse = np.linalg.inv(axes)
        place = np.einsum("cij,cnj->cni", inverse, nodes - middle[:, None])
        low, high = place.min(axis=1), place.max(axis=1)
        facet, cell = self._near(current[self._facets], nodes)
        at = np.einsum("mij,mnj->mni", inverse[cell], current[self._facets[facet]] - middle[cell][:, None])
        room = 0.25 * np.ptp(at, axis=1)  # a curved facet may bulge out of the box of its nodes
        meets = ((at.max(axis=1) + room >= low[cell]) & (at.min(axis=1) - room <= high[cell])).all(axis=1)
        facet, cell = facet[meets], np.repeat(cell[meets], len(_LATTICE) ** 2)
        points, owner = self._points(nodes, facet)
        there = np.einsum("mij,mj->mi", inverse[cell], points - middle[cell])
        inside = ((there >= low[cell] - 0.1) & (there <= high[cell] + 0.1)).all(axis=1)
        return points[inside], owner[inside], cell[inside]

    def _near(self, facets: Array, cells: Array) -> tuple[Index, Index]:
        """Pairs of a facet and a cell of another body whose bounding spheres meet, from their nodes [m]."""
        (facet_middle, facet_radius), (middle, radius) = _spheres(facets), _spheres(cells)
        balls = cKDTree(facet_middle).query_ball_point(middle, radius + facet_radius.max())
        cell = np.repeat(np.arange(len(balls)), [len(ball) for ball in balls])
        facet = np.concatenate([np.zeros(0, dtype=np.int64), *(np.array(b, dtype=np.int64) for b in balls)])
        other = self._body[self._owner[facet]] != self._body[cell]
        return facet[other], cell[other]

    def _points(self, nodes: Array, facet: Index) -> tuple[Array, Index]:
        """The lattice on each facet, (m, 3) [m], and the facet's cell, (m,)."""
        n = nodes.shape[1]
        shapes = np.stack([_shapes(n, _lattice(n, side)) for side in range(6)])
        owner = self._owner[facet]
        found = np.einsum("fsn,fnk->fsk", shapes[self._side[facet]], nodes[owner])
        return found.reshape(-1, 3), np.repeat(owner, shapes.shape[1])

    def _depths(self, current: Array, cell: Index, xi: Array) -> Array:
        """Distance [m] of places xi (m, 3) in the cells from their body's nearest face; negative outside the cell."""
        matrix = np.einsum(
            "mai,maj->mij", current[self._mesh.cells[cell]], shape_gradients(self._mesh.cells.shape[1], xi)
        )
        height = 1.0 / np.linalg.norm(np.linalg.inv(matrix), axis=2)  # of xi_j = 1 over xi_j = 0
        n = self._mesh.cells.shape[1]
        depth = np.full(len(cell), np.inf)
        for side in range(6):
            axis, sign = _axis(n, side)
            below = (1.0 - sign * xi[:, axis]) * height[:, axis]
            counts = self._ends[cell, side] | (below < 0.0)
            depth = np.where(counts, np.minimum(depth, below), depth)
        return np.where(np.isfinite(depth), depth, 0.0)


def _alone(rows: Index) -> NDArray[np.bool_]:
    """Which rows occur once."""
    _, same, count = np.unique(rows, axis=0, return_inverse=True, return_counts=True)
    return np.asarray(count[same.ravel()] == 1)


def _spheres(nodes: Array) -> tuple[Array, Array]:
    middle = nodes.mean(axis=1)
    return middle, np.linalg.norm(nodes - middle[:, None], axis=2).max(axis=1)


def _axis(n_nodes: int, side: int) -> tuple[int, float]:
    """Which reference coordinate is constant on a cell's side, and there."""
    x = reference_nodes(n_nodes)[face_nodes(n_nodes)[side, :4]]
    (axis,) = np.flatnonzero(np.ptp(x, axis=0) == 0.0)
    return int(axis), float(x[0, axis])


def _lattice(n_nodes: int, side: int) -> Array:
    """Reference coordinates of 9 x 9 points on a cell's side, edges included."""
    axis, sign = _axis(n_nodes, side)
    at = np.full((len(_LATTICE) ** 2, 3), sign)
    at[:, [k for k in range(3) if k != axis]] = np.stack(np.meshgrid(_LATTICE, _LATTICE), axis=-1).reshape(-1, 2)
    return at


def _bodies(mesh: TaggedMesh) -> Index:
    """Number of each cell's body: cells of one part that share nodes, directly or through others."""
    cells = len(mesh.cells)
    of_part = mesh.cells[:, :8] + len(mesh.points) * mesh.cell_tags[:, None].astype(np.int64)
    _, node = np.unique(of_part, return_inverse=True)
    rows = np.repeat(np.arange(cells), 8)
    graph = coo_array((np.ones(len(rows)), (rows, node.ravel() + cells)), shape=(cells + node.max() + 1,) * 2)
    _, label = connected_components(graph, directed=False)
    return np.asarray(label[:cells], dtype=np.int64)


def _reference_places(points: Array, nodes: Array) -> Array:
    """Reference coordinates (m, 3) of points (m, 3) in cells of nodes (m, n, 3), by Newton's method; 2: not found."""
    n, xi = nodes.shape[1], np.zeros_like(points)
    for _ in range(_STEPS):
        offset = points - np.einsum("mn,mnk->mk", _shapes(n, xi), nodes)
        matrix = np.einsum("mai,maj->mij", nodes, shape_gradients(n, xi))
        xi = np.clip(xi + np.linalg.solve(matrix, offset[:, :, None])[:, :, 0], -1.5, 1.5)
    missed = np.linalg.norm(points - np.einsum("mn,mnk->mk", _shapes(n, xi), nodes), axis=1)
    return np.where(missed[:, None] < _FOUND, xi, 2.0)


def _shapes(n_nodes: int, xi: Array) -> Array:
    """Lagrange shape functions of 8 or 27 nodes at xi (q, 3), (q, n_nodes)."""
    at, x = reference_nodes(n_nodes)[None], xi[:, None]
    if n_nodes == 8:
        return np.asarray(np.prod(0.5 * (1.0 + at * x), axis=2))
    return np.asarray(np.prod(np.where(at != 0.0, 0.5 * x * (x + at), 1.0 - x * x), axis=2))
