"""Explicit time integration: velocity Verlet with rigid triads (RATTLE), one force evaluation a step.

Symplectic without damping (Hairer, Lubich & Wanner 2006, VII.1.4): the energy of an elastic system does not drift.
The plates' damping is taken at the step's end by the trapezoidal rule (`implicit_damping`): of second order, and
stable below 2 / omega_max whatever the damping, see `spectrum`. External forces take the rates of half a step before,
of first order where they depend on them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.implicit_damping import ImplicitDamping
from ancf_reduced.motion.mass_factor import MassFactor
from ancf_reduced.motion.plate_system import PlateSystem
from ancf_reduced.motion.rigid_triads import RigidTriads
from contracts.errors import ConvergenceError, InputError

__all__ = ["MotionState", "check_times", "integrate_explicit"]

FloatArray = NDArray[np.float64]

FOLDED = 0.1
"""det F below which a plate counts as folded [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionState:
    """One instant.

    Attributes
    ----------
    time : [s]
    z, v : (n_vectors, 3) float, independent vectors and their rates
    """

    time: float
    z: FloatArray
    v: FloatArray


def integrate_explicit(
    system: PlateSystem,
    start: MotionState,
    times: FloatArray,
    step: float,
    watch: Callable[[MotionState], None] | None = None,
) -> Iterator[MotionState]:
    """States at the wanted times.

    Parameters
    ----------
    system : equations of motion
    start : initial state; it must obey the constraints of the triads
    times : (n,) float, increasing, after the start [s]
    step : longest time step [s]; each stretch between wanted times is cut into equal ones
    watch : called with each step's state

    Raises
    ------
    InputError, ConvergenceError
        For a step or times out of range; if the motion breaks down: a step beyond the stable one, plates that fold.

    Verified by tests/verification/test_ancf_pendulum.py and tests/unit/test_ancf_rigid_hub.py.
    """
    _check(start, times, step)
    kick = _Kick(system)
    time, z, v = start.time, start.z.copy(), start.v.copy()
    push = kick.acceleration(z, v, time)
    for wanted in times:
        count = max(1, math.ceil((wanted - time) / step * (1.0 - 1e-12)))
        h, begun = (wanted - time) / count, time
        for k in range(count):
            half = v + 0.5 * h * push
            moved = z + h * half
            try:
                correction = kick.triads.place(moved, z)
                z, half, time = moved + correction, half + correction / h, begun + (k + 1) * h
                v, push = kick(z, half, time, h)
            except ConvergenceError as error:
                raise ConvergenceError(_message(system, z, time, h, f"{error}; "), [], None) from error
            if watch is not None:
                watch(MotionState(time=time, z=z, v=v))
        if not np.isfinite(v).all() or _smallest_ratio(system, z) <= 0.0:
            raise ConvergenceError(_message(system, z, time, h), [], None)
        yield MotionState(time=time, z=z.copy(), v=v.copy())


class _Kick:
    """The second half of a step, in which positions stand still and rates change."""

    def __init__(self, system: PlateSystem) -> None:
        self.system, self.factor = system, MassFactor(system.mass)
        self.triads = RigidTriads(system.coordinates.triads, self.factor, system.coordinates.n_vectors)
        self.damping = ImplicitDamping(system, self.triads) if system.depends_on_rates else None

    def acceleration(self, z: FloatArray, v: FloatArray, time: float) -> FloatArray:
        """Of all forces but the triads' [m/s^2, 1/s^2]."""
        return self.factor.solve(self.system.force(z, v, time))

    def __call__(self, z: FloatArray, half: FloatArray, time: float, h: float) -> tuple[FloatArray, FloatArray]:
        """Rates at the step's end from those at its middle, and the acceleration there, (n_vectors, 3) both.

        The acceleration may contain forces along the gradients of triads: `RigidTriads.place` finds these anew.
        """
        if self.damping is None:
            push = self.acceleration(z, half, time)
            v = half + 0.5 * h * push
            return v + self.triads.stop(v, z), push
        v = self.damping.rates(half, z, time, h)
        return v, (v - half) / (0.5 * h)


def _smallest_ratio(system: PlateSystem, z: FloatArray) -> float:
    """Smallest det F at any integration point [-]; very small where it is not a number."""
    return float(np.nan_to_num(system.model.volume_ratio(system.coordinates.expand(z)), nan=-1e300).min())


def _message(system: PlateSystem, z: FloatArray, time: float, step: float, why: str = "") -> str:
    """Why a motion broke down at z: plates that fold, or a step that is too long; ``why`` is what gave in."""
    smallest = _smallest_ratio(system, z)
    where = f"explicit motion broke down at {time:.4g} s with a step of {step:.3g} s"
    if smallest < FOLDED:
        return f"{where}: plates fold (smallest det F {smallest:.2g}), beyond their material law; load them less"
    return f"{where}: {why}use a step below 2 / omega_max (spectrum.stable_step)"


def _check(start: MotionState, times: FloatArray, step: float) -> None:
    if not (math.isfinite(step) and step > 0.0):
        raise InputError("time step", f"{step:g} s", "must be finite and > 0", "take spectrum.stable_step")
    check_times(start, times)


def check_times(start: MotionState, times: FloatArray) -> None:
    """Raise InputError for no times, or wanted times (n,) [s] that are not finite or do not increase from the start's.

    Verified by tests/unit/test_ancf_implicit_dynamics.py.
    """
    if not len(times) or not np.all(np.diff(np.concatenate([[start.time], times])) > 0.0) or times[-1] == np.inf:
        rule = f"must be finite and increase from the start at {start.time:g} s"
        raise InputError("times", f"{np.asarray(times).tolist()[:5]} s", rule, "sort them")
