"""The lowest eigenvalues of K phi = lambda M phi, none left out: Lanczos about a shift with MUMPS, counted by inertia.

A symmetric factorisation of K - s M has as many negative pivots as there are eigenvalues below s (Sylvester's law of
inertia): so many must have been found (the check is that of Grimes, Lewis & Simon, SIAM J. Matrix Anal. Appl. 15,
1994, from memory). Verified by tests/unit/test_fe_vibration_eigen.py and tests/verification/test_fe_vibration.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from contracts.errors import ConvergenceError
from reference_fe import dolfinx_api as api
from reference_fe.solver.direct import DirectSolver, direct_solver

__all__ = ["count_below", "lowest_modes"]

Array = NDArray[np.float64]
_SPARE = 6
"""Eigenvalues found beyond those wanted, among which a gap is looked for."""
_TRIES = 4
_GAP = 1e-4
"""Least gap in which eigenvalues are counted, over their size or the shift's: one that is hit has no sign."""


def lowest_modes(K: csr_array, M: csr_array, count: int, shift: float) -> tuple[Array, Array]:
    """Eigenvalues (count,) [1/s^2], ascending, and vectors (n, count) with unit modal mass.

    Parameters
    ----------
    K, M : symmetric (n, n), M positive definite [N/m, kg]
    count : wanted, fewer than n
    shift : below zero, by about the least positive eigenvalue or less [1/s^2]; K may be singular then

    Raises
    ------
    ConvergenceError
        If not all of them are found.
    """
    size, wanted = K.shape[0], count + _SPARE
    solver = _Shifted(K, M, shift)
    try:
        for _ in range(_TRIES):
            wanted = min(wanted, size - 1)
            start = np.random.default_rng(wanted).normal(size=size)
            operator = LinearOperator((size, size), matvec=solver, dtype=np.float64)
            try:
                values, vectors = eigsh(K, k=wanted, M=M, sigma=shift, OPinv=operator, v0=start)
            except ArpackNoConvergence as error:
                raise ConvergenceError(f"natural modes are not found: {error}; ask for fewer", []) from error
            order = np.argsort(values)
            values, vectors = values[order], vectors[:, order]
            level, found = _level(values, count, abs(shift))
            if count_below(K, M, level) == found:
                return values[:count], vectors[:, :count]
            wanted *= 2
    finally:
        solver.release()
    raise ConvergenceError(f"natural modes are not found: the lowest {count} are not complete; ask for others", [])


def count_below(K: csr_array, M: csr_array, level: float) -> int:
    """Number of eigenvalues below a level [1/s^2]."""
    solver = _Shifted(K, M, level)
    try:
        return solver.below
    finally:
        solver.release()


def _level(values: Array, count: int, least: float) -> tuple[float, int]:
    """A level above the wanted eigenvalues in the first gap there is, and how many of those found lie below it.

    least : size below which differences of eigenvalues are round-off
    """
    if len(values) <= count:
        return float(values[-1] + max(abs(values[-1]), 1.0)), len(values)
    ahead = np.diff(values[count - 1 :]) / np.maximum(np.abs(values[count:]), least)
    first = int(np.flatnonzero(ahead > _GAP)[0]) if (ahead > _GAP).any() else int(ahead.argmax())
    found = count + first
    return float(0.5 * (values[found - 1] + values[found])), found


class _Shifted:
    """Solutions with K - s M."""

    def __init__(self, K: csr_array, M: csr_array, shift: float) -> None:
        matrix = csr_array(K - shift * M)
        matrix.sort_indices()
        arrays: Any = (matrix.indptr.astype(api.PETSc.IntType), matrix.indices.astype(api.PETSc.IntType), matrix.data)
        self._matrix = api.PETSc.Mat().createAIJ(matrix.shape, csr=arrays, comm=api.PETSc.COMM_SELF)
        symmetric: Any = api.PETSc.Mat.Option.SYMMETRIC  # the stubs give the options the wrong type
        self._matrix.setOption(symmetric, True)
        self._solver: DirectSolver = direct_solver(self._matrix, symmetric=True)
        self._solver.factorise()
        self._x, self._b = self._matrix.createVecRight(), self._matrix.createVecLeft()

    @property
    def below(self) -> int:
        """Number of eigenvalues below the shift."""
        found = self._solver.negative_pivots
        assert found is not None
        return found

    def __call__(self, right: Array) -> Array:
        self._b.array[:] = right.ravel()
        self._solver.solve(self._b, self._x)
        return np.array(self._x.array, dtype=np.float64)

    def release(self) -> None:
        self._solver.release()
        for item in (self._x, self._b, self._matrix):
            item.destroy()
