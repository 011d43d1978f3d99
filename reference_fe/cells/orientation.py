"""Turns the local axes of curved cells so that the first runs along the most curved direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh

__all__ = ["curved_axis_first"]

# gmsh's 27 nodes (MElement numbering: vertices, edges, faces, centre) on the 3 x 3 x 3 lattice of the reference cell
_VERTICES = np.array(
    [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)], dtype=np.int64
)
_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
_FACES = ((0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7))
_LATTICE = np.array(
    [
        *_VERTICES,
        *(_VERTICES[list(edge)].mean(axis=0) for edge in _EDGES),
        *(_VERTICES[list(face)].mean(axis=0) for face in _FACES),
        (1, 1, 1),
    ],
    dtype=np.int64,
)
_STRAIGHT = 1e-5  # relative sagitta below which an axis counts as straight
_NUMBER = {tuple(position): node for node, position in enumerate(_LATTICE.tolist())}


def curved_axis_first(mesh: TaggedMesh, straight: NDArray[np.float64] | None = None) -> TaggedMesh:
    """Renumber each quadratic cell by a turn of its axes (handedness kept); linear meshes come back as they are.

    Parameters
    ----------
    mesh : any tagged mesh
    straight : (3,) direction along which nothing bends, e.g. a wheel's axle, or None; a cell's straight axis along it
        never comes first. Give it where strips are flat: a flat cell does not show which way it will bend.

    Notes
    -----
    The curvature of an axis is the largest distance, over the nine lattice lines along it, between the middle node and
    the middle of its end nodes, relative to the line's length; among straight axes the longest comes first. Two Gauss
    points along this axis and three along the others keep 27-node hexahedra at full rank and free of membrane locking
    (Stolarski & Belytschko 1983 explain the locking of curved elements under full integration).

    Verified by tests/unit/test_fe_orientation.py and tests/verification/test_fe_ring.py.
    """
    if mesh.order == 1:
        return mesh
    if mesh.dim == 2:
        return _planar(mesh)
    nodes = mesh.points[mesh.cells]
    curvature = np.stack([_curvature(nodes, axis) for axis in range(3)], axis=-1)
    if straight is not None:
        edges = nodes[:, [1, 3, 4]] - nodes[:, [0]]
        along = np.abs(edges @ straight) / np.linalg.norm(edges, axis=-1)
        axis = np.argmax(along, axis=-1)[:, None]
        kept = np.take_along_axis(curvature, axis, axis=-1)
        np.put_along_axis(curvature, axis, np.where(kept > _STRAIGHT, kept, -1.0), axis=-1)
    first = np.argmax(curvature, axis=-1)
    turns = np.array([[_NUMBER[tuple(np.roll(position, axis).tolist())] for position in _LATTICE] for axis in range(3)])
    return replace(mesh, cells=np.take_along_axis(mesh.cells, turns[first], axis=1))


_QUARTER_TURN = np.array([1, 2, 3, 0, 5, 6, 7, 4, 8])
"""Nodes of a 9-node quadrilateral in the order of the one turned by a quarter: its first axis is the old second."""


def _planar(mesh: TaggedMesh) -> TaggedMesh:
    """Turn each 9-node quadrilateral whose second axis is the more curved one, or where both are flat the longer."""
    nodes = mesh.points[mesh.cells]
    first = _sagitta(nodes, ((0, 4, 1), (7, 8, 5), (3, 6, 2)))
    second = _sagitta(nodes, ((0, 7, 3), (4, 8, 6), (1, 5, 2)))
    return replace(mesh, cells=np.where((second > first)[:, None], mesh.cells[:, _QUARTER_TURN], mesh.cells))


def _curvature(nodes: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
    """Largest relative sagitta along one axis, (n_cells,) [-]; straight axes get 1e-6 times their share of length."""
    others = [k for k in range(3) if k != axis]
    lines = []
    for i in range(3):
        for j in range(3):
            position = np.zeros((3, 3), dtype=np.int64)
            position[:, others], position[:, axis] = (i, j), (0, 1, 2)
            lines.append([_NUMBER[tuple(p)] for p in position.tolist()])
    return _sagitta(nodes, lines)


def _sagitta(nodes: NDArray[np.float64], lines: Sequence[Sequence[int]]) -> NDArray[np.float64]:
    """The same over the given lattice lines, each its start, middle and end node."""
    start, middle, end = (nodes[:, [line[k] for line in lines]] for k in range(3))
    length = np.linalg.norm(end - start, axis=-1)
    sagitta = np.linalg.norm(middle - 0.5 * (start + end), axis=-1) / length
    extent = np.linalg.norm(nodes.max(axis=1) - nodes.min(axis=1), axis=-1)
    return np.asarray(np.max(sagitta, axis=1) + 1e-6 * length.mean(axis=1) / extent)
