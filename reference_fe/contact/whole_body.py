"""Surface terms that may join any two nodes of the body, on several processes, in the numbers of the whole.

Contact between parts finds its partners wherever they are. So each process gathers the whole displacement, the term is
evaluated in the global numbers of the nodes (it may share that work itself), and each keeps the rows of force and
stiffness that belong to it. Verified by tests/verification/test_fe_ranks.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.contact.surface_term import SurfaceForces
from reference_fe.solver import process_sums

__all__ = ["WholeBody", "global_nodes"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def global_nodes(V: api.Expr) -> Index:
    """Number over all processes of each node this process knows, (n_nodes,)."""
    nodes = V.dofmap.index_map
    here = np.arange(nodes.size_local + nodes.num_ghosts, dtype=np.int32)
    return np.asarray(nodes.local_to_global(here), dtype=np.int64)


class WholeBody:
    """Forces and stiffness of terms in global numbers; what is stored are this process' own rows.

    Parameters
    ----------
    V : displacement space

    Attributes
    ----------
    batches : forces and stiffness of the terms, as last given to `own_force`
    """

    def __init__(self, V: api.Expr) -> None:
        self._dim, self._numbers = int(V.dofmap.index_map_bs), global_nodes(V)
        self._first, self._last = V.dofmap.index_map.local_range
        self._size = int(V.dofmap.index_map.size_global)
        self._keys = np.zeros(0, dtype=np.int64)
        self._free = np.ones((self._size, self._dim))
        self.batches: tuple[SurfaceForces, ...] = ()

    def gathered(self, u: Array) -> Array:
        """Values at all nodes of the body, (size, ...) flat, from those this process knows."""
        known = u.reshape(len(self._numbers), -1)
        whole = np.full((self._size, known.shape[1]), -np.inf)
        whole[self._numbers] = known
        return process_sums.largest_of_all(whole).ravel()

    def own_force(self, batches: Sequence[SurfaceForces]) -> Array:
        """Force at this process' own unknowns [N]; keeps the stiffness of the batches' own rows for `own_stiffness`."""
        whole = np.zeros((self._size, self._dim))
        for batch in batches:
            there = batch.nodes >= 0
            np.add.at(whole, batch.nodes[there], batch.force[there])
        self.batches = tuple(batches)
        return whole[self._first : self._last].ravel()

    def own_product(self, batches: Sequence[SurfaceForces], x: Array) -> Array:
        """Stiffness of the batches times values at all nodes (size * dim,) [m], at this process' own unknowns [N]."""
        whole, values = np.zeros((self._size, self._dim)), x.reshape(self._size, self._dim)
        for batch in batches:
            there = batch.nodes >= 0
            near = np.where(there[..., None], values[batch.nodes], 0.0)
            np.add.at(whole, batch.nodes[there], np.einsum("maibj,mbj->mai", batch.stiffness, near)[there])
        return whole[self._first : self._last].ravel()

    def lay_out(self, couplings: Sequence[Index], supported: NDArray[np.int32]) -> tuple[Index, Index]:
        """Room for the full blocks of groups of nodes: row and column of each entry, (nnz,) each, over all processes.

        couplings : (m, k) int each, groups of nodes in numbers over all processes; -1 fills up short groups
        supported : (n,) int, held unknowns this process knows, in its own numbers
        """
        pairs = [self._pairs(groups)[0] for groups in couplings]
        self._keys = np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *pairs]))
        held = np.zeros(len(self._numbers) * self._dim)
        held[supported] = 1.0
        self._free = 1.0 - self.gathered(held).reshape(self._size, self._dim)
        block = np.arange(self._dim)
        row, column = np.divmod(self._keys, self._size)
        shape = (len(self._keys), self._dim, self._dim)
        rows = np.broadcast_to((self._dim * row[:, None] + block)[:, :, None], shape)
        columns = np.broadcast_to((self._dim * column[:, None] + block)[:, None, :], shape)
        return rows.ravel(), columns.ravel()

    def own_stiffness(self, *, supported: bool) -> Array:
        """Entries of the last batches in the order of `lay_out` [N/m]; zero at held unknowns if ``supported``."""
        values = np.zeros((len(self._keys), self._dim, self._dim))
        for batch in self.batches:
            keys, own = self._pairs(batch.nodes)
            blocks = batch.stiffness.transpose(0, 1, 3, 2, 4)[own]
            np.add.at(values, np.searchsorted(self._keys, keys), blocks)
        if supported:
            row, column = np.divmod(self._keys, self._size)
            values *= self._free[row][:, :, None] * self._free[column][:, None, :]
        return values.ravel()

    def _pairs(self, groups: Index) -> tuple[Index, NDArray[np.bool_]]:
        """Key of every pair of nodes in a group whose first node is ours, and which of (m, k, k) they are."""
        first, second = np.broadcast_arrays(groups[:, :, None], groups[:, None, :])
        own = (first >= self._first) & (first < self._last) & (second >= 0)
        return first[own] * self._size + second[own], own
