"""How many hexahedra and nodes of second order a mesh file will make, counted before any of them is made.

Verified by tests/unit/test_own_mesh_completion.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geometry.counting import MeshCount
from geometry.own_mesh.completion import TETRAHEDRON_EDGES, corners_of_faces

__all__ = ["count_cells"]

Index = NDArray[np.int64]

_HEXAHEDRON_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))


def count_cells(cells: Index, factor: int = 1) -> MeshCount:
    """Hexahedra of `completion.completed` and `completion.refined`, and the nodes of a quadratic displacement on them.

    cells : (m, 4, 8, 10, 20 or 27) int

    The corners, edges, faces and cells of the file are counted, whatever its order; of each hexahedral edge, face and
    cell divided into f the nodes inside are 2 f - 1 to the power of its dimension.
    """
    tetrahedra = cells.shape[1] in (4, 10)
    corners = cells[:, : 4 if tetrahedra else 8]
    edges = _different(corners, TETRAHEDRON_EDGES if tetrahedra else _HEXAHEDRON_EDGES)
    faces = _different(corners, corners_of_faces(cells.shape[1]))
    points, solids = len(np.unique(corners)), len(cells)
    if tetrahedra:  # an edge is two, a face three quadrangles about a point, a cell four hexahedra about one
        points, edges, faces, solids = (
            points + edges + faces + solids,
            2 * edges + 3 * faces + 4 * solids,
            3 * faces + 6 * solids,
            4 * solids,
        )
    inside = 2 * factor - 1
    nodes = points + inside * edges + inside**2 * faces + inside**3 * solids
    return MeshCount(cells=solids * factor**3, nodes=nodes)


def _different(cells: Index, local: tuple[tuple[int, ...], ...]) -> int:
    """Number of different edges or faces."""
    rows = np.sort(cells[:, np.array(local)].reshape(-1, len(local[0])), axis=1)
    return len(np.unique(rows, axis=0))
