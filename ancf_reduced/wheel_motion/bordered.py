"""Solves with a wheel's matrix: the plates' part sparse, the hub's three rows and columns full.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

__all__ = ["HUB", "Bordered", "BorderedMatrix"]

Array = NDArray[np.float64]
HUB = 3
"""The hub's coordinates x, z, theta, behind those of the plates."""
BorderedMatrix = tuple[csc_array, Array]
"""The plates' part (n_free, n_free) and the hub's columns (n_free + 3, 3); its rows are their transpose, or given."""


class Bordered:
    """Solutions with a `BorderedMatrix`.

    Raises
    ------
    RuntimeError, numpy.linalg.LinAlgError
        If it is singular.
    """

    def __init__(self, matrix: BorderedMatrix, rows: Array | None = None) -> None:
        inner, border = matrix
        own, corner = border[:-HUB], border[-HUB:]
        self._rows = own.T if rows is None else rows
        self._factors = splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        self._over = self._factors.solve(own)
        self._corner = np.linalg.inv(corner - self._rows @ self._over)

    def __call__(self, right: Array) -> Array:
        """Of vectors (n,) or columns (n, j)."""
        own = self._factors.solve(np.ascontiguousarray(right[:-HUB]))
        hub = self._corner @ (right[-HUB:] - self._rows @ own)
        return np.concatenate([own - self._over @ hub, hub])
