"""Rates at the end of an explicit step whose rate-dependent forces are taken at those very rates.

Damping of the plates, damping and friction of the contact, and drives make up Q(z, v); F(z) are the other forces. With
the rates v_h of half a step before and the multipliers mu of rigid triads, the trapezoidal rule for Q asks for
    (2/h) M (v - v_h) + Q(z, v) = F(z) + G^T mu,    G v = 0.
C = dQ/dv is nearly constant in the axes of the hub, and G is constant there. So the equations are solved in these axes
by corrections with an earlier inverse of (2/h) M + C, each for the residual of the true forces: Newton's simplified
method. The first correction is of first order in the step, each further one smaller by another order, whatever C the
inverse is for; one that does not fall quickly has the inverse made anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, csr_array
from scipy.sparse.csgraph import connected_components

from ancf_reduced.motion.factors import factorised
from ancf_reduced.motion.linearisation import Linearisation, Matrix, constrained
from ancf_reduced.motion.plate_system import PlateSystem
from ancf_reduced.motion.rigid_triads import RigidTriads
from ancf_reduced.motion.triad_equations import TriadEquations
from contracts.errors import ConvergenceError

__all__ = ["ImplicitDamping"]

FloatArray = NDArray[np.float64]

_CORRECTIONS = 8
"""So many at the most; two or three are usual."""
_ENOUGH, _SLOW = 0.03, 0.2
"""Ratio of a correction to the one before, by the root of residual times change: below the first it is the last, above
the second the inverse is made anew."""
_ROUND_OFF = 1e-9
"""Residual relative to the forces below which that ratio means nothing."""
_TOO_STIFF = "friction near standstill is too stiff for this step: shorten it, or raise the slip velocity"
_SAME_STEP = 0.02
"""Relative change of the step up to which an inverse serves."""


class ImplicitDamping:
    """The equations of one system, and the inverse that corrects with.

    A mesh has one hub or none; several meshes may stand side by side.

    Attributes
    ----------
    inverses : how many have been made

    Verified by tests/unit/test_ancf_implicit_damping.py.
    """

    def __init__(self, system: PlateSystem, triads: RigidTriads) -> None:
        self._system, self._triads, self._matrices = system, triads, Linearisation(system)
        self._mass = system.mass.toarray() if self._matrices.is_small else system.mass
        self._triad_of, self._one_wheel = _triad_of(system)
        self._G = TriadEquations(system.coordinates).jacobian(_upright(system))
        self._step, self.inverses = 0.0, 0
        self._apply_inverse: Callable[[FloatArray], FloatArray] = np.zeros_like

    def rates(self, half: FloatArray, z: FloatArray, time: float, h: float) -> FloatArray:
        """Rates v (n_vectors, 3) that obey the equations.

        Parameters
        ----------
        half : (n_vectors, 3) float [m/s, 1/s], v_h
        z : (n_vectors, 3) float [m, -], with orthonormal triads
        time, h : instant and time step [s]

        Raises
        ------
        ConvergenceError
            If the corrections do not become small: friction that changes within a step from one direction to the other.
        """
        system, p, A = self._system, self._system.coordinates.expand(z), self._axes(z)
        if abs(h - self._step) > _SAME_STEP * h:
            self._invert(z, half, time, A, h)
        force, v = system.position_force(p, time), half + self._triads.stop(half, z)
        last, first = math.nan, math.inf
        for n in range(_CORRECTIONS):
            residual = force + system.rate_force(p, v, time) - self._mass @ ((2.0 / h) * (v - half))
            change = self._correction(residual, A)
            if np.vdot(change, residual) > _SLOW**2 * last and self._counts(residual, force):
                self._invert(z, v, time, A, h)
                change = self._correction(residual, A)
            v, power = v + change, float(np.vdot(change, residual))
            if power <= _ENOUGH**2 * last:
                return v
            last, first = power, power if n == 0 else first
        if last > _SLOW**2 * first and self._counts(residual, force):
            raise ConvergenceError(_TOO_STIFF, [], None)
        return v

    def _axes(self, z: FloatArray) -> FloatArray:
        """Axes of the hub as rows, (3, 3) for one wheel, else (n_vectors, 3, 3); the world's where there is no hub."""
        a = self._triads.gradients(z)
        return np.asarray(a[0] if self._one_wheel else np.concatenate([a, np.eye(3)[None]])[self._triad_of])

    def _correction(self, residual: FloatArray, A: FloatArray) -> FloatArray:
        """Change of the rates that removes a residual, (n_vectors, 3) both, in world axes."""
        in_hub = self._apply_inverse(_turned(A, residual).ravel())
        return _turned(np.swapaxes(A, -1, -2), in_hub.reshape(residual.shape))

    def _counts(self, residual: FloatArray, force: FloatArray) -> bool:
        """Whether a residual is more than round-off."""
        scale = np.abs(force).max() + np.abs(self._system.dead_load).max()
        return bool(np.abs(residual).max() > _ROUND_OFF * scale)

    def _invert(self, z: FloatArray, v: FloatArray, time: float, A: FloatArray, h: float) -> None:
        """Make the inverse for C at z and v, in the hub's axes."""
        n = len(z)
        turn = bsr_array((np.array(np.broadcast_to(A, (n, 3, 3))), np.arange(n), np.arange(n + 1)))
        C = turn @ self._matrices.damping(z, v, time) @ turn.T
        whole = constrained((2.0 / h) * self._matrices.mass + C, self._G)
        self._apply_inverse = _inverse(whole, 3 * n, blocks=not self._one_wheel)
        self._step, self.inverses = h, self.inverses + 1


def _triad_of(system: PlateSystem) -> tuple[NDArray[np.int64], bool]:
    """Number of the triad on the mesh of each vector, (n_vectors,), -1 for none; whether all belong to the same."""
    meshes, mesh_of = connected_components(system.mass, directed=False)
    own = np.full(meshes, -1)
    for n, triad in enumerate(system.coordinates.triads):
        own[mesh_of[triad[triad >= 0]]] = n
    return own[mesh_of], meshes == 1 and own[0] == 0


def _upright(system: PlateSystem) -> FloatArray:
    """Independent vectors (n_vectors, 3) that are zero but for the triads' gradients, which are e_i."""
    z = np.zeros((system.coordinates.n_vectors, 3))
    for triad in system.coordinates.triads:
        kept = np.flatnonzero(triad[1:] >= 0)
        z[triad[1 + kept]] = np.eye(3)[kept]
    return z


def _turned(A: FloatArray, x: FloatArray) -> FloatArray:
    """A x for each vector (n_vectors, 3), with one A (3, 3) or one each (n_vectors, 3, 3)."""
    return x @ A.T if A.ndim == 2 else np.asarray(np.matmul(A, x[..., None])[..., 0])


def _inverse(whole: Matrix, n: int, *, blocks: bool) -> Callable[[FloatArray], FloatArray]:
    """The first n rows and columns of a matrix' inverse as a map; ``blocks``: it consists of blocks among zeros."""
    try:
        return _map(whole, n, blocks=blocks)
    except np.linalg.LinAlgError as error:
        raise ConvergenceError("damping, step and mass make a singular matrix", []) from error


def _map(whole: Matrix, n: int, *, blocks: bool) -> Callable[[FloatArray], FloatArray]:
    if isinstance(whole, np.ndarray):
        inverse = np.linalg.inv(whole)[:n, :n]
        P = csr_array(inverse) if blocks else np.ascontiguousarray(inverse)
        return lambda r: np.asarray(P @ r)
    solve, rest = factorised(whole), np.zeros(whole.shape[0] - n)
    return lambda r: solve(np.concatenate([r, rest]))[:n]
