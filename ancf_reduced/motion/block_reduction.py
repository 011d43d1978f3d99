"""Matrices of plates as blocks of one mesh's independent vectors, without the mesh's own matrix in between.

With p = B z + p_0 the matrix of a plate belongs to the vectors that its nodes depend on: K_z = sum B^T K_plate B. Each
pair of them has one 3 x 3 block. Many equal meshes side by side are reduced in one call. Verified by
tests/unit/test_ancf_wheel_set.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ancf_reduced.compiled import compiled
from ancf_reduced.motion.vector_coordinates import VectorCoordinates
from ancf_reduced.plates.assembly import plate_rows
from ancf_reduced.plates.mesh import PlateMesh

__all__ = ["BlockReduction", "block_reduction"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockReduction:
    """Sum of products, in the order of the plates.

    Attributes
    ----------
    n_plates : of one mesh
    pattern : (n_blocks, 2) int, row and column vector of each block
    terms : (n_terms, 4) int: plate, its row vector and column vector of 0..15, block
    factors : (n_terms,) float, product of the two entries of B
    """

    n_plates: int
    pattern: IntArray
    terms: IntArray
    factors: FloatArray

    def __call__(self, blocks: FloatArray) -> FloatArray:
        """Blocks (n_meshes, n_blocks, 3, 3) of the matrices (n_meshes n_plates, 48, 48) of all plates."""
        out = np.zeros((len(blocks) // self.n_plates, len(self.pattern), 3, 3))
        _reduce(blocks, self.n_plates, self.terms, self.factors, out)
        return out


def block_reduction(mesh: PlateMesh, coordinates: VectorCoordinates) -> BlockReduction:
    """Terms of one mesh.

    Parameters
    ----------
    mesh, coordinates : plates, and the independent vectors of their nodes
    """
    rows, B = plate_rows(mesh, components=1), coordinates.map
    terms, factors = [], []
    for plate, own in enumerate(rows):
        depends = [(s, k, x) for s, row in enumerate(own) for k, x in _entries(B, row)]
        for s, i, x in depends:
            for t, j, y in depends:
                terms.append((plate, s, t, i, j))
                factors.append(x * y)
    table = np.array(terms, dtype=np.int64)
    pattern, block = np.unique(table[:, 3:], axis=0, return_inverse=True)
    return BlockReduction(
        n_plates=len(mesh.elements),
        pattern=pattern,
        terms=np.ascontiguousarray(np.column_stack([table[:, :3], block.ravel()])),
        factors=np.array(factors),
    )


def _entries(B: csr_array, row: int) -> list[tuple[int, float]]:
    """Columns and values of one row of a matrix by compressed rows."""
    begin, end = B.indptr[row], B.indptr[row + 1]
    return list(zip(B.indices[begin:end].tolist(), B.data[begin:end].tolist(), strict=True))


@compiled
def _reduce(blocks: FloatArray, n_plates: int, terms: IntArray, factors: FloatArray, out: FloatArray) -> None:
    for mesh in range(len(out)):
        first = mesh * n_plates
        for n in range(len(terms)):
            plate, s, t, block, x = first + terms[n, 0], 3 * terms[n, 1], 3 * terms[n, 2], terms[n, 3], factors[n]
            for i in range(3):
                for j in range(3):
                    out[mesh, block, i, j] += x * blocks[plate, s + i, t + j]
