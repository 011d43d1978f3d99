"""The augmented equations of the thesis for rigid bodies and tires, equation 2.26 with its sparsity.

    [ M_r  0    C_u^T ] [ u'     ]   [ Q_r ]
    [ 0    I    C_p^T ] [ p_bar''] = [ Q_p ]
    [ C_u  C_p  0     ] [ lambda ]   [ Q_c ]

u holds the twists of all bodies, p_bar the Cholesky coordinates of all tires, reference nodes included: with the mass
of a tire M = L L^T (its vectors in their own order) p_bar = L^T p, Q_bar = L^-1 Q, and the mass is the identity. Since
L^T is upper triangular the last four of p_bar alone make up the reference node, so that C_p stays sparse. The
constraints are those of joints and drives, and twelve a wheel for its reference node. They hold at acceleration level
by the equations, at position and velocity level by projection with the same matrix after each step. Verified by
tests/verification/test_flexible_formulations.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import block_array, coo_array, csr_array, eye_array
from scipy.sparse.linalg import splu

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle, rigid_vectors
from rover_dynamics.flexible.node_constraints import SIZE, NodeConstraints, node_constraints
from rover_dynamics.multibody.assembly import ITERATIONS, POSITION_TOLERANCE
from rover_dynamics.multibody.augmented import AugmentedEquations
from rover_dynamics.multibody.constraints import ConstraintValues
from rover_dynamics.multibody.force import HingeTorque
from rover_dynamics.multibody.formulation import Course, packed, quaternion_rates
from rover_dynamics.multibody.state import State, moved, rotations
from rover_dynamics.vehicle.joint_actions import JointEffort

__all__ = ["ConstrainedCoordinates"]

FloatArray = NDArray[np.float64]


class ConstrainedCoordinates:
    """First-order equations in the coordinates of all bodies and all nodes.

    y : positions (3 n_b), quaternions (4 n_b), twists (6 n_b), p_bar and its rates (n_w, n, 3 each), flat

    Attributes
    ----------
    vehicle : as given
    rigid : joints and drives, and the rigid part of the matrix
    """

    def __init__(self, vehicle: FlexibleVehicle) -> None:
        self.vehicle, self.tires = vehicle, vehicle.tires
        body = vehicle.vehicle
        if body.motors:
            rule = "are not known to the augmented equations"
            raise InputError("motors of the vehicle", len(body.motors), rule, "drive the joints by laws")
        torques = tuple(HingeTorque(joint=one.joint, torque=_constant_in_angle(one)) for one in body.efforts)
        self.rigid = AugmentedEquations(replace(body.model, forces=torques))
        self._n_b = len(body.model.bodies)
        self._wheels = np.array([body.model.number(name) for name in body.wheels], dtype=np.int64)
        self._upper = cholesky(self.tires.mass, lower=False)  # L^T
        self._node = np.linalg.inv(self._upper[-4:, -4:])  # p of the node from the last four of p_bar
        self._dead = self.tires.weight[:, None] * np.array(body.model.gravity)

    # Coordinates -----------------------------------------------------------------------------------------------------

    def start(self) -> FloatArray:
        """See `multibody.formulation.Equations`; tires undeformed."""
        state = self.rigid.start
        R, B, twist = self._bodies(state)
        nodes = np.concatenate([R[:, None], np.swapaxes(B, -1, -2)], axis=1)
        spun = np.concatenate([twist[:, None, :3], np.cross(twist[:, None, 3:], nodes[:, 1:])], axis=1)
        X = rigid_vectors(self.tires)
        return self.with_tires(state, X @ nodes, X @ spun)

    def with_tires(self, state: State, z: FloatArray, z_rate: FloatArray) -> FloatArray:
        """y of bodies and of the tires' vectors and rates (n_w, n, 3)."""
        return np.concatenate([packed(state), (self._upper @ z).ravel(), (self._upper @ z_rate).ravel()])

    def state(self, t: float, y: FloatArray) -> State:
        """See `multibody.formulation.Equations`."""
        n = self._n_b
        q = y[3 * n : 7 * n].reshape(n, 4)
        q = q / np.linalg.norm(q, axis=1, keepdims=True)
        return State(positions=y[: 3 * n].reshape(n, 3), orientations=q, velocities=y[7 * n : 13 * n].reshape(n, 6))

    def vectors(self, t: float, y: FloatArray) -> FloatArray:
        """Vectors of all tires with their reference nodes, (n_w, n, 3)."""
        return self.from_cholesky(self.cholesky(y)[0])

    # The equations ---------------------------------------------------------------------------------------------------

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """See `multibody.formulation.Equations`."""
        state, (p, p_rate) = self.state(t, y), self.cholesky(y)
        twist_rates, p_acceleration, _ = self.accelerations(t, state, p, p_rate)
        turning = quaternion_rates(state.orientations, np.ascontiguousarray(state.velocities[:, 3:]))
        rigid = (state.velocities[:, :3].ravel(), turning.ravel(), twist_rates.ravel())
        return np.concatenate([*rigid, p_rate.ravel(), p_acceleration.ravel()])

    def accelerations(
        self, t: float, state: State, p: FloatArray, p_rate: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """u' (n_b, 6), p_bar'' (n_w, n, 3) and the multipliers."""
        z, z_rate = self.from_cholesky(p), self.from_cholesky(p_rate)
        Q_p = solve_triangular(self._upper.T, self._flat(self.tires.force(z, z_rate) + self._dead), lower=True)
        joints = self.rigid.constraints.at(t, state)
        nodes = node_constraints(z[:, -4:], z_rate[:, -4:], self._bodies(state))
        J, Q_r = self.rigid.inertias_and_forces(t, state)
        right = np.concatenate(
            [Q_r.ravel(), self._unflat(Q_p).ravel(), joints.accelerations, nodes.accelerations.ravel()]
        )
        x = self._solver(J, joints, nodes)(right)
        split = Q_r.size, Q_r.size + p.size
        return x[: split[0]].reshape(-1, 6), x[split[0] : split[1]].reshape(p.shape), x[split[1] :]

    def corrected(self, t: float, y: FloatArray) -> FloatArray:
        """See `multibody.formulation.Equations`: the least change in the sense of the kinetic energy.

        Raises
        ------
        ConvergenceError
            If the positions cannot be brought back to the constraints.
        """
        state, (p, p_rate) = self.state(t, y), self.cholesky(y)
        for _ in range(ITERATIONS):
            joints, nodes = self._constraints(t, state, p, p_rate)
            defects = np.concatenate([joints.defects, nodes.defects.ravel()])
            if np.max(np.abs(defects), initial=0.0) < POSITION_TOLERANCE:
                twists, p_rate = self._velocities(state, p_rate, joints, nodes)
                corrected = State(positions=state.positions, orientations=state.orientations, velocities=twists)
                return np.concatenate([packed(corrected), p.ravel(), p_rate.ravel()])
            change, p_change = self._change(state, joints, nodes, -defects)
            state, p = moved(state, change), p + p_change
        message = f"reference nodes and joints cannot be brought together at t = {t:g} s; shorten the steps"
        raise ConvergenceError(message, [])

    def _velocities(
        self, state: State, p_rate: FloatArray, joints: ConstraintValues, nodes: NodeConstraints
    ) -> tuple[FloatArray, FloatArray]:
        """Twists and rates changed the least so that they obey the constraints."""
        of_joints = joints.rates - joints.jacobian @ state.velocities.ravel()
        node_rates = self._node @ p_rate[:, -4:]
        of_nodes = -np.einsum("wmac,wac->wm", nodes.by_node, node_rates)
        of_nodes -= np.einsum("wmk,wk->wm", nodes.by_body, state.velocities[self._wheels])
        change, p_change = self._change(state, joints, nodes, np.concatenate([of_joints, of_nodes.ravel()]))
        return state.velocities + change, p_rate + p_change

    def accepted(self, t: float, y: FloatArray, course: Course | None) -> None:
        """See `multibody.formulation.Equations`; no use is made of it."""

    def margin(self, t: float, y: FloatArray) -> float:
        """See `multibody.formulation.Equations`; not known here."""
        return 1.0

    def defects(self, t: float, y: FloatArray) -> tuple[float, float]:
        """Largest violation of all constraints at position and at velocity level [m, rad, -; per s]."""
        state, (p, p_rate) = self.state(t, y), self.cholesky(y)
        joints, nodes = self._constraints(t, state, p, p_rate)
        twists, rates = self._velocities(state, p_rate, joints, nodes)
        moved_by = max(np.abs(twists - state.velocities).max(), np.abs(self._node @ (rates - p_rate)[:, -4:]).max())
        return float(max(np.abs(joints.defects).max(initial=0.0), np.abs(nodes.defects).max())), float(moved_by)

    # Parts -----------------------------------------------------------------------------------------------------------

    def _constraints(
        self, t: float, state: State, p: FloatArray, p_rate: FloatArray
    ) -> tuple[ConstraintValues, NodeConstraints]:
        z, z_rate = self._node @ p[:, -4:], self._node @ p_rate[:, -4:]
        return self.rigid.constraints.at(t, state), node_constraints(z, z_rate, self._bodies(state))

    def _change(
        self, state: State, joints: ConstraintValues, nodes: NodeConstraints, right: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        n_u, n_p = 6 * self._n_b, self.tires.n_wheels * 3 * len(self._upper)
        J, _ = self.rigid.inertias_and_forces(0.0, state)
        x = self._solver(J, joints, nodes)(np.concatenate([np.zeros(n_u + n_p), right]))
        return x[:n_u].reshape(-1, 6), x[n_u : n_u + n_p].reshape(self.tires.n_wheels, -1, 3)

    def _solver(
        self, J: FloatArray, joints: ConstraintValues, nodes: NodeConstraints
    ) -> Callable[[FloatArray], FloatArray]:
        """Sparse factors of the matrix of 2.26."""
        by_bodies, by_tires = self._node_rows(nodes)
        C_u, n_joints = joints.jacobian, len(joints.defects)
        n_p = by_tires.shape[1]
        none = csr_array((n_joints, n_p))
        matrix = block_array(
            [
                [self.rigid.mass_matrix(J), None, C_u.T, by_bodies.T],
                [None, eye_array(n_p), none.T, by_tires.T],
                [C_u, none, None, None],
                [by_bodies, by_tires, None, None],
            ],
            format="csc",
        )
        try:
            return splu(matrix).solve
        except RuntimeError as error:
            message = "equations of motion on flexible tires are singular: look at masses, joints and tires there"
            raise ConvergenceError(message, []) from error

    def _node_rows(self, nodes: NodeConstraints) -> tuple[csr_array, csr_array]:
        """Jacobians of the reference nodes by the twists of all bodies, and by p_bar of all tires."""
        n_w, n = self.tires.n_wheels, len(self._upper)
        row = SIZE * np.arange(n_w)[:, None, None] + np.arange(SIZE)[:, None]
        by_body = np.broadcast_to(6 * self._wheels[:, None, None] + np.arange(6), nodes.by_body.shape)
        rows = np.broadcast_to(row, nodes.by_body.shape)
        shape = SIZE * n_w, 6 * self._n_b
        first = coo_array((nodes.by_body.ravel(), (rows.ravel(), by_body.ravel())), shape=shape).tocsr()
        of_p = np.einsum("wmac,ab->wmbc", nodes.by_node, self._node).reshape(n_w, SIZE, 12)
        columns = 3 * n * np.arange(n_w)[:, None, None] + 3 * (n - 4) + np.arange(12)
        columns, rows = np.broadcast_to(columns, of_p.shape), np.broadcast_to(row, of_p.shape)
        shape = SIZE * n_w, 3 * n * n_w
        return first, coo_array((of_p.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()

    def _bodies(self, state: State) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Centres, mounted axes and twists of the wheels' bodies."""
        R = rotations(state.orientations)[self._wheels]
        return state.positions[self._wheels], R @ self.vehicle.mounts, state.velocities[self._wheels]

    def cholesky(self, y: FloatArray) -> FloatArray:
        return y[13 * self._n_b :].reshape(2, self.tires.n_wheels, len(self._upper), 3)

    def _flat(self, x: FloatArray) -> FloatArray:
        """(n, n_w 3) from (n_w, n, 3), for triangular solves."""
        return np.swapaxes(x, 0, 1).reshape(len(self._upper), -1)

    def _unflat(self, x: FloatArray) -> FloatArray:
        return np.swapaxes(x.reshape(len(self._upper), -1, 3), 0, 1)

    def from_cholesky(self, p: FloatArray) -> FloatArray:
        return np.ascontiguousarray(self._unflat(solve_triangular(self._upper, self._flat(p))))


def _constant_in_angle(effort: JointEffort) -> Callable[[float, float, float], float]:
    """The torque of an effort as a hinge's, which may depend on angle and rate."""
    return lambda t, angle, rate: effort.effort(t)
