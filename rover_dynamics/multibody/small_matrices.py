"""Products and inverses of small matrices, compiled: a call of BLAS or LAPACK costs more than their arithmetic.

Verified by tests/unit/test_multibody_rotations.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled

__all__ = ["inverse", "product"]

FloatArray = NDArray[np.float64]


@compiled
def product(A: FloatArray, x: FloatArray) -> FloatArray:
    """A x, (m,), of A (m, n) and x (n,)."""
    out = np.zeros(A.shape[0])
    for i in range(A.shape[0]):
        for j in range(A.shape[1]):
            out[i] += A[i, j] * x[j]
    return out


@compiled
def inverse(A: FloatArray) -> FloatArray:
    """Inverse (n, n) by Gauss and Jordan's elimination with row exchanges; not finite if A is singular."""
    n = len(A)
    left, right = A.copy(), np.zeros((n, n))
    for k in range(n):
        right[k, k] = 1.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            best = i if abs(left[i, k]) > abs(left[best, k]) else best
        for j in range(n):
            left[k, j], left[best, j] = left[best, j], left[k, j]
            right[k, j], right[best, j] = right[best, j], right[k, j]
        scale = 1.0 / left[k, k]
        for j in range(n):
            left[k, j] *= scale
            right[k, j] *= scale
        for i in range(n):
            factor = left[i, k] if i != k else 0.0
            for j in range(n):
                left[i, j] -= factor * left[k, j]
                right[i, j] -= factor * right[k, j]
    return right
