"""Implicit time integration: generalised-alpha with adaptive step and rigid triads.

Chung & Hulbert (1993), with the constraints at position level as in Arnold & Bruels (2007): at each step Newton solves
    M z'' + Q(z, z') + G^T lambda = 0,   g(z) = 0
for the new state, z and z' being given by the auxiliary accelerations a:
    z_1 = z_0 + h v_0 + h^2 ((1/2 - beta) a_0 + beta a_1),   v_1 = v_0 + h ((1 - gamma) a_0 + gamma a_1),
    (1 - alpha_m) a_1 + alpha_m a_0 = (1 - alpha_f) z''_1 + alpha_f z''_0.
The spectral radius at infinity rho sets the numerical damping of frequencies that the step does not resolve. The local
error is h^2 |(beta - 1/6)(a_1 - a_0)| over the position vectors.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.explicit import MotionState, check_times
from ancf_reduced.motion.linearisation import Linearisation
from ancf_reduced.motion.plate_system import PlateSystem
from ancf_reduced.motion.triad_equations import TriadEquations
from contracts.errors import ConvergenceError, InputError

__all__ = ["ImplicitSettings", "integrate_implicit"]

FloatArray = NDArray[np.float64]

_GROWTH, _SHRINKING = 1.5, 0.25
"""Largest and smallest change of the step from one to the next."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ImplicitSettings:
    """Choices of the integrator.

    Attributes
    ----------
    tolerance : local error of a position in one step [m]
    spectral_radius : rho at infinite frequency, 1 without numerical damping, 0 kills it at once [-]
    first_step, smallest_step, largest_step : [s]
    newton_tolerance : largest correction of a position that ends the iteration, relative to ``tolerance`` [-]
    newton_iterations : after so many the step is cut
    """

    tolerance: float = 1e-6
    spectral_radius: float = 0.9
    first_step: float = 1e-4
    smallest_step: float = 1e-9
    largest_step: float = 1e-2
    newton_tolerance: float = 1e-3
    newton_iterations: int = 12

    def __post_init__(self) -> None:
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise InputError("spectral radius", self.spectral_radius, "must lie in 0..1", "0.9 is usual")
        positive = ("tolerance", "first_step", "smallest_step", "largest_step", "newton_tolerance", "newton_iterations")
        for name in positive:
            if not 0.0 < getattr(self, name) < math.inf:
                rule = "must be finite and > 0"
                raise InputError(name.replace("_", " "), getattr(self, name), rule, "use the default")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Weights:
    """Coefficients of the method for a spectral radius."""

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float

    @classmethod
    def of(cls, rho: float) -> _Weights:
        alpha_m, alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
        gamma = 0.5 - alpha_m + alpha_f
        return cls(alpha_m=alpha_m, alpha_f=alpha_f, beta=0.25 * (gamma + 0.5) ** 2, gamma=gamma)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Step:
    """State with its true accelerations, auxiliary ones, and multipliers."""

    state: MotionState
    acceleration: FloatArray
    auxiliary: FloatArray
    multipliers: FloatArray


def integrate_implicit(
    system: PlateSystem,
    start: MotionState,
    times: FloatArray,
    settings: ImplicitSettings | None = None,
    watch: Callable[[MotionState], None] | None = None,
) -> Iterator[MotionState]:
    """States at the wanted times (n,) [s], vectors and rates (n_vectors, 3) each.

    Parameters
    ----------
    system, start, times, watch : as `motion.explicit.integrate_explicit`
    settings : tolerances and steps

    Raises
    ------
    InputError
        For no times, or some that are not finite or do not increase from the start.
    ConvergenceError
        If the step would have to be cut below the smallest one, or the start has no consistent accelerations.

    Verified by tests/unit/test_ancf_implicit_dynamics.py.
    """
    check_times(start, times)
    run = _Run(system, settings or ImplicitSettings())
    here, h = run.begin(start), run.settings.first_step
    for wanted in times:
        while here.state.time < wanted * (1.0 - 1e-14):
            last = here.state.time + h * (1.0 + 1e-6) >= wanted
            step = wanted - here.state.time if last else h
            found = run.advance(here, step)
            error = run.error(here, found, step) if found is not None else math.inf
            if found is None or error > 1.0:
                h = step * (max(_SHRINKING, 0.9 * error ** (-1.0 / 3.0)) if found is not None else _SHRINKING)
                if h < run.settings.smallest_step:
                    raise ConvergenceError(_message(here.state.time, h, found is None), [], None)
                continue
            here = found
            grown = step * min(_GROWTH, 0.9 * max(error, 1e-9) ** (-1.0 / 3.0))
            h = min(max(grown, h) if last else grown, run.settings.largest_step)
            if watch is not None:
                watch(here.state)
        yield here.state


def _message(time: float, step: float, stalled: bool) -> str:
    cause = "Newton's iteration does not converge" if stalled else "the local error stays above its tolerance"
    return f"implicit motion stopped at {time:.4g} s: {cause} at a step of {step:.3g} s; raise the tolerance"


class _Run:
    """One integration: matrices, constraints and settings."""

    def __init__(self, system: PlateSystem, settings: ImplicitSettings) -> None:
        self.system, self.settings = system, settings
        self.matrices, self.weights = Linearisation(system), _Weights.of(settings.spectral_radius)
        self._positions, self._triads = system.coordinates.position_rows, TriadEquations(system.coordinates)

    def begin(self, start: MotionState) -> _Step:
        """Consistent accelerations: M z'' + G^T lambda = Q with G z'' = -G' z'."""
        force = self.system.force(start.z, start.v, start.time)
        G = self._triads.jacobian(start.z)
        bias = -self._triads.jacobian_rate(start.v) @ start.v.ravel()
        try:
            x = self.matrices.solve(self.matrices.mass, G, np.concatenate([force.ravel(), bias]))
        except np.linalg.LinAlgError as error:
            message = f"implicit motion cannot start at {start.time:.4g} s: {error}; look at masses, forces and triads"
            raise ConvergenceError(message, []) from error
        a = x[: force.size].reshape(-1, 3)
        return _Step(state=start, acceleration=a, auxiliary=a, multipliers=x[force.size :])

    def advance(self, here: _Step, h: float) -> _Step | None:
        """One step h [s]; None if Newton's iteration does not converge or its matrix is singular."""
        w, system = self.weights, self.system
        time, a, lam = here.state.time + h, here.acceleration.copy(), here.multipliers
        auxiliary = (w.alpha_f * here.acceleration + (1.0 - w.alpha_f) * a - w.alpha_m * here.auxiliary) / (
            1.0 - w.alpha_m
        )
        z = here.state.z + h * here.state.v + h * h * ((0.5 - w.beta) * here.auxiliary + w.beta * auxiliary)
        v = here.state.v + h * ((1.0 - w.gamma) * here.auxiliary + w.gamma * auxiliary)
        by_z, by_v = (1.0 - w.alpha_m) / (h * h * w.beta * (1.0 - w.alpha_f)), w.gamma / (h * w.beta)
        for _ in range(self.settings.newton_iterations):
            G = self._triads.jacobian(z)
            inertia = np.asarray(self.matrices.mass @ a.ravel())
            residual = inertia + G.T @ lam - system.force(z, v, time).ravel()
            K, C = self.matrices.stiffness_and_damping(z, v, time)
            K = K + self.matrices.like_mass(self._triads.stiffness(lam))
            tangent = by_z * self.matrices.mass + by_v * C + K
            right = -np.concatenate([residual, self._triads.defect(z)])
            if not np.isfinite(right).all():
                return None
            try:
                x = self.matrices.solve(tangent, G, right)
            except np.linalg.LinAlgError:
                return None
            dz = x[: z.size].reshape(-1, 3)
            z, v, a, lam = z + dz, v + by_v * dz, a + by_z * dz, lam + x[z.size :]
            if np.abs(dz[self._positions]).max() < self.settings.newton_tolerance * self.settings.tolerance:
                auxiliary = (w.alpha_f * here.acceleration + (1.0 - w.alpha_f) * a - w.alpha_m * here.auxiliary) / (
                    1.0 - w.alpha_m
                )
                state = MotionState(time=time, z=z, v=v)
                return _Step(state=state, acceleration=a, auxiliary=auxiliary, multipliers=lam)
        return None

    def error(self, here: _Step, found: _Step, h: float) -> float:
        """Local error relative to its tolerance [-]."""
        difference = (found.auxiliary - here.auxiliary)[self._positions]
        return float(h * h * abs(self.weights.beta - 1.0 / 6.0) * np.abs(difference).max() / self.settings.tolerance)
