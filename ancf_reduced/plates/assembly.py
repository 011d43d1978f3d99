"""Matrices of a mesh of plates from those of its plates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from ancf_reduced.plates.mesh import PlateMesh

__all__ = ["dense_matrix", "plate_rows", "sparse_matrix"]

FloatArray = NDArray[np.float64]


def plate_rows(mesh: PlateMesh, components: int = 3) -> NDArray[np.int64]:
    """Rows of the mesh's matrix that a plate's rows belong to, (n_plates, 16 components) int.

    Row 4 components n + components c + i is node n, vector c of (r, r_X, r_Y, r_Z), component i; ``components`` is 3,
    or 1 for matrices that are the same for each direction, such as the mass.
    """
    width = 4 * components
    return np.asarray((width * mesh.elements[:, :, None] + np.arange(width)).reshape(len(mesh.elements), -1))


def dense_matrix(mesh: PlateMesh, blocks: FloatArray) -> FloatArray:
    """Sum of the plates' matrices (n_plates, 48, 48) or (n_plates, 16, 16), as a full array."""
    components = blocks.shape[-1] // 16
    rows = plate_rows(mesh, components)
    matrix = np.zeros((4 * components * len(mesh.points),) * 2)
    for row, block in zip(rows, blocks, strict=True):
        matrix[np.ix_(row, row)] += block
    return matrix


def sparse_matrix(mesh: PlateMesh, blocks: FloatArray) -> csc_array:
    """The same as `dense_matrix`, sparse, by compressed columns: (size, size), size 12 n_nodes or 4 n_nodes.

    Verified by tests/unit/test_ancf_plate_assembly.py.
    """
    components = blocks.shape[-1] // 16
    rows, size = plate_rows(mesh, components), 4 * components * len(mesh.points)
    i = np.repeat(rows, rows.shape[1], axis=1).ravel()
    j = np.tile(rows, (1, rows.shape[1])).ravel()
    return coo_array((blocks.ravel(), (i, j)), shape=(size, size)).tocsc()
