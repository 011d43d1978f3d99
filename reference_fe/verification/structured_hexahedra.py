"""Structured hexahedral meshes: a block of cells mapped to any shape, in gmsh's node order.

Verified by tests/verification/test_fe_patch.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh

__all__ = ["block_mesh", "merged", "stacked"]

# Positions of gmsh's 27 nodes (MElement numbering: vertices, edges, faces, centre) on the 3 x 3 x 3 lattice.
_VERTICES = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
_EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
_FACES = [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]


def _mean(nodes: tuple[int, ...]) -> tuple[int, int, int]:
    return tuple(int(sum(_VERTICES[n][k] for n in nodes) / len(nodes)) for k in range(3))  # type: ignore[return-value]


_LATTICE = np.array([*_VERTICES, *map(_mean, _EDGES), *map(_mean, _FACES), (1, 1, 1)])
_QUAD = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]


def block_mesh(
    counts: tuple[int, int, int],
    mapping: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    order: int = 2,
) -> TaggedMesh:
    """Block of cells over the unit cube, mapped by ``mapping``; faces ``x0 x1 y0 y1 z0 z1``, one part ``body``.

    Parameters
    ----------
    counts : cells along the cube's three axes
    mapping : from points (n, 3) [-] of the unit cube to their places (n, 3) [m]
    order : 2 for 27 nodes a cell, else 8
    """
    step = 2 if order == 2 else 1
    n = np.array(counts) * step + 1
    lattice = np.stack(np.meshgrid(*[np.arange(k) for k in n], indexing="ij"), axis=-1).reshape(-1, 3)
    points = mapping(lattice / (n - 1.0))

    def number(position: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.asarray((position[..., 0] * n[1] + position[..., 1]) * n[2] + position[..., 2])

    local = _LATTICE if order == 2 else _LATTICE[:8] // 2
    corner = np.stack(np.meshgrid(*[np.arange(k) for k in counts], indexing="ij"), axis=-1).reshape(-1, 1, 3) * step
    cells = number(corner + local[None])
    quad = np.array(_QUAD if order == 2 else _QUAD[:4]) // (1 if order == 2 else 2)
    facets, tags = [], []
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        grid = np.stack(np.meshgrid(*[np.arange(counts[k]) for k in others], indexing="ij"), axis=-1).reshape(-1, 1, 2)
        for side, level in enumerate((0, n[axis] - 1)):
            position = np.full((len(grid), len(quad), 3), level)
            position[..., others] = grid * step + quad[None]
            facets.append(number(position))
            tags.append(np.full(len(grid), 2 * axis + side + 1))
    return TaggedMesh(
        points=points,
        cells=cells,
        cell_tags=np.ones(len(cells), dtype=np.int32),
        facets=np.concatenate(facets),
        facet_tags=np.concatenate(tags).astype(np.int32),
        parts={"body": 1},
        faces={"x0": 1, "x1": 2, "y0": 3, "y1": 4, "z0": 5, "z1": 6},
    )


def stacked(first: TaggedMesh, second: TaggedMesh, part: str) -> TaggedMesh:
    """Two separate bodies in one mesh; the second is part ``part`` and its faces are ``{part}_x0`` and so on."""
    shift = len(first.points)
    return TaggedMesh(
        points=np.vstack([first.points, second.points]),
        cells=np.vstack([first.cells, second.cells + shift]),
        cell_tags=np.repeat(np.array([1, 2], dtype=np.int32), [len(first.cells), len(second.cells)]),
        facets=np.vstack([first.facets, second.facets + shift]),
        facet_tags=np.concatenate([first.facet_tags, second.facet_tags + 6]).astype(np.int32),
        parts={"body": 1, part: 2},
        faces=dict(first.faces) | {f"{part}_{name}": tag + 6 for name, tag in second.faces.items()},
    )


def merged(mesh: TaggedMesh) -> TaggedMesh:
    """The mesh with nodes in the same place (to 1e-9 m) made one: bodies that touch become one body."""
    _, first, number = np.unique(np.round(mesh.points, 9), axis=0, return_index=True, return_inverse=True)
    number = number.ravel()
    return replace(mesh, points=mesh.points[first], cells=number[mesh.cells], facets=number[mesh.facets])
