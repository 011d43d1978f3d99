"""Independent coordinates of a vehicle on flexible tires, integrated forward with error control (thesis 2.5.3).

Reference nodes and driven joints are eliminated, so that all coordinates left are independent: y holds the joints'
coordinates and velocities and the tires' free vectors with their rates. Any integrator of `multibody.motion` takes it.
Verified by tests/verification/test_flexible_formulations.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle
from rover_dynamics.multibody.compiled import quaternion_of
from rover_dynamics.multibody.formulation import Course
from rover_dynamics.multibody.state import State
from rover_dynamics.multibody.tree_kernels import coordinate_rates

__all__ = ["IndependentCoordinates"]

FloatArray = NDArray[np.float64]


class IndependentCoordinates:
    """First-order equations in independent coordinates.

    y : joint coordinates (n_q), joint velocities (n_v), free vectors and their rates (n_w, n_f, 3 each), flat

    Attributes
    ----------
    system : the equations of motion
    """

    def __init__(self, vehicle: FlexibleVehicle) -> None:
        self.system = FlexibleSystem(vehicle)
        self._splits = np.cumsum([int(self.system.tree.q_at[-1]), int(self.system.tree.v_at[-1])])

    def start(self) -> FloatArray:
        """See `multibody.formulation.Equations`; tires undeformed."""
        return self.packed(self.system.at_rest(0.0))

    def packed(self, instant: Instant) -> FloatArray:
        """y (N,) of an instant, e.g. of one that has settled."""
        return np.concatenate([instant.q, instant.v, instant.z.ravel(), instant.z_rate.ravel()])

    def instant(self, t: float, y: FloatArray) -> Instant:
        """Everything at t [s] and y (N,), accelerations included."""
        q, v, z, z_rate = self._parts(t, y)
        return self.system.accelerated(q, v, (z, z_rate), self.system.known(t))

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """See `multibody.formulation.Equations`."""
        now = self.instant(t, y)
        turning = coordinate_rates(self.system.tree, now.q, now.v, now.motion.frames)
        return np.concatenate([turning, now.a, now.z_rate.ravel(), now.z_acceleration.ravel()])

    def corrected(self, t: float, y: FloatArray) -> FloatArray:
        """See `multibody.formulation.Equations`: unit quaternions, driven joints by their laws."""
        q, v, z, z_rate = self._parts(t, y)
        n_q = len(q)
        joints = self.system.actions.coordinates.corrected(t, np.concatenate([q, v]))
        return np.concatenate([joints[:n_q], joints[n_q:], z.ravel(), z_rate.ravel()])

    def state(self, t: float, y: FloatArray) -> State:
        """See `multibody.formulation.Equations`."""
        motion = self.system.actions.coordinates.motion(t, y[: self._splits[1]])
        orientations = np.array([quaternion_of(R) for R in motion.rotations[:-1]])
        return State(positions=motion.positions[:-1], orientations=orientations, velocities=motion.velocities[:-1])

    def accepted(self, t: float, y: FloatArray, course: Course | None) -> None:
        """See `multibody.formulation.Equations`; no use is made of it."""

    def margin(self, t: float, y: FloatArray) -> float:
        """See `multibody.formulation.Equations`; trees have no singular positions."""
        return 1.0

    def vectors(self, t: float, y: FloatArray) -> FloatArray:
        """Vectors of all tires with their reference nodes, (n_w, n, 3)."""
        q, v, z, z_rate = self._parts(t, y)
        return self.system.whole(self.system.instant((q, v, np.zeros_like(v)), (z, z_rate, np.zeros_like(z))))[0]

    def _parts(self, t: float, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        q, v, rest = np.split(y, self._splits)
        q, v = q.copy(), v.copy()
        known = self.system.known(t)
        q[self.system.actions.driven_q], v[self.system.driven] = known.q, known.v
        z, z_rate = rest.reshape(2, self.system.tires.n_wheels, -1, 3)
        return q, v, z, z_rate
