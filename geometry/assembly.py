"""From the cells of separate solids to one conforming mesh: merge nodes, turn cells, find and tag the boundary.

Verified by tests/unit/test_geometry_assembly.py and tests/verification/test_mesh_conformity.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from geometry.hexahedra import face_nodes, jacobians, mirror_order

__all__ = ["FREE", "MERGE_DISTANCE", "RawMesh", "assemble", "boundary_facets", "join", "merge_nodes"]

FREE = "free"
MERGE_DISTANCE = 1e-8
"""Nodes closer than this [m] are one node."""

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class RawMesh:
    """Solids meshed one by one, in node numbers of ``points`` [m].

    Attributes
    ----------
    points : (n, 3) float [m]
    cells : (part, (k, 8 or 27) int) of each solid
    quadrangles : (face group, (k, 4) int corner nodes) of each named surface
    """

    points: Array
    cells: Sequence[tuple[str, Index]]
    quadrangles: Sequence[tuple[str, Index]]


def join(first: RawMesh, second: RawMesh) -> RawMesh:
    """Put two raw meshes into one numbering; nothing is merged yet."""
    shift = len(first.points)
    return RawMesh(
        points=np.concatenate([first.points, second.points]),
        cells=[*first.cells, *((part, cells + shift) for part, cells in second.cells)],
        quadrangles=[*first.quadrangles, *((group, quads + shift) for group, quads in second.quadrangles)],
    )


def assemble(raw: RawMesh, part_names: Sequence[str]) -> TaggedMesh:
    """Merge the solids into one mesh; cells sorted by part, each boundary facet in a group (``"free"`` if unnamed)."""
    cells = np.concatenate([c for name in part_names for part, c in raw.cells if part == name])
    counts = [sum(len(c) for part, c in raw.cells if part == name) for name in part_names]
    same = merge_nodes(raw.points)
    kept, flat = np.unique(same[cells], return_inverse=True)
    points, cells = raw.points[kept], flat.reshape(cells.shape).astype(np.int64)
    number = np.full(len(raw.points), -1, dtype=np.int64)
    number[kept] = np.arange(len(kept))
    number = number[same]
    cells = _right_handed(points, cells)
    facets = boundary_facets(cells)
    tags, faces = _tag_facets(facets, [(group, number[quads]) for group, quads in raw.quadrangles])
    return TaggedMesh(
        points=points,
        cells=cells,
        cell_tags=np.repeat(np.arange(1, len(part_names) + 1), counts).astype(np.int32),
        facets=facets,
        facet_tags=tags,
        parts={name: k + 1 for k, name in enumerate(part_names)},
        faces=faces,
    )


def merge_nodes(points: Array) -> Index:
    """For each node the smallest number among the nodes at the same place, shape (n,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(MERGE_DISTANCE, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    _, label = connected_components(graph, directed=False)
    _, first = np.unique(label, return_index=True)
    return np.asarray(first[label], dtype=np.int64)


def boundary_facets(cells: Index) -> Index:
    """Facets that belong to one cell only, (n, 4) or (n, 9), outward, ordered by cell."""
    facets = cells[:, face_nodes(cells.shape[1])].reshape(-1, 4 if cells.shape[1] == 8 else 9)
    _, inverse, count = np.unique(np.sort(facets[:, :4], axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.asarray(facets[count[inverse.ravel()] == 1], dtype=np.int64)


def _right_handed(points: Array, cells: Index) -> Index:
    centre = np.linalg.det(jacobians(points, cells, np.zeros((1, 3))))[:, 0]
    turned: Index = cells.copy()
    turned[centre < 0.0] = cells[centre < 0.0][:, mirror_order(cells.shape[1])]
    return turned


def _tag_facets(facets: Index, quadrangles: Sequence[tuple[str, Index]]) -> tuple[NDArray[np.int32], dict[str, int]]:
    """Tag of each boundary facet from the named surfaces' corner nodes, and the tag of each group that occurs."""
    groups = [*dict.fromkeys(group for group, _ in quadrangles), FREE]
    number = {group: k + 1 for k, group in enumerate(groups)}
    named = np.concatenate([np.sort(quads, axis=1) for _, quads in quadrangles])
    named_tags = np.concatenate([np.full(len(quads), number[group]) for group, quads in quadrangles])
    corners = np.sort(facets[:, :4], axis=1)
    _, key = np.unique(np.concatenate([named, corners]), axis=0, return_inverse=True)
    key = key.ravel()
    by_key = np.full(int(key.max()) + 1, number[FREE], dtype=np.int32)
    by_key[key[: len(named)]] = named_tags
    tags = by_key[key[len(named) :]]
    present = {group: tag for group, tag in number.items() if np.any(tags == tag)}
    return tags, present
