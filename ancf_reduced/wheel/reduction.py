"""From matrices of plates and ties to that of a wheel's free coordinates, in one product.

With coordinates q = q_0 + T s every entry of a block adds to those of T^T K T that its row and column of T name. Where
they go, and with which factor, is found once. Verified by tests/unit/test_ancf_wheel_static.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

__all__ = ["Reduction"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class Reduction:
    """T^T K T of blocks.

    Parameters
    ----------
    basis : T (n, n_free)
    numbers : of each kind of block its coordinates (n_blocks, m)
    """

    def __init__(self, basis: csc_array, numbers: Sequence[Index]) -> None:
        T = csr_array(basis)
        self._size = T.shape[1]
        count = np.diff(T.indptr)
        rows = np.concatenate([np.repeat(n, n.shape[1], axis=1).ravel() for n in numbers])
        columns = np.concatenate([np.tile(n, (1, n.shape[1])).ravel() for n in numbers])
        often = count[rows] * count[columns]
        source = np.repeat(np.arange(len(rows)), often)
        place = np.arange(len(source)) - np.repeat(np.cumsum(often) - often, often)
        i = T.indptr[rows[source]] + place // count[columns[source]]
        j = T.indptr[columns[source]] + place % count[columns[source]]
        key = T.indices[j].astype(np.int64) * self._size + T.indices[i]
        found, target = np.unique(key, return_inverse=True)
        self._sum = csr_array(
            csr_array((T.data[i] * T.data[j], (target, source)), shape=(len(found), len(rows))), copy=False
        )
        self._indices = (found % self._size).astype(np.int32)
        ends = np.cumsum(np.bincount(found // self._size, minlength=self._size))
        self._starts = np.concatenate([[0], ends]).astype(np.int32)

    def __call__(self, entries: Array) -> csc_array:
        """The matrix (n_free, n_free) of all blocks' entries, kind after kind, row by row."""
        data = self._sum @ entries
        return csc_array((data, self._indices, self._starts), shape=(self._size, self._size))
