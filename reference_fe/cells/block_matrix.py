"""The rows of a matrix of three unknowns a node: which nodes are coupled, and where each block's values lie.

Values are those of a CSR matrix of single unknowns, row by row, columns ascending; of a symmetric matrix its upper
triangle alone. The columns of a node lie side by side in all its rows, so that nodes are all that is stored of the
pattern. Verified by tests/unit/test_fe_block_matrix.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.errors import WorkbenchError
from reference_fe.compiled import compiled

__all__ = [
    "BlockRows",
    "Places",
    "add_block",
    "add_csr",
    "block_places",
    "block_rows",
    "hold",
    "place_of",
    "product",
    "scalar_csr",
]

Array = NDArray[np.float64]
Index = NDArray[np.int32]
Long = NDArray[np.int64]
Places = NDArray[np.int16]
"""Places of blocks within the rows of a node, as `block_places` finds them."""


class BlockRows(NamedTuple):
    """Pattern of a matrix.

    Attributes
    ----------
    starts : (n_nodes + 1,) where each node's coupled nodes begin
    nodes : coupled nodes of each node, ascending; itself and later ones alone if ``upper``
    upper : 1 for the upper triangle of a symmetric matrix, 0 for all of a matrix
    """

    starts: Long
    nodes: Index
    upper: int

    @property
    def entries(self) -> int:
        """Number of values."""
        return 9 * len(self.nodes) - 3 * self.upper * (len(self.starts) - 1)


def block_rows(n_nodes: int, groups: Sequence[Index], *, upper: bool) -> BlockRows:
    """Pattern that couples the nodes of each group with each other, and every node with itself.

    groups : (m, k) int each, m groups of k nodes, or one of (k,)

    Raises
    ------
    WorkbenchError
        Where a node is coupled with more than 32 767 others: `Places` cannot tell them.
    """
    tables = [np.atleast_2d(group) for group in groups]
    flat = np.concatenate([np.zeros(0, dtype=np.int32), *(table.ravel() for table in tables)]).astype(np.int32)
    sizes = [np.zeros(1, dtype=np.int64), *(np.full(len(table), table.shape[1]) for table in tables)]
    ends = np.cumsum(np.concatenate(sizes))
    members, owners = _groups_of_nodes(n_nodes, ends, flat)
    starts = np.zeros(n_nodes + 1, dtype=np.int64)
    _couple(upper, members, owners, ends, flat, starts, np.zeros(0, dtype=np.int32))
    if (most := int(starts.max())) > np.iinfo(np.int16).max:
        raise WorkbenchError(f"a node is coupled with {most} others, 32767 at most; report this with the study")
    starts = np.cumsum(starts)
    nodes = np.empty(starts[-1], dtype=np.int32)
    _couple(upper, members, owners, ends, flat, starts, nodes)
    return BlockRows(starts=starts, nodes=nodes, upper=int(upper))


@compiled()
def _groups_of_nodes(n_nodes: int, ends: Long, flat: Index) -> tuple[Long, Index]:
    """Groups that each node is in: their starts (n_nodes + 1,) and numbers; group g is flat[ends[g] : ends[g + 1]]."""
    starts = np.zeros(n_nodes + 1, dtype=np.int64)
    for node in flat:
        starts[node + 1] += 1
    starts = np.cumsum(starts)
    owners, free = np.empty(len(flat), dtype=np.int32), starts.copy()
    for g in range(len(ends) - 1):
        for node in flat[ends[g] : ends[g + 1]]:
            owners[free[node]] = g
            free[node] += 1
    return starts, owners


@compiled()
def _couple(upper: bool, members: Long, owners: Index, ends: Long, flat: Index, starts: Long, nodes: Index) -> None:
    """Count the coupled nodes of node a in starts[a + 1], or write them to their place if there are ``nodes``."""
    n_nodes = len(members) - 1
    seen, row = np.full(n_nodes, -1, dtype=np.int32), np.empty(n_nodes, dtype=np.int32)
    for a in range(n_nodes):
        seen[a], row[0], count = a, a, 1
        for g in owners[members[a] : members[a + 1]]:
            for b in flat[ends[g] : ends[g + 1]]:
                if seen[b] != a and (b > a or not upper):
                    seen[b], row[count] = a, b
                    count += 1
        if len(nodes) > 0:
            nodes[starts[a] : starts[a + 1]] = np.sort(row[:count])
        else:
            starts[a + 1] = count


@compiled()
def scalar_csr(rows: BlockRows, dtype: Index) -> tuple[Index, Index]:
    """Row starts (3 n_nodes + 1,) and columns (entries,) of the single unknowns, of the type of ``dtype``."""
    n_nodes = len(rows.starts) - 1
    indptr = np.zeros(3 * n_nodes + 1, dtype=dtype.dtype)
    columns = np.empty(9 * len(rows.nodes) - 3 * rows.upper * n_nodes, dtype=dtype.dtype)
    end = 0
    for a in range(n_nodes):
        for i in range(3):
            for b in rows.nodes[rows.starts[a] : rows.starts[a + 1]]:
                for k in range(3):
                    if rows.upper == 0 or 3 * b + k >= 3 * a + i:
                        columns[end] = 3 * b + k
                        end += 1
            indptr[3 * a + i + 1] = end
    return indptr, columns


@compiled()
def place_of(rows: BlockRows, a: int, b: int) -> int:
    """Place of node b among those coupled with node a, or -1 where its block is not stored."""
    first, last = rows.starts[a], rows.starts[a + 1]
    place = int(np.searchsorted(rows.nodes[first:last], b))
    found = first + place < last and rows.nodes[first + place] == b
    return place if found else -1


@compiled()
def block_places(nodes: Index, rows: BlockRows) -> Places:
    """`place_of` node b for node a of each cell, (n_cells, n_nodes, n_nodes); nodes (n_cells, n_nodes)."""
    places = np.empty((nodes.shape[0], nodes.shape[1], nodes.shape[1]), dtype=np.int16)
    for c in range(nodes.shape[0]):
        for a in range(nodes.shape[1]):
            for b in range(nodes.shape[1]):
                places[c, a, b] = place_of(rows, nodes[c, a], nodes[c, b])
    return places


@compiled()
def add_block(rows: BlockRows, a: int, place: int, block: Array, values: Array) -> None:
    """Add a block (3, 3) of node a and the node at a place in its rows to the values.

    Row i of a node in an upper triangle lacks i entries more than the first; the block on the diagonal is its first.
    """
    start, length = 9 * rows.starts[a] - 3 * rows.upper * a, 3 * (rows.starts[a + 1] - rows.starts[a])
    for i in range(3):
        row = start + i * length + 3 * place - rows.upper * (i * (i + 1) // 2)
        for k in range(i if rows.upper == 1 and place == 0 else 0, 3):
            values[row + k] += block[i, k]


@compiled()
def add_csr(rows: BlockRows, indptr: Index, indices: Index, data: Array, values: Array) -> None:
    """Add a CSR matrix of single unknowns to the values; its zeros may lie where there is no room."""
    for row in range(len(indptr) - 1):
        a, i = row // 3, row % 3
        start, length = 9 * rows.starts[a] - 3 * rows.upper * a, 3 * (rows.starts[a + 1] - rows.starts[a])
        for at in range(indptr[row], indptr[row + 1]):
            if data[at] != 0.0 and (rows.upper == 0 or indices[at] >= row):
                place = 3 * place_of(rows, a, indices[at] // 3) + indices[at] % 3
                values[start + i * length + place - rows.upper * (i * (i + 1) // 2)] += data[at]


@compiled()
def hold(rows: BlockRows, held: NDArray[np.bool_], own: int, values: Array) -> None:
    """Zero rows and columns of the unknowns ``held`` (n_dofs,); one on the diagonal of those before number ``own``."""
    at = 0
    for a in range(len(rows.starts) - 1):
        for i in range(3):
            row = 3 * a + i
            for b in rows.nodes[rows.starts[a] : rows.starts[a + 1]]:
                for k in range(3):
                    column = 3 * b + k
                    if rows.upper == 1 and column < row:
                        continue
                    if held[row] or held[column]:
                        values[at] = 1.0 if row == column and row < own else 0.0
                    at += 1


@compiled()
def product(rows: BlockRows, values: Array, x: Array) -> Array:
    """The matrix times x (n_dofs,)."""
    y, at = np.zeros(len(x)), 0
    for a in range(len(rows.starts) - 1):
        for i in range(3):
            row, total = 3 * a + i, 0.0
            for b in rows.nodes[rows.starts[a] : rows.starts[a + 1]]:
                for k in range(3):
                    column = 3 * b + k
                    if rows.upper == 1 and column < row:
                        continue
                    total += values[at] * x[column]
                    if rows.upper == 1 and column > row:
                        y[column] += values[at] * x[row]
                    at += 1
            y[row] += total
    return y
