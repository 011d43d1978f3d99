"""Equations of motion of a vehicle on flexible tires, reference nodes eliminated.

Verified by tests/verification/test_flexible_motion.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle, rigid_vectors
from rover_dynamics.flexible.hub_kernels import HubMotion, hub_motion, hub_wrenches, wheel_jacobians
from rover_dynamics.multibody.generalised_alpha import Method, newmark, step_frames
from rover_dynamics.multibody.tree_kernels import TreeMotion, bias_and_mass, tree_motion
from rover_dynamics.tires.brush_force import HubMotions, brush_forces, brush_result, brush_scratch
from rover_dynamics.tires.brush_settings import wheel_numbers
from rover_dynamics.vehicle.implicit_method import Known

__all__ = ["FlexibleSystem", "Instant", "Residual", "joined", "node_jacobians"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Instant:
    """Everything at one time.

    Attributes
    ----------
    q, v, a : (n_q,), (n_v,), (n_v,) float, coordinates, velocities, accelerations of the joints
    z, z_rate, z_acceleration : (n_w, n_f, 3) float, free vectors of the tires
    motion, hub : bodies and reference nodes
    J : (n_w, 6, n_v) float, twist of each hub by v
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    z: FloatArray
    z_rate: FloatArray
    z_acceleration: FloatArray
    motion: TreeMotion
    hub: HubMotion
    J: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Residual:
    """Forces that accelerations do not use up, and what came up on the way.

    Attributes
    ----------
    joints : (n_v,) float, of the joints [N, N m]; of driven ones minus the effort of the drive
    tires : (n_w, n_f, 3) float, of the free vectors [N, N m]
    mass : (n_v, n_v) float, of the rigid bodies in the joints
    hubs : (n_w, 4, 3) float, forces on the reference nodes
    slopes : (n_m,) float, how motors' torques fall with speed [N m s/rad]
    """

    joints: FloatArray
    tires: FloatArray
    mass: FloatArray
    hubs: FloatArray
    slopes: FloatArray


class FlexibleSystem:
    """Constant data and the residuals.

    Attributes
    ----------
    vehicle, tires : as given
    free : (n,) int, joint velocities that no drive moves
    free_positions : (n,) int, free vectors of a tire that are positions
    """

    def __init__(self, vehicle: FlexibleVehicle) -> None:
        self.vehicle, self.tires = vehicle, vehicle.tires
        rigid = vehicle.vehicle
        self.actions = rigid.joint_actions()
        self.tree = self.actions.coordinates.tree
        self.free, self.driven = self.actions.free, self.actions.driven
        self.wheels = np.array([rigid.model.number(name) for name in rigid.wheels], dtype=np.int64)
        self.gravity = np.array(rigid.model.gravity, dtype=np.float64)
        self.free_positions: IntArray = self.tires.position_rows[:-1]
        self._dead = self.tires.weight[:, None] * self.gravity
        self._mounts = np.ascontiguousarray(vehicle.mounts)
        M = self.tires.mass
        self._M_f, self._M_r = np.ascontiguousarray(M[:-4]), np.ascontiguousarray(M[-4:])
        pieces = rigid.terrain.pieces()
        self._gauge = wheel_numbers(rigid.tire, rigid.settings), pieces, brush_scratch(pieces)
        self._gauged = brush_result(len(self.wheels), pieces)

    def known(self, t: float) -> Known:
        """What drives and efforts prescribe at t [s]."""
        return self.actions.known(t)

    def instant(self, joints: tuple[FloatArray, FloatArray, FloatArray], tires: tuple[FloatArray, ...]) -> Instant:
        """Bodies and reference nodes for coordinates, velocities and accelerations of joints and free vectors.

        Parameters
        ----------
        joints : q (n_q,) [rad, m, -], v (n_v,) [rad/s, m/s] and a (n_v,) [rad/s^2, m/s^2]
        tires : free vectors (n_w, n_f, 3) [m, -], their rates [m/s, 1/s] and accelerations [m/s^2, 1/s^2]
        """
        q, v, a = joints
        z, z_rate, z_acceleration = tires
        motion = tree_motion(self.tree, q, v)
        J = wheel_jacobians(self.tree, motion, self.wheels)
        twist_rates = J @ a + motion.accelerations[self.wheels]
        return Instant(
            q=q,
            v=v,
            a=a,
            z=z,
            z_rate=z_rate,
            z_acceleration=z_acceleration,
            motion=motion,
            hub=hub_motion(motion, self.wheels, self._mounts, twist_rates),
            J=J,
        )

    def at_rest(self, t: float) -> Instant:
        """Start of the model at t [s] with undeformed tires that move with their hubs, and consistent accelerations."""
        q, v = self.actions.start(t)
        zero = np.zeros((len(self.wheels), len(self._M_f), 3))
        instant = self.instant((q, v, np.zeros_like(v)), (zero, zero, zero))
        X = rigid_vectors(self.tires)[:-4]
        z, z_rate = X @ instant.hub.z, X @ instant.hub.v
        return self.accelerated(q, v, (z, z_rate), self.known(t))

    def at_rest_there(self, place: Instant) -> Instant:
        """Another motion's coordinates without velocities and accelerations; its vehicle may have weighed less.

        Smoothed friction is none at rest: accelerations that follow from that would begin a slip of what it holds.
        """
        still, none = np.zeros_like(place.v), np.zeros_like(place.z)
        return self.instant((place.q, still, still), (place.z, none, none))

    def accelerated(self, q: FloatArray, v: FloatArray, tires: tuple[FloatArray, FloatArray], known: Known) -> Instant:
        """The instant with the accelerations that its forces cause.

        Parameters
        ----------
        q, v : (n_q,), (n_v,) float, coordinates [rad, m, -] and velocities [rad/s, m/s] of the joints
        tires : free vectors (n_w, n_f, 3) [m, -] and their rates [m/s, 1/s]
        known : what is prescribed then
        """
        z, z_rate = tires
        a = np.zeros_like(v)
        a[self.driven] = known.a
        bare = self.instant((q, v, a), (z, z_rate, np.zeros_like(z)))
        left = self.residual(bare, known)
        M_ff, M_fr, M_rr = self._M_f[:, :-4], self._M_f[:, -4:], self._M_r[:, -4:]
        follow = np.linalg.solve(M_ff, M_fr)
        held = np.linalg.solve(M_ff, left.tires)
        D = node_jacobians(bare.hub.z, bare.J)
        flat = D.reshape(len(D), 12, -1)
        carried = np.tensordot(D, M_rr - M_fr.T @ follow, axes=(1, 1))  # (n_w, 3, n_v, 4)
        added = joined(flat, np.moveaxis(carried, -1, 1).reshape(flat.shape))
        right = left.joints - joined(flat, (M_fr.T @ held).reshape(len(D), 12, 1))[:, 0]
        free = self.free
        change = np.zeros_like(v)
        change[free] = np.linalg.solve((left.mass + added)[np.ix_(free, free)], right[free])
        return self.instant((q, v, a + change), (z, z_rate, held - follow @ (D @ change)))

    def advanced(
        self,
        before: Instant,
        method_before: tuple[FloatArray, FloatArray],
        method_after: tuple[FloatArray, FloatArray],
        known: Known,
        step_of: tuple[float, Method],
    ) -> Instant:
        """End of a generalised-alpha step with the method's accelerations of joints and tires.

        Parameters
        ----------
        before : where it starts
        method_before, method_after : A (n_v,) [rad/s^2, m/s^2] and Z (n_w, n_f, 3) [m/s^2, 1/s^2] of its start and its
            end; the end's A takes over the accelerations of the drives
        known : what is prescribed at its end
        step_of : length [s], method
        """
        (A_n, Z_n), (A, Z), (dt, w) = method_before, method_after, step_of
        m, f, beta, gamma = w.alpha_m, w.alpha_f, w.beta, w.gamma
        a = ((1.0 - m) * A + m * A_n - f * before.a) / (1.0 - f)
        start = step_frames(self.tree, before.q, before.v)
        q, v = newmark(self.tree, (before.q, before.v, A_n), A, start, step_of)
        q[self.actions.driven_q], v[self.driven], a[self.driven] = known.q, known.v, known.a
        A[self.driven] = known.a
        z = before.z + dt * before.z_rate + dt * dt * ((0.5 - beta) * Z_n + beta * Z)
        z_rate = before.z_rate + dt * ((1.0 - gamma) * Z_n + gamma * Z)
        z_acceleration = ((1.0 - m) * Z + m * Z_n - f * before.z_acceleration) / (1.0 - f)
        return self.instant((q, v, a), (z, z_rate, z_acceleration))

    def whole(self, instant: Instant) -> tuple[FloatArray, FloatArray]:
        """Vectors of the tires with their reference nodes, and their rates, (n_w, n, 3)."""
        z = np.concatenate([instant.z, instant.hub.z], axis=1)
        return z, np.concatenate([instant.z_rate, instant.hub.v], axis=1)

    def axes(self, instant: Instant) -> FloatArray:
        """Axes of the hubs as columns, (n_w, 3, 3)."""
        return np.swapaxes(instant.hub.z[:, 1:], -1, -2)

    def tire_forces(self, instant: Instant) -> FloatArray:
        """Applied, internal and inertia forces of the tires, (n_w, n, 3); zero for free vectors in motion."""
        z, v = self.whole(instant)
        inertia = self.tires.mass @ np.concatenate([instant.z_acceleration, instant.hub.a], axis=1)
        return np.asarray(self.tires.force(z, v) + self._dead - inertia)

    def residual(self, instant: Instant, known: Known) -> Residual:
        """What is missing in the equations of motion at an instant."""
        forces = self.tire_forces(instant)
        hubs = np.ascontiguousarray(forces[:, -4:])
        h, M = self._bias(instant, hub_wrenches(instant.hub.z, hubs))
        tau, slopes = self.actions.torques(known, instant.v)
        return Residual(joints=tau - h - M @ instant.a, tires=forces[:, :-4], mass=M, hubs=hubs, slopes=slopes)

    def _bias(self, instant: Instant, hub: FloatArray) -> tuple[FloatArray, FloatArray]:
        wrenches = np.zeros((len(self.tree.body_links), 6))
        wrenches[self.wheels] = hub
        return bias_and_mass(self.tree, instant.motion, wrenches, self.gravity)

    def drive_power(self, instant: Instant, t: float) -> float:
        """Power that drives and efforts put in [W]."""
        known = self.known(t)
        drives = -self.residual(instant, known).joints[self.driven]
        return float(drives @ instant.v[self.driven] + self.actions.torques(known, instant.v)[0] @ instant.v)

    def row(self, instant: Instant, t: float) -> tuple[FloatArray, ...]:
        """A row of each array of `FlexibleMotion` at an instant, t [s]: positions to efforts, vectors, rates."""
        z, v = self.whole(instant)
        known = self.known(t)
        left = self.residual(instant, known)
        motors = self.actions.torques(known, instant.v)[0][self.actions.motors.places]
        efforts = np.concatenate([-left.joints[self.driven], motors])
        motion, wrench = instant.motion, hub_wrenches(instant.hub.z, left.hubs)
        bodies = motion.positions[:-1], motion.rotations[:-1], motion.velocities[:-1]
        return (*bodies, self._outputs(instant, z, v), wrench, efforts, z, v)

    def _outputs(self, instant: Instant, z: FloatArray, v: FloatArray) -> FloatArray:
        """Outputs as of brush tires, (n_w, 10): the undeformed wheel's depth and slip, the tires' own forces."""
        motion, numbers, result = instant.motion, self._gauge, self._gauged
        u = motion.velocities[self.wheels]
        R = np.ascontiguousarray(motion.rotations[self.wheels])
        hubs = HubMotions(
            np.ascontiguousarray(motion.positions[self.wheels]),
            R,
            np.ascontiguousarray(u[:, :3]),
            np.ascontiguousarray(u[:, 3:]),
        )
        brush_forces(hubs, np.zeros_like(result.rate), numbers[0], numbers[1], result, numbers[2])
        out, contacts = result.output.copy(), self.tires.contacts(z, v)
        up = contacts.patch_point - hubs.position
        forward = np.cross(up, R[:, :, 1])
        size = np.linalg.norm(forward, axis=1, keepdims=True)
        forward = np.where(size > 0.0, forward / np.where(size > 0.0, size, 1.0), R[:, :, 0])
        out[:, 1], out[:, 4:7] = contacts.load, contacts.patch_point
        out[:, 7] = np.sum(contacts.force * forward, axis=1)
        out[:, 8] = np.sum(contacts.force * R[:, :, 1], axis=1)
        return out


def node_jacobians(z: FloatArray, J: FloatArray) -> FloatArray:
    """Rates of the reference nodes' vectors by v, (n_w, 4, 3, n_v)."""
    D = np.empty((len(z), 4, 3, J.shape[-1]))
    D[:, 0] = J[:, :3]
    D[:, 1:] = np.cross(J[:, None, 3:], z[:, 1:, :, None], axis=2)
    return D


def joined(left: FloatArray, right: FloatArray) -> FloatArray:
    """Sum over wheels of left^T right, (n, m), of stacks (n_w, k, n) and (n_w, k, m)."""
    return np.asarray(left.reshape(-1, left.shape[-1]).T @ right.reshape(-1, right.shape[-1]))
