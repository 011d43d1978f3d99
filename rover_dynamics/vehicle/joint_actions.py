"""What drives and efforts prescribe in the joints of a vehicle.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion_law import Hold, MotionLaw
from rover_dynamics.multibody.tree_arrays import TreeMotion
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.vehicle.drive_control import Motoring, Sight
from rover_dynamics.vehicle.implicit_method import Known
from rover_dynamics.vehicle.motor_kernels import add_motor_torques, motor_numbers

__all__ = ["JointActions", "JointEffort"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class JointEffort:
    """A torque about a hinge, or a force along a slider, as a function of time.

    Attributes
    ----------
    joint : name of a joint of the tree that no drive moves
    effort : of time [s]; on the joint's second body [N m, N]
    """

    joint: str
    effort: Callable[[float], float]


class JointActions:
    """A tree's joint velocities: those that follow laws, those that are free, and the efforts on these.

    Attributes
    ----------
    coordinates : of the tree
    free, driven : (n_f,), (n_d,) int, velocities that are unknown, and those that follow laws
    driven_q : (n_d,) int, coordinates of the driven velocities
    motors, motoring : numbers of the motors, and what is asked of them, or None without any

    Raises
    ------
    InputError
        If the bodies form loops; if every joint is driven; for an effort or a motor at a joint that is driven, or
        neither a hinge nor a slider.
    """

    def __init__(
        self,
        model: MultibodyModel,
        efforts: Sequence[JointEffort],
        motoring: Motoring | None = None,
    ) -> None:
        self._held, self._moving = _laws(model)
        self.coordinates = TreeCoordinates(model)
        if self.coordinates.spanning.cut:
            loops = ", ".join(self.coordinates.spanning.cut)
            raise InputError("joints of the vehicle", loops, "close loops", "integrate it by multibody.motion")
        tree, links = self.coordinates.tree, self.coordinates.spanning.joint_links
        at = {(named.joint, named.coordinate): named.link for named in links}
        moved = np.array([at[drive.joint, drive.coordinate] for drive in model.drives], dtype=np.int64)
        self.driven: IntArray = tree.v_at[moved]
        self.driven_q: IntArray = tree.q_at[moved]
        self.free: IntArray = np.setdiff1d(np.arange(tree.v_at[-1]), self.driven)
        if len(self.free) == 0:
            raise InputError("joints of the vehicle", len(moved), "are all driven", "leave one free to move")
        self._places: dict[str, list[int]] = {}
        for (joint, _), link in at.items():
            self._places.setdefault(joint, []).append(int(tree.v_at[link]))
        self._efforts = [(self._free_place("an effort", one.joint), one) for one in efforts]
        motors = () if motoring is None else motoring.motors
        places = [self._free_place("a motor", one.joint) for one in motors]
        self.motors = motor_numbers(np.array(places, dtype=np.int64), motors)
        self.motoring = motoring

    def _free_place(self, what: str, joint: str) -> int:
        """Velocity of a hinge or slider that is free."""
        places = self._places.get(joint, [])
        if len(places) != 1 or places[0] in self.driven:
            rule = "must be a hinge or a slider that no drive moves"
            raise InputError(f"joint of {what}", repr(joint), rule, "name another, or remove its drive")
        return places[0]

    def known(self, t: float) -> Known:
        """What is prescribed at t [s], by controllers as of the last step they saw."""
        q, v, a = self._held.copy()
        for law, rows in self._moving:
            q[rows], v[rows], a[rows] = law.at(t)
        tau = np.zeros(self.coordinates.tree.v_at[-1])
        for place, effort in self._efforts:
            tau[place] += effort.effort(t)
        asked = np.zeros((0, 3)) if self.motoring is None else self.motoring.asked(t)
        return Known(q, v, a, tau, asked)

    def torques(self, known: Known, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Efforts and motors' torques at joint velocities v, (n_v,) [N m, N], and -dT/dv of motors, (n_m,)."""
        tau, slopes = known.tau.copy(), np.zeros(len(self.motors.places))
        add_motor_torques(self.motors, known.asked, v, tau, slopes)
        return tau, slopes

    def saw(self, t: float, dt: float, v: FloatArray, motion: TreeMotion, wheels: tuple[IntArray, FloatArray]) -> None:
        """Show the motors' controller the end of a step, if there is one.

        Parameters
        ----------
        t, dt : end and length of the step [s]
        v : (n_v,) float, joint velocities [rad/s, m/s]
        motion : of the bodies
        wheels : rows of their bodies (n_w,), their loads (n_w,) [N]
        """
        if self.motoring is None:
            return
        bodies, loads = wheels
        velocities, axles = motion.velocities[bodies, :3], motion.rotations[bodies, :, 1]
        across = np.sum(velocities * axles, axis=1, keepdims=True) * axles
        hub_speeds = np.linalg.norm(velocities - across, axis=1)
        self.motoring.saw(Sight(t, dt, v[self.motors.places], loads.copy(), hub_speeds))

    def start(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Coordinates (n_q,) [rad, m, -], velocities (n_v,) [rad/s, m/s] of the model's start, corrected at t [s]."""
        n_q = int(self.coordinates.tree.q_at[-1])
        y = self.coordinates.corrected(t, self.coordinates.start())
        return y[:n_q], y[n_q:]


def _laws(model: MultibodyModel) -> tuple[FloatArray, list[tuple[MotionLaw, IntArray]]]:
    """Values, rates and accelerations of the held joints, (3, n_d), zero for others, and each law with its drives."""
    held = np.zeros((3, len(model.drives)))
    moving: dict[int, tuple[MotionLaw, list[int]]] = {}
    for row, drive in enumerate(model.drives):
        if isinstance(drive.law, Hold):
            held[0, row] = drive.law.value
        else:
            moving.setdefault(id(drive.law), (drive.law, []))[1].append(row)
    return held, [(law, np.array(rows, dtype=np.int64)) for law, rows in moving.values()]
