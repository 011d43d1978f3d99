"""A multibody model: bodies, joints, drives, gravity and forces, checked as a whole.

Verified by tests/unit/test_multibody_model.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.body import GROUND, RigidBody
from rover_dynamics.multibody.joint import Joint, JointKind
from rover_dynamics.multibody.motion_law import MotionLaw

__all__ = ["BodyMotions", "Coordinate", "Drive", "Force", "MultibodyModel"]

FloatArray = NDArray[np.float64]
Coordinate = Literal["angle", "distance"]
_DRIVABLE = {
    "angle": (JointKind.REVOLUTE, JointKind.CYLINDRICAL),
    "distance": (JointKind.PRISMATIC, JointKind.CYLINDRICAL),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """A joint coordinate that follows a function of time.

    Attributes
    ----------
    joint : name of a revolute, prismatic or cylindrical joint
    law : the coordinate in time, counted from the joint's frames, zero at the start for joints given in the world
    coordinate : which of the joint's motions
    """

    joint: str
    law: MotionLaw
    coordinate: Coordinate = "angle"


class BodyMotions(NamedTuple):
    """Motion of all bodies at one time, world axes.

    Attributes
    ----------
    positions : (n, 3) float, centres of mass [m]
    rotations : (n, 3, 3) float, body to world
    velocities : (n, 6) float, of the centre of mass and angular [m/s, rad/s]
    """

    positions: FloatArray
    rotations: FloatArray
    velocities: FloatArray


class Force(Protocol):
    """Anything that pulls on bodies."""

    def add(self, t: float, motions: BodyMotions, model: MultibodyModel, wrenches: FloatArray) -> None:
        """Add to the wrenches (n, 6) [N, N m] at time t [s]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MultibodyModel:
    """Everything the equations of motion need.

    Attributes
    ----------
    bodies : at least one, in the order of the state's rows
    joints, drives, forces : any number
    gravity : (3,) acceleration of free fall, world [m/s^2]

    Raises
    ------
    InputError
        For names given twice or missing, and for drives of motions a joint does not have.
    """

    bodies: tuple[RigidBody, ...]
    joints: tuple[Joint, ...] = ()
    drives: tuple[Drive, ...] = ()
    forces: tuple[Force, ...] = ()
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)

    def __post_init__(self) -> None:
        if not self.bodies:
            raise InputError("bodies of the model", "none", "must be at least one", "add a body")
        _once("body", [b.name for b in self.bodies])
        _once("joint", [j.name for j in self.joints])
        _once("drive of joint", [f"{d.joint}' ({d.coordinate}) '" for d in self.drives])
        for joint in self.joints:
            for end in (joint.first, joint.second):
                if end != GROUND and end not in self.numbers:
                    raise _unknown(f"joint '{joint.name}'", "body", end, list(self.numbers))
        joints = {joint.name: joint for joint in self.joints}
        for drive in self.drives:
            if drive.joint not in joints:
                raise _unknown("drive", "joint", drive.joint, list(joints))
            kind = joints[drive.joint].kind
            if kind not in _DRIVABLE[drive.coordinate]:
                rule = f"{kind.value} joint has no {drive.coordinate} of its own"
                raise InputError(f"drive of joint '{drive.joint}'", drive.coordinate, rule, "drive another joint")

    @cached_property
    def numbers(self) -> dict[str, int]:
        """Row of each body in the state; the ground has none."""
        return {b.name: k for k, b in enumerate(self.bodies)}

    def number(self, name: str) -> int:
        """Row of a body in the state, -1 for the ground.

        Raises
        ------
        InputError
            For a name the model does not have.
        """
        if name != GROUND and name not in self.numbers:
            raise _unknown("model", "body", name, list(self.numbers))
        return -1 if name == GROUND else self.numbers[name]

    def joint(self, name: str) -> Joint:
        """Joint of a name; InputError if there is none."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise _unknown("model", "joint", name, [joint.name for joint in self.joints])


def _once(what: str, names: Sequence[str]) -> None:
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"{what} '{twice[0]}'", f"{names.count(twice[0])} times", "must be there once", "rename one")


def _unknown(where: str, what: str, name: str, known: list[str]) -> InputError:
    return InputError(f"{what} named in {where}", repr(name), "is not in the model", f"it has: {', '.join(known)}")
