"""Forces on bodies: spring-dampers, torques in hinges, and a user's own functions.

Every force adds to the wrenches of the bodies: force, and moment about the centre of mass, both in world axes.
Verified by tests/unit/test_multibody_force.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.body import Frame
from rover_dynamics.multibody.model import BodyMotions, MultibodyModel

__all__ = ["AppliedForce", "HingeTorque", "SpringDamper"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class AppliedForce:
    """A force and a moment on one body by a user's function.

    Attributes
    ----------
    body : name of the body
    function : of time and motion of the body, position (3,), rotation (3, 3), velocity (6,); returns force and moment
        about the centre of mass, (6,), world [N, N m]
    """

    body: str
    function: Callable[[float, FloatArray, FloatArray, FloatArray], FloatArray]

    def add(self, t: float, motions: BodyMotions, model: MultibodyModel, wrenches: FloatArray) -> None:
        """See `Force`."""
        k = model.number(self.body)
        wrenches[k] += self.function(t, motions.positions[k], motions.rotations[k], motions.velocities[k])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpringDamper:
    """A spring with a damper between two points; it pushes and pulls along the line between them.

    Attributes
    ----------
    first, second : names of the bodies, one of them may be the ground
    first_point, second_point : (3,) from the centres of mass, body axes [m]; world for the ground
    stiffness, damping : >= 0 [N/m, N s/m]
    free_length : > 0 [m]
    """

    first: str
    second: str
    first_point: FloatArray
    second_point: FloatArray
    stiffness: float
    damping: float = 0.0
    free_length: float

    def __post_init__(self) -> None:
        name = f"spring between '{self.first}' and '{self.second}'"
        for what, value, unit in (("stiffness", self.stiffness, "N/m"), ("damping", self.damping, "N s/m")):
            if not (np.isfinite(value) and value >= 0.0):
                raise InputError(f"{what} of the {name}", f"{value:g} {unit}", "must be finite and >= 0", "change sign")
        if not (np.isfinite(self.free_length) and self.free_length > 0.0):
            hint = "give the length at which it carries nothing"
            raise InputError(f"free length of the {name}", f"{self.free_length:g} m", "must be > 0", hint)

    def add(self, t: float, motions: BodyMotions, model: MultibodyModel, wrenches: FloatArray) -> None:
        """See `Force`; InputError if the two points meet, where a line between them has no direction."""
        ends = (model.number(self.first), model.number(self.second))
        arms, points, rates = zip(
            *[_point(motions, k, s) for k, s in zip(ends, (self.first_point, self.second_point), strict=True)],
            strict=True,
        )
        line = points[1] - points[0]
        length = float(np.linalg.norm(line))
        if length < 1e-12:
            name = f"spring between '{self.first}' and '{self.second}'"
            raise InputError(f"length of the {name}", "0 m", "must be > 0", "move one of its points")
        direction = line / length
        rate = float((rates[1] - rates[0]) @ direction)
        pull = (self.stiffness * (length - self.free_length) + self.damping * rate) * direction
        for k, arm, force in zip(ends, arms, (pull, -pull), strict=True):
            if k >= 0:
                wrenches[k] += np.concatenate([force, np.cross(arm, force)])


def _point(motions: BodyMotions, k: int, s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Arm from the centre of mass, position and velocity of a point of body k; of the ground for k < 0."""
    if k < 0:
        return s, s, np.zeros(3)
    arm = motions.rotations[k] @ s
    velocity = motions.velocities[k]
    return arm, motions.positions[k] + arm, velocity[:3] + np.cross(velocity[3:], arm)


@dataclass(frozen=True, slots=True, kw_only=True)
class HingeTorque:
    """Torque about the axis of a hinge: on the second body, and its reaction on the first.

    Attributes
    ----------
    joint : name of a joint with an axis
    torque : function of time, relative angle and relative rate about the axis [s, rad, rad/s]; returns N m
    """

    joint: str
    torque: Callable[[float, float, float], float]

    def add(self, t: float, motions: BodyMotions, model: MultibodyModel, wrenches: FloatArray) -> None:
        """See `Force`."""
        joint = model.joint(self.joint)
        ends = (model.number(joint.first), model.number(joint.second))
        (A, w_first), (B, w_second) = (
            _turned(motions, k, frame) for k, frame in zip(ends, (joint.first_frame, joint.second_frame), strict=True)
        )
        axis, x = A[:, 2], B[:, 0]
        angle = float(np.arctan2(A[:, 1] @ x, A[:, 0] @ x))
        moment = self.torque(t, angle, float((w_second - w_first) @ axis)) * axis
        for k, about in zip(ends, (-moment, moment), strict=True):
            if k >= 0:
                wrenches[k, 3:] += about


def _turned(motions: BodyMotions, k: int, frame: Frame) -> tuple[FloatArray, FloatArray]:
    """Axes of a frame in the world, and its angular velocity."""
    if k < 0:
        return frame.rotation, np.zeros(3)
    return motions.rotations[k] @ frame.rotation, motions.velocities[k, 3:]
