"""A vehicle on flexible tires brought to rest before it moves: its weight is raised in steps, and nothing swings.

A step of Newmark's method that begins without velocities, with beta = 1 and gamma = dt / T, is one of the proximal
point method,

    M dq / dt^2 = Q(q + dq, dq / T) + share of the weight,

which for forces with a potential U makes U + dq . M dq / (2 dt^2) least (Rockafellar 1976, from memory): whatever its
length, U falls and no wheel swings beyond its balance. Lengths grow as Newton's method bears them. What is left of the
first term is what the forces lack of balance. Each step's way is taken to last T, so that a short one slides against
little friction; at the end friction is what balance asks of it, and a wheel that it holds creeps, see
`ancf_reduced.contact.law`.

A step's matrix is made once. Where contact points come and go its changes can go to and fro between two sets of them
without end; such a step is taken where they are below a millimetre.

Verified by tests/verification/test_rover_starts_at_rest.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle
from rover_dynamics.flexible.step_solver import StepEnd, StepSolver
from rover_dynamics.multibody.generalised_alpha import Method, damped_newmark
from rover_dynamics.vehicle.implicit_method import Known

__all__ = ["UNBALANCED", "Faults", "brought_to_rest", "unbalanced"]

FloatArray = NDArray[np.float64]
Faults = Callable[[Instant], tuple[str, float]]
"""Words for the plate of least volume, and its volume over that at rest: one of zero or less is inverted [-]."""

UNBALANCED = 5e-4
"""What may be missing of balance at rest: acceleration of any joint or node over gravity [-]."""
_FIRST, _MOST, _LEAST = 0.1, 0.2, 0.01
"""Share of the weight added at first, at most and at least [-]."""
_SHORT, _LONG, _SHORTEST = 0.02, 2.0, 1e-3
"""First, longest and shortest step dt; the longest is T [s]."""
_FARTHEST = 0.02
"""Of a joint or node in one step [m, rad]."""
_STEPS = 400
"""Of one share of the weight, at most."""
_NEWTON, _TO_AND_FRO = damped_newmark(1e-7, 12), 1e-3
"""Newton's method, and the change at which it may end where it does not converge [m, rad]."""


def brought_to_rest(vehicle: FlexibleVehicle, t: float, faults: Faults | None = None) -> Instant:
    """The vehicle at rest under its whole weight.

    Parameters
    ----------
    vehicle : starts where its model says, tires undeformed, best with the first of them just touching; what is to
        stand on slopes or rocks needs held drives
    t : at which laws and efforts are taken [s]
    faults : looks at each step's end; a tire that gives way ends the way there

    Raises
    ------
    ConvergenceError
        If there is no equilibrium: with the load asked for, the largest one found, and what gives way beyond it.
    """
    place: Instant | None = None
    share, more = 0.0, _FIRST
    while share < 1.0:
        wanted = min(1.0, share + more)
        try:
            place = _Way(vehicle, wanted, t, faults).balanced(place)
        except ConvergenceError as error:
            more = 0.5 * more
            if more < _LEAST:
                raise ConvergenceError(_none_found(vehicle, (share, place), str(error)), error.history) from error
        else:
            share, more = wanted, min(2.0 * more, _MOST)
    assert place is not None
    return place


def unbalanced(system: FlexibleSystem, A: FloatArray, Z: FloatArray) -> float:
    """Largest acceleration of a free joint, A (n_v,), or a node, Z (n_w, n_f, 3), over gravity [-]."""
    return _largest(system, A, Z) / float(np.linalg.norm(system.gravity))


def _largest(system: FlexibleSystem, A: FloatArray, Z: FloatArray) -> float:
    return float(max(np.abs(A[system.free]).max(), np.abs(Z[:, system.free_positions]).max()))


def _weighing(vehicle: FlexibleVehicle, share: float) -> FlexibleVehicle:
    """The same under a share of its gravity."""
    body, model = vehicle.vehicle, vehicle.vehicle.model
    x, y, z = (share * float(g) for g in model.gravity)
    return replace(vehicle, vehicle=replace(body, model=replace(model, gravity=(x, y, z))))


class _Way:
    """To balance under a share of the gravity."""

    def __init__(self, vehicle: FlexibleVehicle, share: float, t: float, faults: Faults | None) -> None:
        self._system, self._share = FlexibleSystem(_weighing(vehicle, share)), share
        self._t, self._faults = t, faults
        self._solver = StepSolver(self._system)
        self._methods: dict[tuple[float, float], Method] = {}

    def _step(self, now: StepEnd, known: Known, dt: float) -> StepEnd | None:
        """The end of a step; None if Newton's method fails, or leaves the ground on its way."""
        for tolerance in (_NEWTON.tolerance, _TO_AND_FRO):
            method = _NEWTON._replace(gamma=dt / _LONG, tolerance=tolerance)
            try:
                found, _ = self._solver.step(now, known, dt, self._methods.setdefault((dt, tolerance), method))
            except InputError:
                self._solver.forget()
                if dt < 2.0 * _SHORTEST:
                    raise
                found = None
            if found is not None:
                return found
        return None

    def balanced(self, place: Instant | None) -> Instant:
        """At rest, from another place or the model's start; ConvergenceError if it is not found."""
        system = self._system
        known, now, dt = system.known(self._t), self._still(place or system.at_rest(self._t)), _SHORT
        left = np.inf
        for _ in range(_STEPS):
            found = self._step(now, known, dt)
            moved = np.inf if found is None else dt * dt * _largest(system, found.A, found.Z)
            if found is None or moved > _FARTHEST:
                dt *= 0.5
                if dt < _SHORTEST:
                    raise self._stopped("no step converges", now.instant)
                continue
            now = self._still(found.instant)
            self._look(now.instant)
            left = self._share * unbalanced(system, found.A, found.Z)
            if left < UNBALANCED:
                return now.instant
            dt = min(2.0 * dt, _LONG)
        raise self._stopped(f"after {_STEPS} steps {left:.2g} of gravity is not balanced", now.instant)

    def _look(self, now: Instant) -> None:
        """Raises ConvergenceError for an inverted plate."""
        if self._faults is not None and self._faults(now)[1] <= 0.0:
            raise self._stopped("a tire folds", now)

    def _still(self, place: Instant) -> StepEnd:
        """There without velocities and accelerations."""
        instant = self._system.at_rest_there(place)
        return StepEnd(instant=instant, A=instant.a, Z=instant.z_acceleration)

    def _stopped(self, what: str, now: Instant) -> ConvergenceError:
        words = "" if self._faults is None else f"; least volume has {self._faults(now)[0].removesuffix(',')}"
        record = IncrementRecord(target=self._t, step=0.0, converged=False, residuals=())
        return ConvergenceError(f"{what}{words}", [record])


def _none_found(vehicle: FlexibleVehicle, last: tuple[float, Instant | None], why: str) -> str:
    """Words for a vehicle that does not stand: load asked for, the largest found, what gives way."""
    (share, place), n = last, vehicle.tires.n_wheels
    system = FlexibleSystem(vehicle)
    g = float(np.linalg.norm(system.gravity))
    mass = system.tree.masses.sum() + n * vehicle.tires.weight[vehicle.tires.position_rows].sum()
    asked = f"no equilibrium: asked for a mean wheel load of {mass * g / n:.0f} N"
    if place is None:
        return f"{asked}, found none at {100.0 * _LEAST:g} % of it; {why}"
    loads = vehicle.tires.contacts(*system.whole(place)).load
    wheel = vehicle.vehicle.wheels[int(loads.argmax())].replace("_", " ")
    found = f"found up to {share * mass * g / n:.0f} N ({loads.max():.0f} N on {wheel}, which carries most)"
    return f"{asked}, {found}; beyond, {why}"
