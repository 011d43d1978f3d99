"""What an integrator needs of the equations of motion, and the three ways they are written.

y' = f(t, y) with y chosen by the formulation; after each step it brings y back to the constraints. Here is the one that
corrects all coordinates; `partitioned_coordinates` integrates only independent ones, `tree_coordinates` has joint
coordinates. Verified by
tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.augmented import AugmentedEquations
from rover_dynamics.multibody.compiled import compiled, multiply_quaternions
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.reactions import Reactions
from rover_dynamics.multibody.state import State

__all__ = ["AbsoluteCoordinates", "Course", "Equations", "Formulation", "NoStep", "packed"]

FloatArray = NDArray[np.float64]
Course = Callable[[float], FloatArray]
"""y as a function of time within a step."""


class Equations(Protocol):
    """First-order equations, as `motion.integrate` takes them."""

    def start(self) -> FloatArray:
        """y of the assembled start, (N,)."""

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """y' (N,) at t [s]."""

    def corrected(self, t: float, y: FloatArray) -> FloatArray:
        """y (N,) with the constraints met at position and velocity level."""

    def state(self, t: float, y: FloatArray) -> State:
        """Positions and velocities of all bodies at t [s] and y (N,)."""

    def accepted(self, t: float, y: FloatArray, course: Course | None) -> None:
        """Be told that a step ended at t [s] with corrected y (N,), and its course; None if y needs no better guess."""

    def margin(self, t: float, y: FloatArray) -> float:
        """Smallest over largest singular value of the loops' equations [-]; its sign changes where it is zero."""


class Formulation(Equations, Protocol):
    """The equations of a model of rigid bodies."""

    model: MultibodyModel

    def reactions(self, t: float, y: FloatArray) -> Reactions:
        """What joints and drives transmit [N, N m] at t [s] and y (N,)."""


class NoStep(Exception):  # noqa: N818  (the integrator makes it an error, with the motion so far)
    """No further step can be taken; says why."""


class AbsoluteCoordinates:
    """Equation 2.26 integrated for all bodies; the constraints are met by projection after each step.

    y : positions (3 n), quaternions (4 n), velocities (6 n)
    """

    def __init__(self, model: MultibodyModel) -> None:
        self.model = model
        self.equations = AugmentedEquations(model)
        self._n = len(model.bodies)

    def start(self) -> FloatArray:
        """See `Formulation`."""
        return packed(self.equations.start)

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """See `Formulation`."""
        state = self.state(t, y)
        acceleration, _ = self.equations.accelerations(t, state)
        turning = quaternion_rates(state.orientations, np.ascontiguousarray(state.velocities[:, 3:]))
        return np.concatenate([state.velocities[:, :3].ravel(), turning.ravel(), acceleration.ravel()])

    def corrected(self, t: float, y: FloatArray) -> FloatArray:
        """See `Formulation`."""
        return packed(self.equations.corrected(t, self.state(t, y)))

    def accepted(self, t: float, y: FloatArray, course: Course | None) -> None:
        """See `Formulation`."""
        self.equations.rows.accepted(t, self.state(t, y))

    def reactions(self, t: float, y: FloatArray) -> Reactions:
        """See `Formulation`."""
        return self.equations.reactions(t, self.state(t, y))

    def margin(self, t: float, y: FloatArray) -> float:
        """See `Formulation`; of the equations kept, scaled to length one."""
        return self.equations.rows.margin(t, self.state(t, y))

    def state(self, t: float, y: FloatArray) -> State:
        """See `Formulation`."""
        n = self._n
        q = y[3 * n : 7 * n].reshape(n, 4)
        q = q / np.linalg.norm(q, axis=1, keepdims=True)
        return State(positions=y[: 3 * n].reshape(n, 3), orientations=q, velocities=y[7 * n :].reshape(n, 6))


def packed(state: State) -> FloatArray:
    """Positions, quaternions and velocities in one vector, (13 n,)."""
    return np.concatenate([state.positions.ravel(), state.orientations.ravel(), state.velocities.ravel()])


@compiled
def quaternion_rates(orientations: FloatArray, angular_velocities: FloatArray) -> FloatArray:
    """1/2 (0, w) * q for each body, (n, 4)."""
    out, turn = np.empty_like(orientations), np.zeros(4)
    for k in range(len(orientations)):
        for i in range(3):
            turn[1 + i] = 0.5 * angular_velocities[k, i]
        multiply_quaternions(turn, orientations[k], out[k])
    return out
