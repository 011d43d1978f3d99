"""Structured planar meshes for the tests: a block of 9-node quadrilaterals mapped to any shape, in gmsh's order."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh

_LATTICE = np.array([(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)])
_EDGE = np.array([0, 2, 1])


def planar_block(
    counts: tuple[int, int],
    mapping: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    width: float = 1.0,
) -> TaggedMesh:
    """Block of cells over the unit square, mapped by ``mapping``; faces ``x0 x1 z0 z1``, one part ``body``."""
    n = 2 * np.array(counts) + 1
    lattice = np.stack(np.meshgrid(*[np.arange(k) for k in n], indexing="ij"), axis=-1).reshape(-1, 2)

    def number(position: NDArray[np.int64]) -> NDArray[np.int64]:
        return position[..., 0] * n[1] + position[..., 1]

    corner = 2 * np.stack(np.meshgrid(*[np.arange(k) for k in counts], indexing="ij"), axis=-1).reshape(-1, 1, 2)
    facets, tags = [], []
    for axis in range(2):
        for side, level in enumerate((0, n[axis] - 1)):
            position = np.full((counts[1 - axis], 3, 2), level)
            position[..., 1 - axis] = 2 * np.arange(counts[1 - axis])[:, None] + _EDGE
            facets.append(number(position))
            tags.append(np.full(counts[1 - axis], 2 * axis + side + 1))
    return TaggedMesh(
        points=mapping(lattice / (n - 1.0)),
        cells=number(corner + _LATTICE),
        cell_tags=np.ones(counts[0] * counts[1], dtype=np.int32),
        facets=np.concatenate(facets),
        facet_tags=np.concatenate(tags).astype(np.int32),
        parts={"body": 1},
        faces={"x0": 1, "x1": 2, "z0": 3, "z1": 4},
        widths={"body": width},
    )
