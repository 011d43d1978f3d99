"""Augmented equations of motion with Lagrange multipliers, equation 2.26 of the thesis, in absolute coordinates.

    [ M    C_u^T ] [ u'     ]   [ Q   ]
    [ C_u  0     ] [ lambda ] = [ Q_c ]

u holds the velocity of each centre of mass and the angular velocity, both in world axes; Q the applied wrenches, the
weight and the gyroscopic moments. Positions and velocities are brought back to the constraints by the same matrix, with
the least change in the sense of the kinetic energy. Verified by tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_array, csr_array
from scipy.sparse.linalg import splu

from contracts.errors import ConvergenceError
from rover_dynamics.multibody.assembly import ITERATIONS, POSITION_TOLERANCE, assembly, cannot_be_assembled
from rover_dynamics.multibody.constraints import Constraints, ConstraintValues, Equation
from rover_dynamics.multibody.independent_rows import IndependentRows
from rover_dynamics.multibody.model import BodyMotions, MultibodyModel
from rover_dynamics.multibody.reactions import Reactions, at_joint_frame
from rover_dynamics.multibody.state import State, moved, rotations

__all__ = ["AugmentedEquations", "applied_wrenches"]

FloatArray = NDArray[np.float64]


class AugmentedEquations:
    """Equation 2.26 for a model.

    Attributes
    ----------
    model : as given
    start : assembled positions and velocities
    rows : its independent equations, chosen anew along the motion where they turn dependent

    Raises
    ------
    InputError, ConvergenceError
        See `assembly.assembly`.
    """

    def __init__(self, model: MultibodyModel) -> None:
        self.model = model
        self.start, every, kept = assembly(model)
        self.rows = IndependentRows(every, kept, self.start)
        self._inertias = np.array([body.inertia for body in model.bodies])
        self._masses = np.array([body.mass for body in model.bodies])

    @property
    def constraints(self) -> Constraints:
        """Independent equations, as chosen last."""
        return self.rows.constraints

    @property
    def redundant(self) -> tuple[Equation, ...]:
        """Equations that follow from them; left out."""
        return self.rows.redundant

    def accelerations(self, t: float, state: State) -> tuple[FloatArray, FloatArray]:
        """u', (n, 6) [m/s^2, rad/s^2], and the multipliers, (m,) [N, N m]."""
        return self._solved(self.rows.at(t, state), t, state)

    def _solved(self, values: ConstraintValues, t: float, state: State) -> tuple[FloatArray, FloatArray]:
        J, Q = self.inertias_and_forces(t, state)
        solution = self._solver(J, values.jacobian)(np.concatenate([Q.ravel(), values.accelerations]))
        split = Q.size
        return solution[:split].reshape(-1, 6), solution[split:]

    def inertias_and_forces(self, t: float, state: State) -> tuple[FloatArray, FloatArray]:
        """Inertias (n, 3, 3) in world axes [kg m^2], and Q (n, 6) with weight and gyroscopic moments [N, N m]."""
        Q, J = applied_wrenches(self.model, t, state), self._world_inertias(state)
        w = state.velocities[:, 3:]
        Q[:, 3:] -= np.cross(w, np.einsum("nij,nj->ni", J, w))
        return J, Q

    def reactions(self, t: float, state: State) -> Reactions:
        """What joints and drives transmit [N, N m]: -C_u^T lambda."""
        values = self.rows.at(t, state)
        _, multipliers = self._solved(values, t, state)
        R = np.concatenate([rotations(state.orientations), np.eye(3)[None]])
        wrenches = {joint.name: np.zeros(6) for joint in self.model.joints}
        efforts = {}
        for equation, block, multiplier in zip(self.constraints.equations, values.blocks, multipliers, strict=True):
            wrenches[equation.joint] -= block[1] * multiplier
            if equation.drive is not None:
                efforts[id(equation.drive)] = -multiplier
        return Reactions(
            joints=tuple(wrenches),
            wrenches=np.array([at_joint_frame(self.model, j, R, wrenches[j.name]) for j in self.model.joints]),
            efforts=np.array([efforts[id(drive)] for drive in self.model.drives]),
        )

    def corrected(self, t: float, state: State) -> State:
        """The state with the constraints met at t [s], changed the least in the sense of the kinetic energy.

        Raises
        ------
        SingularPosition
            Where the mechanism gains a freedom.
        ConvergenceError
            If the positions cannot be brought back.
        """
        history: list[float] = []
        for _ in range(ITERATIONS):
            values = self.rows.at(t, state)
            history.append(float(np.max(np.abs(values.defects), initial=0.0)))
            if history[-1] < POSITION_TOLERANCE:
                return self._with_velocities(values, state)
            state = moved(state, self._correction(state, values, -values.defects))
        raise cannot_be_assembled(self.constraints, values.defects, t, history)

    def _with_velocities(self, values: ConstraintValues, state: State) -> State:
        """Velocities changed the least so that C_u u = -C_t."""
        missing = values.rates - values.jacobian @ state.velocities.ravel()
        change = self._correction(state, values, missing)
        return State(positions=state.positions, orientations=state.orientations, velocities=state.velocities + change)

    def _correction(self, state: State, values: ConstraintValues, right: FloatArray) -> FloatArray:
        """Smallest change in the sense of the mass that has C_u change = right, (n, 6)."""
        n = state.velocities.size
        solution = self._solver(self._world_inertias(state), values.jacobian)(np.concatenate([np.zeros(n), right]))
        return np.asarray(solution[:n].reshape(-1, 6))

    def _world_inertias(self, state: State) -> FloatArray:
        R = rotations(state.orientations)
        return np.asarray(R @ self._inertias @ R.swapaxes(1, 2))

    def mass_matrix(self, J: FloatArray) -> csr_array:
        """M, (6 n, 6 n) [kg, kg m^2], from the inertias J (n, 3, 3) [kg m^2] in world axes."""
        n = len(self._masses)
        blocks = np.zeros((n, 6, 6))
        blocks[:, (0, 1, 2), (0, 1, 2)] = self._masses[:, None]
        blocks[:, 3:, 3:] = J
        rows = np.broadcast_to(6 * np.arange(n)[:, None, None] + np.arange(6)[:, None], blocks.shape)
        return csr_array((blocks.ravel(), (rows.ravel(), rows.swapaxes(1, 2).ravel())), shape=(6 * n, 6 * n))

    def _solver(self, J: FloatArray, C_u: csr_array) -> Callable[[FloatArray], FloatArray]:
        """Sparse factors of the matrix of 2.26; ConvergenceError where it is singular."""
        M = self.mass_matrix(J)
        matrix = block_array([[M, C_u.T], [C_u, None]], format="csc") if C_u.shape[0] else M.tocsc()
        try:
            return splu(matrix).solve
        except RuntimeError as error:
            message = "equations of motion are singular: equations have become redundant here; start elsewhere"
            raise ConvergenceError(message, []) from error


def applied_wrenches(model: MultibodyModel, t: float, state: State) -> FloatArray:
    """Weight and the forces of the model, (n, 6) [N, N m], about the centres of mass, world."""
    Q = np.zeros((len(model.bodies), 6))
    Q[:, :3] = np.array([body.mass for body in model.bodies])[:, None] * np.array(model.gravity)
    if model.forces:
        motions = BodyMotions(state.positions, rotations(state.orientations), state.velocities)
        for force in model.forces:
            force.add(t, motions, model, Q)
    return Q
