"""Rigid reference nodes: a_i . a_j = delta_ij for the gradients of each, kept exactly by multipliers.

The multipliers of a triad form a symmetric matrix Lambda; its force on a_i is sum_j Lambda_ij a_j. Positions and rates
are brought onto the constraints as in RATTLE (Andersen 1983; Hairer, Lubich & Wanner 2006, VII.1.4), which keeps the
method symplectic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import compiled
from ancf_reduced.motion.mass_factor import MassFactor
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


@compiled
def _gather(z: FloatArray, rows: IntArray, held: float, a: FloatArray) -> None:
    """Gradients of a triad (3, 3) from z (n_vectors, 3); a held one is ``held`` times its reference value e_i."""
    for i in range(3):
        for k in range(3):
            a[i, k] = z[rows[i], k] if rows[i] >= 0 else (held if i == k else 0.0)


@compiled
def _place_all(
    z: FloatArray, start: FloatArray, triads: tuple[IntArray, IntArray, FloatArray, FloatArray], moved: FloatArray
) -> bool:
    """Displacements that bring z onto the constraints of every triad, written to ``moved``."""
    rows, active, W, spread = triads
    a, a_0, Lambda = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    moved[:] = 0.0
    for n in range(len(rows)):
        _gather(z, rows[n], 1.0, a)
        _gather(start, rows[n], 1.0, a_0)
        if not _place(a, a_0, W[n], active[n], Lambda):
            return False
        moved += spread[n] @ (Lambda @ a_0)
    return True


@compiled
def _stop_all(
    v: FloatArray, z: FloatArray, triads: tuple[IntArray, IntArray, FloatArray, FloatArray], changed: FloatArray
) -> None:
    """Changes of rates that make every triad turn rigidly, written to ``changed``."""
    rows, active, W, spread = triads
    a, rate, Lambda = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    changed[:] = 0.0
    for n in range(len(rows)):
        _gather(z, rows[n], 1.0, a)
        _gather(v, rows[n], 0.0, rate)
        _stop(rate, a, W[n], active[n], Lambda)
        changed += spread[n] @ (Lambda @ a)


class RigidTriads:
    """All rigid reference nodes of a system, with the mass they act through.

    Verified by tests/unit/test_ancf_rigid_hub.py.
    """

    def __init__(self, triads: IntArray, factor: MassFactor, n_vectors: int) -> None:
        rows = np.ascontiguousarray(triads[:, 1:])
        spread = np.zeros((len(rows), n_vectors, 3))
        for n, own in enumerate(rows):
            kept = np.flatnonzero(own >= 0)
            spread[n, own[kept], kept] = 1.0
            spread[n] = factor.solve(spread[n])
        W = np.array([np.where(own[:, None] >= 0, s[own], 0.0) for own, s in zip(rows, spread, strict=True)])
        active = np.array([[own[i] >= 0 or own[j] >= 0 for i, j in _PAIRS] for own in rows], dtype=np.int64)
        self._triads = rows, active.reshape(-1, 6), W.reshape(-1, 3, 3), spread

    def gradients(self, z: FloatArray) -> FloatArray:
        """Gradients a_i, rows, of each triad, (n_triads, 3, 3); a held one has its reference value."""
        rows = self._triads[0]
        return np.where(rows[..., None] >= 0, z[rows], np.eye(3))

    def place(self, z: FloatArray, start: FloatArray) -> FloatArray:
        """Displacement (n_vectors, 3) that brings z onto the constraints, by forces along the gradients at ``start``.

        Raises
        ------
        ConvergenceError
            If the step was too large.
        """
        moved = np.empty_like(z)
        if not _place_all(z, start, self._triads, moved):
            raise ConvergenceError("a hub's triad could not be kept rigid: the time step is too large", [], None)
        return moved

    def stop(self, v: FloatArray, z: FloatArray) -> FloatArray:
        """Change of rates (n_vectors, 3) after which the triads at z turn rigidly."""
        changed = np.empty_like(v)
        _stop_all(v, z, self._triads, changed)
        return changed
