"""Reaction forces of joints and efforts of drives.

Of equations that follow from the others, a formulation leaves some out and gives them no load: in a joint of such a
loop only the sum over the loop is known, and another choice shares it otherwise. Verified by
tests/verification/test_multibody_reactions.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.joint import Joint
from rover_dynamics.multibody.model import MultibodyModel

__all__ = ["Reactions", "at_joint_frame"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reactions:
    """What joints transmit at one time, drives included, forces such as a `HingeTorque` not.

    Attributes
    ----------
    joints : names, in the model's order
    wrenches : (n_j, 6) float, force, and moment about the origin of the second body's joint frame, that each joint
        exerts on its second body, world axes [N, N m]; on the first body acts the opposite
    efforts : (n_d,) float, of each drive: the moment about the axis, or the force along it, on the second body
        [N m, N]
    """

    joints: tuple[str, ...]
    wrenches: FloatArray
    efforts: FloatArray

    def of(self, joint: str) -> FloatArray:
        """Wrench of one joint, (6,); InputError for a name the model does not have."""
        if joint not in self.joints:
            raise InputError("joint of a reaction", repr(joint), "is not in the model", f"it has: {self.joints}")
        return np.asarray(self.wrenches[self.joints.index(joint)])


def at_joint_frame(model: MultibodyModel, joint: Joint, R: FloatArray, wrench: FloatArray) -> FloatArray:
    """A wrench about the second body's centre of mass (the world's origin for the ground) at the joint's frame, (6,).

    Parameters
    ----------
    R : (n + 1, 3, 3) float, rotations of the bodies; the last is the ground's
    wrench : (6,) float, world axes [N, N m]
    """
    arm = R[model.number(joint.second)] @ joint.second_frame.position
    return np.concatenate([wrench[:3], wrench[3:] - np.cross(arm, wrench[:3])])
