"""Static equilibrium: positions of a model at rest in which no body accelerates.

Accelerations a of the bodies at rest are followed to where they vanish by implicit steps in pseudo-time
(pseudo-transient continuation, Kelley and Keyes 1998),

    (alpha 1 - da/dq) dq = a,

whose length grows as long as the accelerations after a step are those the matrix predicts: far off the bodies move the
way they would fall, close by it is Newton's method. Alpha stays above the eigenvalues of da/dq, so that an unstable
position is left. A neutral direction, such as a wheel's roll on a plane, has no acceleration and stays where it is.
Verified by tests/verification/test_multibody_statics.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.multibody.reactions import Reactions
from rover_dynamics.multibody.state import State
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.tree_kernels import advance, tree_motion

__all__ = ["Equilibrium", "static_equilibrium"]

FloatArray = NDArray[np.float64]

_DIFFERENCE = 1e-6
"""Central difference of a joint displacement [rad, m]."""
_LARGEST_STEP = 0.2
"""Of a joint in one iteration [rad, m]."""
_FIRST, _SOFTEST, _FIRMEST = 100.0, 1e-6, 1e8
"""Alpha at first, and its bounds [1/s^2]."""
_SOFTER, _HARDER = 0.2, 4.0
"""Change of alpha after a step whose accelerations were as predicted, or not at all."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Equilibrium:
    """A position at rest.

    Attributes
    ----------
    state : of all bodies, velocities zero
    reactions : what joints and drives carry
    acceleration : largest joint acceleration left [rad/s^2, m/s^2]
    iterations : steps taken
    neutral : directions without stiffness: zeros among the eigenvalues of da/dq
    stable : whether no eigenvalue of da/dq is positive
    """

    state: State
    reactions: Reactions
    acceleration: float
    iterations: int
    neutral: int
    stable: bool


def static_equilibrium(
    model: MultibodyModel, *, time: float = 0.0, tolerance: float = 1e-8, iterations: int = 300
) -> Equilibrium:
    """Find positions at which the model stays at rest, with drives held where their laws are.

    Parameters
    ----------
    model : starts from its assembled positions; velocities are set to zero
    time : at which forces and the drives' values are taken [s]
    tolerance : largest joint acceleration left [rad/s^2, m/s^2]
    iterations : most steps

    Raises
    ------
    InputError
        If the tolerance is not positive.
    ConvergenceError
        If there is no such position near by: something falls, or pushes without end.
    """
    if not tolerance > 0.0:
        raise InputError("tolerance of the equilibrium", f"{tolerance:g}", "must be > 0", "give e.g. 1e-8")
    rest = _AtRest(_held(model, time), time)
    q, alpha, history = rest.start(), _FIRST, list[float]()
    a = rest.accelerations(q)
    for _ in range(iterations):
        history.append(float(np.max(np.abs(a), initial=0.0)))
        K = rest.stiffness(q)
        if history[-1] < tolerance:
            return rest.equilibrium(q, K, history)
        alpha = max(alpha, 1.5 * float(np.max(np.linalg.eigvals(K).real)), _SOFTEST)
        step = np.linalg.solve(alpha * np.eye(len(a)) - K, a)
        step *= min(1.0, _LARGEST_STEP / float(np.max(np.abs(step))))
        q_new = rest.moved(q, step)
        a_new = rest.accelerations(q_new)
        missed = float(np.linalg.norm(a_new - a - K @ step) / np.linalg.norm(a))
        if missed < 1.0 or alpha > _FIRMEST:
            q, a = q_new, a_new
        alpha *= _SOFTER if missed < 0.3 else _HARDER if missed > 0.7 else 1.0
    message = (
        f"no static equilibrium found in {iterations} steps: a joint still accelerates by {history[-1]:.3g} (rad or m)"
        "/s^2; support what falls, or start closer"
    )
    raise ConvergenceError(message, [IncrementRecord(target=time, step=0.0, converged=False, residuals=tuple(history))])


def _held(model: MultibodyModel, t: float) -> MultibodyModel:
    """The model at rest, with each drive held at its value at t."""
    bodies = tuple(replace(body, velocity=np.zeros(3), angular_velocity=np.zeros(3)) for body in model.bodies)
    drives = tuple(replace(drive, law=Hold(value=drive.law.at(t)[0])) for drive in model.drives)
    return replace(model, bodies=bodies, drives=drives)


class _AtRest:
    """Accelerations of a model at rest as functions of its independent joint coordinates."""

    def __init__(self, model: MultibodyModel, t: float) -> None:
        self._equations, self._t = TreeCoordinates(model), t
        self._n_q = int(self._equations.tree.q_at[-1])
        self._still = np.zeros(int(self._equations.tree.v_at[-1]))
        self._independent = self._equations.independent

    def start(self) -> FloatArray:
        return self._equations.corrected(self._t, self._equations.start())[: self._n_q]

    def moved(self, q: FloatArray, step: FloatArray) -> FloatArray:
        """Coordinates (n_q,) after displacements (n_i,) [rad, m] of the independent joints, with the loops closed."""
        tree, displacement = self._equations.tree, self._still.copy()
        displacement[self._independent] = step
        loops = self._equations.loops
        motion = tree_motion(tree, q, self._still)
        if loops:
            J = loops.rows(self._t, motion).jacobian
            displacement[loops.dependent] = np.linalg.solve(J[:, loops.dependent], -J @ displacement)
        q = advance(tree, q, displacement, motion.frames)
        return self._equations.corrected(self._t, np.concatenate([q, self._still]))[: self._n_q]

    def accelerations(self, q: FloatArray) -> FloatArray:
        motion = tree_motion(self._equations.tree, q, self._still)
        return np.asarray(self._equations.accelerations(self._t, motion).joints[self._independent])

    def stiffness(self, q: FloatArray) -> FloatArray:
        """da/dq (n_i, n_i) of the independent joints by central differences [1/s^2, m/(rad s^2), rad/(m s^2)]."""
        n, h = len(self._independent), _DIFFERENCE
        columns = [
            (self.accelerations(self.moved(q, h * e)) - self.accelerations(self.moved(q, -h * e))) / (2.0 * h)
            for e in np.eye(n)
        ]
        return np.array(columns).reshape(n, n).T

    def equilibrium(self, q: FloatArray, K: FloatArray, history: list[float]) -> Equilibrium:
        y = np.concatenate([q, self._still])
        rates = np.linalg.eigvals(K).real if K.size else np.zeros(0)
        small = 1e-6 * max(1.0, float(np.max(np.abs(rates), initial=0.0)))
        return Equilibrium(
            state=self._equations.state(self._t, y),
            reactions=self._equations.reactions(self._t, y),
            acceleration=history[-1],
            iterations=len(history) - 1,
            neutral=int(np.sum(np.abs(rates) < small)),
            stable=bool(np.all(rates < small)),
        )
