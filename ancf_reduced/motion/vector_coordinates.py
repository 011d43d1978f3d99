"""Independent coordinates of a mesh of plates: held and tied node vectors are eliminated beforehand.

All ties are linear and the same for x, y and z (clamps, thesis eq. 2.20), so that p = B z + p_0 with one number of B
for each pair of vectors: z (n_vectors, 3) are the independent vectors r, r_X, r_Y, r_Z of free nodes and reference
nodes. The mass matrix B^T M B is constant (thesis eq. 2.26, M_p); see `mass_factor` for Cholesky coordinates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, coo_array, csr_array

from ancf_reduced.motion.reference_node import ReferenceNodeTie
from ancf_reduced.plates.mesh import PlateMesh
from contracts.errors import InputError

__all__ = ["VectorCoordinates", "all_free", "side_by_side", "with_held_vectors", "with_reference_node"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


_DENSE = 40_000
"""Entries up to which the map is multiplied as a full matrix."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VectorCoordinates:
    """Constant map p = B z + p_0.

    Attributes
    ----------
    map : (4 n_nodes, n_vectors) sparse [-, m]; row 4 n + c is node n, vector c of (r, r_X, r_Y, r_Z)
    held : (4 n_nodes, 3) float [m, -], p_0, zero where nothing is held
    triads : (n_triads, 4) int, rows of z that are r, r_x, r_y, r_z of a rigid reference node; -1 where that vector is
        held

    Verified by tests/unit/test_ancf_vector_coordinates.py.
    """

    map: csr_array
    held: FloatArray
    triads: IntArray = field(default_factory=lambda: np.zeros((0, 4), dtype=np.int64))
    _forward: FloatArray | csr_array = field(init=False, repr=False)
    _backward: FloatArray | csr_array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Keep the map as a full matrix where that is quicker to multiply with."""
        small = self.map.shape[0] * self.map.shape[1] <= _DENSE
        object.__setattr__(self, "_forward", self.map.toarray() if small else self.map)
        object.__setattr__(self, "_backward", np.ascontiguousarray(self.map.T.toarray()) if small else self.map.T)

    @property
    def n_vectors(self) -> int:
        """Number of independent vectors."""
        return int(self.map.shape[1])

    @property
    def position_rows(self) -> IntArray:
        """Rows of z that are positions, (n,) int, increasing: those that no gradient of a node depends on."""
        on_gradients = np.delete(np.arange(self.map.shape[0]), np.s_[::4])
        return np.setdiff1d(np.arange(self.n_vectors), self.map[on_gradients].indices)

    def expand(self, z: FloatArray) -> FloatArray:
        """Structure coordinates (n_nodes, 4, 3) from the independent vectors (n_vectors, 3)."""
        return np.asarray(self._forward @ z + self.held).reshape(-1, 4, 3)

    def expand_rates(self, v: FloatArray) -> FloatArray:
        """Rates (n_nodes, 4, 3) of the structure coordinates; what is held stands still."""
        return np.asarray(self._forward @ v).reshape(-1, 4, 3)

    def reduce(self, force: FloatArray) -> FloatArray:
        """Generalised force (n_vectors, 3) on the independent vectors from that on the mesh (n_nodes, 4, 3)."""
        return np.asarray(self._backward @ force.reshape(-1, 3))

    def restrict(self, p: FloatArray) -> FloatArray:
        """The independent vectors of structure coordinates (n_nodes, 4, 3) that keep the ties, by least squares."""
        dense = self.map.toarray()
        return np.asarray(np.linalg.lstsq(dense, p.reshape(-1, 3) - self.held, rcond=None)[0])


def all_free(mesh: PlateMesh) -> VectorCoordinates:
    """Every node vector is independent."""
    return with_held_vectors(mesh, np.zeros((len(mesh.points), 4), dtype=bool))


def with_held_vectors(mesh: PlateMesh, held: NDArray[np.bool_]) -> VectorCoordinates:
    """Some node vectors keep their reference value: a clamp holds all four of a node, a hinge its r only.

    Parameters
    ----------
    mesh : plates in their reference configuration
    held : (n_nodes, 4) bool, r, r_X, r_Y, r_Z of each node
    """
    if held.shape != (len(mesh.points), 4):
        rule = f"needs the shape ({len(mesh.points)}, 4)"
        raise InputError("held vectors", held.shape, rule, "give four flags for each node")
    free = np.flatnonzero(~held.ravel())
    B = csr_array((np.ones(len(free)), (free, np.arange(len(free)))), shape=(held.size, len(free)))
    p_0 = np.where(held.ravel()[:, None], mesh.reference_coordinates().reshape(-1, 3), 0.0)
    return VectorCoordinates(map=B, held=p_0)


def with_reference_node(tie: ReferenceNodeTie, held: Sequence[bool] = (False,) * 4) -> VectorCoordinates:
    """Free nodes' vectors, then those of the reference node that the others are tied to (thesis eq. 2.20).

    Parameters
    ----------
    tie : from `reference_node.tie_reference_node`
    held : whether r, r_x, r_y, r_z of the reference node keep their reference value: (False, False, True, False) lets a
        wheel turn about its axle only
    """
    n_nodes, n_free = len(tie.free) + len(tie.tied), len(tie.free)
    held_rows, kept = np.array(held, dtype=bool), 4 * n_free + np.cumsum(~np.array(held, dtype=bool)) - 1
    rows = [4 * tie.free[:, None] + np.arange(4)]
    triad = np.where(held_rows, -1, kept)
    n_vectors = 4 * n_free + int((~held_rows).sum())
    i, j = np.nonzero(np.ones((4, 4)))
    tied_rows = (4 * tie.tied[:, None] + i).ravel()
    tied_columns, values = np.tile(triad[j], len(tie.tied)), tie.map[:, i, j].ravel()
    independent = tied_columns >= 0
    B = coo_array(
        (
            np.concatenate([np.ones(4 * n_free), values[independent]]),
            (
                np.concatenate([rows[0].ravel(), tied_rows[independent]]),
                np.concatenate([np.arange(4 * n_free), tied_columns[independent]]),
            ),
        ),
        shape=(4 * n_nodes, n_vectors),
    ).tocsr()
    B.eliminate_zeros()
    reference = np.vstack([tie.origin, np.eye(3)]) * held_rows[:, None]
    p_0 = np.zeros((n_nodes, 4, 3))
    p_0[tie.tied] = tie.map @ reference
    return VectorCoordinates(map=B, held=p_0.reshape(-1, 3), triads=triad[None])


def side_by_side(parts: Sequence[VectorCoordinates]) -> VectorCoordinates:
    """Coordinates of several meshes joined by `plates.mesh.join_meshes`: six wheels as one mesh."""
    starts = np.cumsum([0, *(part.n_vectors for part in parts[:-1])])
    triads = [np.where(p.triads < 0, -1, p.triads + start) for p, start in zip(parts, starts, strict=True)]
    return VectorCoordinates(
        map=csr_array(block_diag([part.map for part in parts])),
        held=np.concatenate([part.held for part in parts]),
        triads=np.concatenate(triads),
    )
