"""Principal values and axes of a symmetric 3 x 3 tensor, as accurate where they coincide as where they do not.

Jacobi's rotations (Golub & Van Loan, Matrix Computations, 8.5, from memory). Verified by
tests/unit/test_fe_point_laws.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled

__all__ = ["principal_axes"]

Array = NDArray[np.float64]
SWEEPS = 12
"""Rounds of rotations; four to six make the rest zero."""


@compiled(error_model="numpy")
def principal_axes(A: Array, values: Array, axes: Array) -> None:
    """Values (3,) and axes (3, 3), columns, of A (3, 3); A is overwritten. In no order; what is no number stays one."""
    for i in range(3):
        for j in range(3):
            axes[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        if not A[0, 1] ** 2 + A[1, 2] ** 2 + A[0, 2] ** 2 > 0.0:
            break
        for p in range(2):
            for q in range(p + 1, 3):
                if A[p, q] != 0.0:
                    _rotate(A, axes, p, q)
    for i in range(3):
        values[i] = A[i, i]


@compiled(error_model="numpy")
def _rotate(A: Array, axes: Array, p: int, q: int) -> None:
    """Make A[p, q] zero; the upper triangle of A counts."""
    half = 0.5 * (A[q, q] - A[p, p]) / A[p, q]
    t = (1.0 if half >= 0.0 else -1.0) / (abs(half) + np.sqrt(1.0 + half * half))
    c = 1.0 / np.sqrt(1.0 + t * t)
    s = t * c
    A[p, p] -= t * A[p, q]
    A[q, q] += t * A[p, q]
    A[p, q] = 0.0
    r = 3 - p - q
    to_p, to_q = A[min(p, r), max(p, r)], A[min(q, r), max(q, r)]
    A[min(p, r), max(p, r)] = c * to_p - s * to_q
    A[min(q, r), max(q, r)] = s * to_p + c * to_q
    for k in range(3):
        to_p, to_q = axes[k, p], axes[k, q]
        axes[k, p] = c * to_p - s * to_q
        axes[k, q] = s * to_p + c * to_q
