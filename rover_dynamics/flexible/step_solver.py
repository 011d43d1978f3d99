"""One step of the generalised-alpha method for a vehicle on flexible tires, by Newton's method.

The tires are condensed onto their hubs, see `linear_solves`, so that the linear system has the size of the joints. A
matrix serves as long as the iterations it still needs cost less than another. Contact forces have kinks, and friction
is nearly one where a point sticks: from either side Newton's method goes beyond the other without end. There only a
share of each change is made, halved whenever a change turns back on the one before. Verified by
tests/verification/test_flexible_motion.py and tests/unit/test_flexible_steps.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant, Residual, joined
from rover_dynamics.flexible.linear_solves import CondensedTires, condense
from rover_dynamics.multibody.generalised_alpha import Method
from rover_dynamics.vehicle.implicit_method import Known

__all__ = ["StepEnd", "StepSolver"]

FloatArray = NDArray[np.float64]

_WORTH = 5.0
"""Iterations still expected above which the matrix is made anew; it takes the time of as many."""
_STALLED, _WORSE = 0.7, 2.0
"""With a new matrix: ratio of one change to the one before above which only a share is made, and above which the step
has failed."""
_TURNED, _ONWARDS, _PATIENCE = 0.5, 1.5, 2
"""Change of the share where a change turns back and where it does not; factor of the iterations allowed there."""
_SAME = 0.01
"""Relative difference of two steps' lengths that may share a matrix."""
_OLD = 0.1
"""Share of the tolerance that a first change must meet if the matrix is that of an earlier step."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StepEnd:
    """State at a step's end, with the method's accelerations of joints and free vectors."""

    instant: Instant
    A: FloatArray
    Z: FloatArray

    def rescaled(self, ratio: float) -> StepEnd:
        """The same for a next step ``ratio`` [-] times as long as the last one, see `multibody.generalised_alpha`."""
        a, z = self.instant.a, self.instant.z_acceleration
        return StepEnd(instant=self.instant, A=a + ratio * (self.A - a), Z=z + ratio * (self.Z - z))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Matrix:
    """One linearisation, and the step and method it was made for."""

    tires: CondensedTires
    dt: float
    method: Method

    def serves(self, dt: float, method: Method) -> bool:
        return self.method is method and abs(self.dt - dt) <= _SAME * dt


class StepSolver:
    """Steps of one motion.

    Attributes
    ----------
    iterations, linearisations : counts
    """

    def __init__(self, system: FlexibleSystem) -> None:
        self._system = system
        self._matrix: _Matrix | None = None
        self.iterations = self.linearisations = 0

    def forget(self) -> None:
        """Make the next step's matrix anew, as a run that begins here does."""
        self._matrix = None

    def step(self, before: StepEnd, known: Known, dt: float, method: Method) -> tuple[StepEnd | None, float]:
        """The end of a step and its estimated error [m, rad]; None and infinity if Newton's method fails.

        Parameters
        ----------
        before : where it starts, rescaled to its length
        known : what is prescribed at its end
        dt : [s]
        """
        try:
            return self._newton(before, known, dt, method)
        except np.linalg.LinAlgError:  # a singular matrix: so far from balance that the step must be shorter
            self._matrix = None
            return None, np.inf

    def _newton(self, before: StepEnd, known: Known, dt: float, method: Method) -> tuple[StepEnd | None, float]:
        """As `step`; raises LinAlgError for a singular matrix."""
        system, earlier = self._system, (before.A, before.Z)
        A, Z = before.instant.a.copy(), before.instant.z_acceleration.copy()
        last, fresh, share, former, most, iteration = np.inf, False, 1.0, np.zeros_like(Z), method.iterations, 0
        while iteration < most:
            after = system.advanced(before.instant, earlier, (A, Z), known, (dt, method))
            if not np.isfinite(after.z).all():
                break
            residual = system.residual(after, known)
            if self._matrix is None or not self._matrix.serves(dt, method):
                fresh = self._linearise(after, dt, method)
            largest, change = self._correct(after, residual, (A, Z), share)
            size = dt * dt * largest
            if size < method.tolerance * (1.0 if iteration or fresh else _OLD):
                after = system.advanced(before.instant, earlier, (A, Z), known, (dt, method))
                error = method.error * dt * dt * self._largest(A - before.A, Z - before.Z)
                return StepEnd(instant=after, A=A, Z=Z), error
            if not np.isfinite(size) or (fresh and iteration > 2 and size > _WORSE * last):
                break
            if fresh and size > _STALLED * last:
                turned, most = np.vdot(change, former) < 0.0, _PATIENCE * method.iterations
                share = _TURNED * share if turned else min(1.0, _ONWARDS * share)
            if not fresh and _left(size, last, method.tolerance) > _WORTH:
                fresh = self._linearise(after, dt, method)
                size = np.inf
            last, former, iteration = size, change, iteration + 1
        return None, np.inf

    def _largest(self, A: FloatArray, Z: FloatArray) -> float:
        """Largest entry of joints and of nodes' places, of accelerations [m/s^2, rad/s^2]."""
        return float(max(np.abs(A[self._system.free]).max(), np.abs(Z[:, self._system.free_positions]).max()))

    def _linearise(self, after: Instant, dt: float, method: Method) -> bool:
        """Make the matrix anew; true."""
        system, tires = self._system, self._system.tires
        c, w_v, w_q = method.weights(dt)
        blocks = tires.step_matrix(*system.whole(after), (w_q, w_v))
        condensed = condense(tires, blocks, system.axes(after), c)
        self._matrix = _Matrix(tires=condensed, dt=dt, method=method)
        self.linearisations += 1
        return True

    def _correct(
        self, after: Instant, residual: Residual, of: tuple[FloatArray, FloatArray], share: float
    ) -> tuple[float, FloatArray]:
        """A share of Newton's change of A and Z, made in place; largest entry of the whole change, and that of Z."""
        A, Z = of
        assert self._matrix is not None
        tires, system, R, J = self._matrix.tires, self._system, self._system.axes(after), after.J
        c, w_v, w_q = self._matrix.method.weights(self._matrix.dt)
        to_hub = np.swapaxes(R, -1, -2)
        twists = np.concatenate([to_hub @ J[:, :3], to_hub @ J[:, 3:]], axis=1)
        in_hub = (residual.tires @ R).reshape(len(R), -1)
        pushed = np.matmul(tires.carry, in_hub[..., None])
        matrix = c * residual.mass + joined(twists, tires.stiffness @ twists)
        matrix -= w_q * joined(J[:, 3:], _turning(after.hub.z, residual.hubs) @ J[:, 3:])
        motors = system.actions.motors.places
        matrix[motors, motors] += w_v * residual.slopes
        right = residual.joints - joined(twists, pushed)[:, 0]
        change, free = np.zeros_like(A), system.free
        change[free] = np.linalg.solve(matrix[np.ix_(free, free)], right[free])
        held = tires.solve(in_hub) - np.matmul(tires.follow, (twists @ change)[..., None])[..., 0]
        of_tires = held.reshape(Z.shape) @ to_hub
        A += share * change
        Z += share * of_tires
        self.iterations += 1
        return self._largest(change, of_tires), of_tires


def _left(size: float, last: float, goal: float) -> float:
    """Iterations until changes fall from ``size`` to the goal if they go on as from the last; 0 after the first."""
    if size >= last:
        return math.inf
    return math.log(goal / size) / math.log(size / last) if math.isfinite(last) else 0.0


def _turning(z: FloatArray, forces: FloatArray) -> FloatArray:
    """Change of the moments sum a_i x F_i with the hub's rotation at fixed forces, (n_w, 3, 3)."""
    G = np.swapaxes(z[:, 1:], -1, -2) @ forces[:, 1:]
    return np.asarray(G - np.trace(G, axis1=1, axis2=2)[:, None, None] * np.eye(3))
