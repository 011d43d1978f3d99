"""Cells of other kinds as the hexahedra that are solved: middle nodes added, tetrahedra in four, all divided on.

Verified by tests/unit/test_own_mesh_completion.py.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.hexahedra import FACE_CORNERS, face_nodes, reference_nodes

__all__ = [
    "TETRAHEDRON_EDGES",
    "TETRAHEDRON_FACES",
    "Hexahedra",
    "completed",
    "corners_of_faces",
    "refined",
    "tetrahedron_gradients",
]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

TETRAHEDRON_FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (3, 1, 2))
"""Corners of the four faces, seen from outside anticlockwise; numbered as gmsh does."""
TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
"""Ends of the edges whose middles are nodes 4 to 9 of gmsh's 10-node tetrahedron."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hexahedra:
    """Hexahedra that stand for the cells of a file.

    Attributes
    ----------
    points : (n, 3) float, the file's points, those that were added behind them
    cells : (m, 8 or 27) int, gmsh's order
    cell_of : (m,) int, the file's cell that each is a part of
    faces : (n_file_cells, file faces, pieces, 2) int, hexahedron and its face, for each face of a cell of the file
    """

    points: Array
    cells: Index
    cell_of: Index
    faces: Index


def corners_of_faces(n_nodes: int) -> tuple[tuple[int, ...], ...]:
    """Corners of each face of a cell with so many nodes."""
    return TETRAHEDRON_FACES if n_nodes in (4, 10) else FACE_CORNERS


def completed(points: Array, cells: Index) -> Hexahedra:
    """The same body in hexahedra: of 8 and 27 nodes as they are, of 20 with the middles of faces and body added by
    their own shape functions (serendipity), tetrahedra as four hexahedra each on the tetrahedron's own map.

    points : (n, 3) float; cells : (m, 4, 8, 10, 20 or 27) int, gmsh's order
    """
    count = cells.shape[1]
    if count in (4, 10):
        return _of_tetrahedra(points, cells)
    if count == 20:
        points, cells = _serendipity(points, cells)
    here = np.arange(len(cells))
    faces = np.stack(np.broadcast_arrays(here[:, None, None], np.arange(6)[None, :, None]), axis=-1)
    return Hexahedra(points=points, cells=cells, cell_of=here, faces=faces)


def _serendipity(points: Array, cells: Index) -> tuple[Array, Index]:
    """27 nodes from 20: a face's middle is half the sum of its edges' middles less a quarter of that of its corners;
    the body's, by the twelve edges and eight corners, is a quarter of the former less a quarter of the latter.
    """
    local = face_nodes(27)
    corners, middles = cells[:, local[:, :4]], cells[:, local[:, 4:8]]
    places = 0.5 * points[middles].sum(axis=2) - 0.25 * points[corners].sum(axis=2)
    _, first, number = np.unique(
        np.sort(corners.reshape(-1, 4), axis=1), axis=0, return_index=True, return_inverse=True
    )
    on_faces = len(points) + number.reshape(-1, 6)
    body = 0.25 * points[cells[:, 8:]].sum(axis=1) - 0.25 * points[cells[:, :8]].sum(axis=1)
    in_cells = len(points) + len(first) + np.arange(len(cells))[:, None]
    return np.concatenate([points, places.reshape(-1, 3)[first], body]), np.hstack([cells, on_faces, in_cells])


def _of_tetrahedra(points: Array, cells: Index) -> Hexahedra:
    """Four hexahedra at the four corners of each tetrahedron, order 1 of 4 nodes, order 2 of 10 nodes."""
    order = 1 if cells.shape[1] == 4 else 2
    pieces = _corner_hexahedra()
    nodes = reference_nodes(8 if order == 1 else 27)
    shapes = np.stack([np.prod(0.5 * (1.0 + nodes[:, None] * reference_nodes(8)[None]), axis=2)] * 4)
    weights = np.einsum("pnk,pkb->pnb", shapes, pieces)
    keys, number = np.unique(np.round(weights.reshape(-1, 4) * 96).astype(np.int64), axis=0, return_inverse=True)
    at = keys / 96.0  # each weight is a whole number of 96ths
    places = np.einsum("qn,cnk->cqk", _tetrahedron_shapes(at, cells.shape[1]), points[cells])
    rows = _shared(cells[:, :4], keys).reshape(len(cells), -1)
    _, first, flat = np.unique(rows.ravel(), return_index=True, return_inverse=True)
    made = flat.reshape(rows.shape)[:, number.reshape(4, -1)]
    faces = np.array([[_outer_face(pieces[corner], face) for corner in face] for face in TETRAHEDRON_FACES])
    owners = 4 * np.arange(len(cells))[:, None, None] + np.array(TETRAHEDRON_FACES)
    return Hexahedra(
        points=places.reshape(-1, 3)[first],
        cells=made.reshape(-1, made.shape[2]),
        cell_of=np.repeat(np.arange(len(cells)), 4),
        faces=np.stack(np.broadcast_arrays(owners, faces), axis=-1),
    )


def _corner_hexahedra() -> Array:
    """Barycentric coordinates (4, 8, 4) of the corners of the hexahedron at each corner of a tetrahedron."""
    unit = np.eye(4)

    def middle(*corners: int) -> Array:
        return np.asarray(unit[list(corners)].mean(axis=0))

    found = []
    for a in range(4):
        b, c, d = (k for k in range(4) if k != a)
        if sum(x > y for x, y in itertools.combinations((a, b, c, d), 2)) % 2:
            c, d = d, c  # as right-handed as the tetrahedron
        found.append(
            [
                *(unit[a], middle(a, b), middle(a, b, c), middle(a, c)),
                *(middle(a, d), middle(a, b, d), middle(a, b, c, d), middle(a, c, d)),
            ]
        )
    return np.array(found)


def _outer_face(piece: Array, face: tuple[int, ...]) -> int:
    """The face of a piece that lies in a face of the tetrahedron."""
    (absent,) = set(range(4)) - set(face)
    return next(k for k, corners in enumerate(FACE_CORNERS) if np.all(piece[list(corners)][:, absent] == 0.0))


def _tetrahedron_shapes(at: Array, n_nodes: int) -> Array:
    """Shape functions (q, n_nodes) at barycentric coordinates (q, 4)."""
    if n_nodes == 4:
        return at
    middles = np.stack([4.0 * at[:, i] * at[:, j] for i, j in TETRAHEDRON_EDGES], axis=1)
    return np.hstack([at * (2.0 * at - 1.0), middles])


def tetrahedron_gradients(at: Array, n_nodes: int) -> Array:
    """Derivatives (q, n_nodes, 4) of the shape functions by each barycentric coordinate at such coordinates (q, 4)."""
    unit = np.eye(4)
    if n_nodes == 4:
        return np.broadcast_to(unit, (len(at), 4, 4))
    corners = (4.0 * at - 1.0)[:, :, None] * unit
    middles = [4.0 * (at[:, i, None] * unit[j] + at[:, j, None] * unit[i]) for i, j in TETRAHEDRON_EDGES]
    return np.concatenate([corners, np.stack(middles, axis=1)], axis=1)


def _shared(corners: Index, keys: Index) -> Index:
    """A number for each of the places ``keys`` (q, 4) of every cell, the same in all cells that share it.

    A place is known by its corners with their weights: those with weight zero do not count.
    """
    weights = np.broadcast_to(keys, (len(corners), *keys.shape))
    nodes = np.where(weights > 0, corners[:, None, :], -1)
    order = np.argsort(nodes, axis=2, kind="stable")
    rows = [np.take_along_axis(one, order, axis=2) for one in (nodes, weights)]
    _, number = np.unique(np.concatenate(rows, axis=2).reshape(-1, 8), axis=0, return_inverse=True)
    return np.asarray(number.ravel(), dtype=np.int64)


def refined(made: Hexahedra, factor: int) -> Hexahedra:
    """Each hexahedron divided into ``factor`` along each of its axes, on its own map: the same body, nested meshes.

    Nodes of neighbours are one where they are the same sum of the same nodes: the numerators of their weights, whole
    numbers, times a random number of 64 bits a node, added up without rounding, tell them apart.
    """
    if factor == 1:
        return made
    n_nodes = made.cells.shape[1]
    order = 1 if n_nodes == 8 else 2
    steps = order * factor
    line = np.arange(steps + 1)
    lattice = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    numerators = _numerators(lattice, n_nodes, factor)
    hashes = np.random.default_rng(1).integers(0, 2**64, len(made.points), dtype=np.uint64)
    keys = hashes[made.cells] @ numerators.T.astype(np.uint64)
    _, first, number = np.unique(keys.ravel(), return_index=True, return_inverse=True)
    places = np.einsum("qn,cnk->cqk", numerators / numerators.sum(axis=1, keepdims=True), made.points[made.cells])
    number = number.reshape(keys.shape)

    child = np.stack(np.meshgrid(*[np.arange(factor)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    own = np.round(0.5 * order * (reference_nodes(n_nodes) + 1.0)).astype(np.int64)
    at = (order * child[:, None] + own[None]) @ np.array([(steps + 1) ** 2, steps + 1, 1])
    sides = [_children_of(face, child, factor) for face in face_nodes(8)]
    pieces = len(child)
    faces = np.stack(
        [
            pieces * made.faces[..., 0, None] + np.array(sides)[made.faces[..., 1]],
            np.broadcast_to(made.faces[..., 1, None], (*made.faces.shape[:-1], factor**2)),
        ],
        axis=-1,
    )
    return Hexahedra(
        points=places.reshape(-1, 3)[first],
        cells=number[:, at].reshape(-1, n_nodes),
        cell_of=np.repeat(made.cell_of, pieces),
        faces=faces.reshape(*made.faces.shape[:2], -1, 2),
    )


def _numerators(lattice: Index, n_nodes: int, factor: int) -> Index:
    """Lagrange shape functions (q, n_nodes) at places of a lattice (q, 3), times the same whole number for all."""
    nodes = reference_nodes(n_nodes)
    found = np.ones((len(lattice), n_nodes), dtype=np.int64)
    for axis in range(3):
        x, end = lattice[:, axis, None], nodes[None, :, axis].astype(np.int64)
        if n_nodes == 8:
            found *= np.where(end > 0, x, factor - x)
        else:
            x = x - factor
            found *= np.where(end == 0, 2 * (factor**2 - x**2), x * (x + factor * end))
    return found


def _children_of(face: Index, child: Index, factor: int) -> Index:
    """Numbers of the children that lie at a face of their parent, given by its corners."""
    corners = reference_nodes(8)[face]
    axis = int(np.flatnonzero(np.ptp(corners, axis=0) == 0.0)[0])
    return np.flatnonzero(child[:, axis] == (factor - 1 if corners[0, axis] > 0.0 else 0))
