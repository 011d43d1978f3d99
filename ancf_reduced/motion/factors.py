"""Factors of a full or sparse matrix as a map, and one error for a matrix that has none.

Verified by tests/unit/test_ancf_factors.py.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse.linalg import splu

__all__ = ["factorised"]

FloatArray = NDArray[np.float64]


def factorised(matrix: Any) -> Callable[[FloatArray], FloatArray]:
    """The inverse of a full or sparse (CSC) matrix (n, n) as a map of vectors (n,) or of columns (n, m).

    Raises
    ------
    numpy.linalg.LinAlgError
        If the matrix is singular or holds NaN, at the latest from the map, which refuses a solution that is no finite
        number. A matrix with infinite entries may have a finite one.
    """
    solve = _dense(matrix) if isinstance(matrix, np.ndarray) else _sparse(matrix)

    def checked(right: FloatArray) -> FloatArray:
        solution = np.asarray(solve(right))
        if not np.isfinite(solution).all():
            raise np.linalg.LinAlgError("a solution is no finite number: the matrix is all but singular")
        return solution

    return checked


def _dense(matrix: FloatArray) -> Callable[[FloatArray], FloatArray]:
    with warnings.catch_warnings():
        warnings.simplefilter("error", LinAlgWarning)
        try:
            factors = lu_factor(matrix, check_finite=False)
        except LinAlgWarning as error:
            raise np.linalg.LinAlgError("the matrix is singular") from error
    return lambda right: np.asarray(lu_solve(factors, right, check_finite=False))


def _sparse(matrix: Any) -> Callable[[FloatArray], FloatArray]:
    try:
        solve: Callable[[FloatArray], FloatArray] = splu(matrix).solve
    except RuntimeError as error:
        raise np.linalg.LinAlgError("the matrix is singular") from error
    return solve
