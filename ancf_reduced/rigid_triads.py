"""Rigid reference nodes: a_i . a_j = delta_ij for the gradients of each, kept exactly by multipliers.

The multipliers of a triad form a symmetric matrix Lambda; its force on a_i is sum_j Lambda_ij a_j. Positions and rates
are brought onto the constraints as in RATTLE (Andersen 1983; Hairer, Lubich & Wanner 2006, VII.1.4), which keeps the
method symplectic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import compiled
from ancf_reduced.mass_factor import MassFactor
from contracts.errors import ConvergenceError

__all__ = ["RigidTriads", "triad_defect"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_PAIRS = np.array([[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]])
_TOLERANCE = 1e-13
_ITERATIONS = 20


def triad_defect(a: FloatArray) -> float:
    """Largest |a_i . a_j - delta_ij| of gradients (..., 3, 3), rows a_i [-]."""
    return float(np.abs(a @ np.swapaxes(a, -1, -2) - np.eye(3)).max(initial=0.0))


@compiled
def _place(a: FloatArray, start: FloatArray, W: FloatArray, active: IntArray, Lambda: FloatArray) -> bool:
    """Find Lambda with a + W Lambda start orthonormal (3, 3 each); a is overwritten. False if it does not converge."""
    free, J, r = a.copy(), np.empty((6, 6)), np.empty(6)
    Lambda[:] = 0.0
    for _ in range(_ITERATIONS):
        a[:] = free + W @ (Lambda @ start)
        for m in range(6):
            i, j = _PAIRS[m, 0], _PAIRS[m, 1]
            r[m] = active[m] * 0.5 * (np.dot(a[i], a[j]) - (1.0 if i == j else 0.0))
        if np.abs(r).max() < _TOLERANCE:
            return True
        _jacobian(a, start, W, active, J)
        correction = np.linalg.solve(J, -r)
        for m in range(6):
            i, j = _PAIRS[m, 0], _PAIRS[m, 1]
            Lambda[i, j] += correction[m]
            if i != j:
                Lambda[j, i] += correction[m]
    return False


@compiled
def _jacobian(a: FloatArray, start: FloatArray, W: FloatArray, active: IntArray, J: FloatArray) -> None:
    """Derivative of the constraints at a by the multipliers, whose forces act along ``start``."""
    unit = np.empty((3, 3))
    for n in range(6):
        unit[:] = 0.0
        unit[_PAIRS[n, 0], _PAIRS[n, 1]] = 1.0
        unit[_PAIRS[n, 1], _PAIRS[n, 0]] = 1.0
        moved = W @ (unit @ start)
        for m in range(6):
            i, j = _PAIRS[m, 0], _PAIRS[m, 1]
            J[m, n] = 0.5 * (np.dot(moved[i], a[j]) + np.dot(a[i], moved[j]))
            if active[m] == 0 or active[n] == 0:
                J[m, n] = 1.0 if m == n else 0.0


@compiled
def _stop(v: FloatArray, a: FloatArray, W: FloatArray, active: IntArray, Lambda: FloatArray) -> None:
    """Find Lambda with rates v + W Lambda a that keep a orthonormal, (3, 3) each."""
    J, r = np.empty((6, 6)), np.empty(6)
    _jacobian(a, a, W, active, J)
    for m in range(6):
        i, j = _PAIRS[m, 0], _PAIRS[m, 1]
        r[m] = -active[m] * 0.5 * (np.dot(v[i], a[j]) + np.dot(a[i], v[j]))
    r = np.linalg.solve(J, r)
    for m in range(6):
        i, j = _PAIRS[m, 0], _PAIRS[m, 1]
        Lambda[i, j] = r[m]
        Lambda[j, i] = r[m]


class RigidTriads:
    """All rigid reference nodes of a system, with the mass they act through.

    Verified by tests/unit/test_ancf_rigid_hub.py.
    """

    def __init__(self, triads: IntArray, factor: MassFactor, n_vectors: int) -> None:
        self._rows = [triad[1:] for triad in triads]
        self._active = [_active(rows) for rows in self._rows]
        self._spread = []
        for rows in self._rows:
            unit = np.zeros((n_vectors, 3))
            kept = np.flatnonzero(rows >= 0)
            unit[rows[kept], kept] = 1.0
            self._spread.append(factor.solve(unit))

    def gradients(self, z: FloatArray) -> list[FloatArray]:
        """Gradients a_i (3, 3), rows, of each triad; a held one has its reference value."""
        return [np.where(rows[:, None] >= 0, z[rows], np.eye(3)) for rows in self._rows]

    def rates(self, v: FloatArray) -> list[FloatArray]:
        """Their rates (3, 3)."""
        return [np.where(rows[:, None] >= 0, v[rows], 0.0) for rows in self._rows]

    def place(self, z: FloatArray, start: FloatArray) -> FloatArray:
        """Displacement (n_vectors, 3) that brings z onto the constraints, by forces along the gradients at ``start``.

        Raises
        ------
        ConvergenceError
            If the step was too large.
        """
        moved = np.zeros_like(z)
        at_start = self.gradients(start)
        for a, a_0, spread, active, rows in zip(
            self.gradients(z), at_start, self._spread, self._active, self._rows, strict=True
        ):
            Lambda = np.empty((3, 3))
            if not _place(a, a_0, _own(spread, rows), active, Lambda):
                raise ConvergenceError("a hub's triad could not be kept rigid: the time step is too large", [], None)
            moved += spread @ (Lambda @ a_0)
        return moved

    def stop(self, v: FloatArray, z: FloatArray) -> FloatArray:
        """Change of rates (n_vectors, 3) after which the triads at z turn rigidly."""
        changed = np.zeros_like(v)
        for rate, a, spread, active, rows in zip(
            self.rates(v), self.gradients(z), self._spread, self._active, self._rows, strict=True
        ):
            Lambda = np.empty((3, 3))
            _stop(rate, a, _own(spread, rows), active, Lambda)
            changed += spread @ (Lambda @ a)
        return changed


def _own(spread: FloatArray, rows: IntArray) -> FloatArray:
    """The triad's own (3, 3) part of M^-1; zero for held gradients."""
    return np.ascontiguousarray(np.where(rows[:, None] >= 0, spread[rows], 0.0))


def _active(rows: IntArray) -> IntArray:
    """Which of the six equations are not met by held gradients alone."""
    return np.array([rows[i] >= 0 or rows[j] >= 0 for i, j in _PAIRS], dtype=np.int64)
