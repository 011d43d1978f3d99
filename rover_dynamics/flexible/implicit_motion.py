"""Motion of a vehicle on flexible tires by the generalised-alpha method: the fast way.

The method is that of `rover_dynamics.vehicle.implicit_kernels`, with the tires' free vectors z beside the joints'
coordinates; they are a linear space, so that z and z' follow from the method's accelerations alone. Reference nodes are
eliminated onto the wheels' bodies. Unknown are the accelerations:

    joints  M a + h(q, v) - sum J^T D^T (Q_r - M_rf z'' - M_rr z_r'') = tau,      tires  M_ff z'' + M_fr z_r'' = Q_f

Verified by tests/verification/test_flexible_motion.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle
from rover_dynamics.flexible.linear_solves import CondensedTires, condense
from rover_dynamics.multibody.generalised_alpha import Method, generalised_alpha, implicit_euler

__all__ = ["drive_on_flexible_tires"]

FloatArray = NDArray[np.float64]
ITERATIONS = 12
"""Newton iterations of a step before it is tried shorter."""
NEWTON_SHARE = 0.01
"""Change at which they end, over the error allowed in the step."""
_SLOW = 0.3
"""Ratio of one change to the one before, above which the matrix is made anew."""
_SAME = 0.01
"""Relative difference of two steps' lengths that may share a matrix."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Now:
    """State at a step's end, with the method's accelerations A, Z of joints and tires at ``shift`` behind."""

    instant: Instant
    A: FloatArray
    Z: FloatArray


def drive_on_flexible_tires(
    vehicle: FlexibleVehicle,
    times: FloatArray,
    steps: EvenSteps | None = None,
    *,
    settles_until: float = -np.inf,
    watch: Callable[[float, Instant], None] | None = None,
) -> FlexibleMotion:
    """Integrate from the model's start at ``times[0]``, tires undeformed.

    Parameters
    ----------
    vehicle : its bodies start as its model says
    times : (n,) ascending [s]; each is the end of a step
    steps : how they are chosen
    settles_until : up to this time [s] steps are those of the implicit Euler method, as long as Newton's method bears
        them: the vehicle comes to rest without bouncing
    watch : called with time and state at each step's end

    Raises
    ------
    ConvergenceError
        If the step falls below the shortest one; with the motion up to there.
    InputError
        See `rover_dynamics.vehicle.vehicle.drive_vehicle`.
    """
    return _Run(vehicle, times, steps or EvenSteps(), settles_until, watch).to_its_end()


class _Run:
    """One motion under way."""

    def __init__(
        self,
        vehicle: FlexibleVehicle,
        times: FloatArray,
        steps: EvenSteps,
        settles_until: float,
        watch: Callable[[float, Instant], None] | None,
    ) -> None:
        self.times, self.steps, self.watch = np.asarray(times, dtype=np.float64), steps, watch
        self.system, self.settles_until = FlexibleSystem(vehicle), settles_until
        self.settling: Method = implicit_euler(NEWTON_SHARE * steps.tolerance, ITERATIONS)
        self.moving: Method = generalised_alpha(steps.spectral_radius, NEWTON_SHARE * steps.tolerance, ITERATIONS)
        self.method = self.moving
        self.condensed: tuple[Method, float, CondensedTires] | None = None
        self.accepted = self.iterations = self.rejected = self.linearisations = 0

    def to_its_end(self) -> FlexibleMotion:
        """Step from one time asked for to the next."""
        system, t, length, last = self.system, float(self.times[0]), self.steps.first, 0.0
        instant = system.at_rest(t)
        now = _Now(instant=instant, A=instant.a, Z=instant.z_acceleration)
        rows = [system.row(now.instant, t)]
        for target in self.times[1:].tolist():
            while t < target:
                self.method = self.settling if t < self.settles_until else self.moving
                dt = self.steps.towards(target - t, length)
                found, error = self._step(now, t + dt, dt, dt / last if last > 0.0 else 1.0)
                length = self.steps.after(length, dt, error)
                if found is None or error > self.steps.tolerance:
                    self.rejected += 1
                    if length < self.steps.shortest:
                        raise self._stopped(t, rows)
                    continue
                self.accepted += 1
                now, last, t = found, dt, (target if dt == target - t else t + dt)
                if self.watch is not None:
                    self.watch(t, now.instant)
            rows.append(system.row(now.instant, t))
        return self._motion(rows)

    def _step(self, now: _Now, end: float, dt: float, ratio: float) -> tuple[_Now | None, float]:
        """The end of a step and its estimated error; None if Newton's method fails."""
        before, m = now.instant, self.method
        A_n = before.a + ratio * (now.A - before.a)  # moved to the place of a step of this length
        Z_n = before.z_acceleration + ratio * (now.Z - before.z_acceleration)
        A, Z, known = before.a.copy(), before.z_acceleration.copy(), self.system.known(end)
        free, last, fresh = self.system.free, np.inf, False
        for iteration in range(m.iterations):
            after = self.system.advanced(before, (A_n, Z_n), (A, Z), known, (dt, m))
            if not np.isfinite(after.z).all():
                return None, np.inf
            residual = self.system.residuals(after, known)
            if self.condensed is None or self.condensed[0] is not m or abs(self.condensed[1] - dt) > _SAME * dt:
                self._linearise(after, dt)
                fresh = True
            change_A, change_Z = self._correction(after, residual, dt)
            size = dt * dt * max(np.abs(change_A).max(), np.abs(change_Z[:, self.system.free_positions]).max())
            if not np.isfinite(size):
                return None, np.inf
            A += change_A
            Z += change_Z
            self.iterations += 1
            if size < m.tolerance and (size < _SLOW * last or size < 0.1 * m.tolerance):
                after = self.system.advanced(before, (A_n, Z_n), (A, Z), known, (dt, m))
                joints = np.abs((A - A_n)[free]).max()
                tires = np.abs((Z - Z_n)[:, self.system.free_positions]).max()
                return _Now(instant=after, A=A, Z=Z), m.error * dt * dt * max(joints, tires)
            if size > _SLOW * last and not fresh:
                self._linearise(after, dt)
                fresh, last = True, np.inf
            elif iteration > 2 and size > last:
                return None, np.inf
            else:
                last = size
        return None, np.inf

    def _weights(self, dt: float) -> tuple[float, float, float]:
        m = self.method
        return (1.0 - m.alpha_m) / (1.0 - m.alpha_f), dt * m.gamma, dt * dt * m.beta

    def _linearise(self, after: Instant, dt: float) -> None:
        z, v = self.system.whole(after)
        tangents = self.system.tires.tangents(z, v)
        self.condensed = (
            self.method,
            dt,
            condense(self.system.tires, tangents, self.system.axes(after), self._weights(dt)),
        )
        self.linearisations += 1

    def _correction(self, after: Instant, residual: tuple[FloatArray, ...], dt: float) -> tuple[FloatArray, FloatArray]:
        """Newton's change of A and Z."""
        assert self.condensed is not None
        tires, system = self.condensed[2], self.system
        c, _, w_q = self._weights(dt)
        rho, rho_f, M, hub_forces = residual
        R, J = system.axes(after), after.J
        turned = np.zeros_like(J)
        np.matmul(np.swapaxes(R, -1, -2), J[:, :3], out=turned[:, :3])
        np.matmul(np.swapaxes(R, -1, -2), J[:, 3:], out=turned[:, 3:])
        in_hub = (rho_f @ R).reshape(len(R), -1)
        held = tires.solve(in_hub)
        pushed = np.matmul(tires.carry, in_hub[..., None])[..., 0]
        matrix = c * M + np.einsum("wiv,wij,wju->vu", turned, tires.stiffness, turned, optimize=True)
        matrix -= w_q * _turning(after.hub.z, hub_forces, J)
        right = rho - np.einsum("wiv,wi->v", turned, pushed)
        free = system.free
        change = np.zeros_like(rho)
        change[free] = np.linalg.solve(matrix[np.ix_(free, free)], right[free])
        twist = turned @ change
        held -= np.matmul(tires.follow, twist[..., None])[..., 0]
        return change, held.reshape(rho_f.shape) @ np.swapaxes(R, -1, -2)

    def _motion(self, rows: list[tuple[FloatArray, ...]]) -> FlexibleMotion:
        r, R, u, outputs, wrenches, efforts, z, v = (np.array(column) for column in zip(*rows, strict=True))
        return FlexibleMotion(
            times=self.times[: len(rows)],
            positions=r,
            rotations=R,
            velocities=u,
            tires=outputs,
            wrenches=wrenches,
            efforts=efforts,
            steps=self.accepted,
            iterations=self.iterations,
            rejected=self.rejected,
            vectors=z,
            rates=v,
        )

    def _stopped(self, t: float, rows: list[tuple[FloatArray, ...]]) -> ConvergenceError:
        message = (
            f"motion on flexible tires stopped at t = {t:g} s of {self.times[-1]:g} s: no step down to "
            f"{self.steps.shortest:g} s converges; allow a larger error or shorter steps, or look at the tires there"
        )
        record = IncrementRecord(target=t, step=self.steps.shortest, converged=False, residuals=())
        return ConvergenceError(message, [record], self._motion(rows))


def _turning(z: FloatArray, forces: FloatArray, J: FloatArray) -> FloatArray:
    """Change of the moments sum a_i x F_i with the hub's rotation at fixed forces, in joint coordinates (n_v, n_v)."""
    a, F, spin = z[:, 1:], forces[:, 1:], J[:, 3:]
    G = np.einsum("wia,wib->wab", a, F) - np.einsum("wia,wia->w", a, F)[:, None, None] * np.eye(3)
    return np.asarray(np.einsum("wav,wab,wbu->vu", spin, G, spin, optimize=True))
