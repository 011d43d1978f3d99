"""Joints: which relative motions of two frames they lock, and how a user states them in world coordinates.

A joint holds the second body's frame to the first body's. Its axis is z of both frames; a universal joint turns about z
of the first and x of the second, which stay at right angles; a planar joint's z is the plane's normal.
Verified by tests/unit/test_multibody_constraints.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.body import GROUND, Frame, RigidBody, rotation_to

__all__ = [
    "LOCKED",
    "Joint",
    "JointKind",
    "cylindrical",
    "fixed",
    "planar",
    "prismatic",
    "revolute",
    "spherical",
    "universal",
]

FloatArray = NDArray[np.float64]
Numbers = tuple[float, float, float] | FloatArray
End = RigidBody | str


class JointKind(Enum):
    """The lower pairs, a universal joint, and a weld."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    CYLINDRICAL = "cylindrical"
    SPHERICAL = "spherical"
    UNIVERSAL = "universal"
    PLANAR = "planar"


@dataclass(frozen=True, slots=True, kw_only=True)
class Locked:
    """What a joint locks.

    Attributes
    ----------
    translations : axes of the first frame along which the origins coincide
    right_angles : pairs (i, j): axis i of the first frame stays at right angles to axis j of the second
    """

    translations: tuple[int, ...]
    right_angles: tuple[tuple[int, int], ...]


_NO_TURN, _ONE_AXIS = ((0, 1), (1, 2), (2, 0)), ((0, 2), (1, 2))
LOCKED: Mapping[JointKind, Locked] = MappingProxyType(
    {
        JointKind.FIXED: Locked(translations=(0, 1, 2), right_angles=_NO_TURN),
        JointKind.REVOLUTE: Locked(translations=(0, 1, 2), right_angles=_ONE_AXIS),
        JointKind.PRISMATIC: Locked(translations=(0, 1), right_angles=_NO_TURN),
        JointKind.CYLINDRICAL: Locked(translations=(0, 1), right_angles=_ONE_AXIS),
        JointKind.SPHERICAL: Locked(translations=(0, 1, 2), right_angles=()),
        JointKind.UNIVERSAL: Locked(translations=(0, 1, 2), right_angles=((2, 0),)),
        JointKind.PLANAR: Locked(translations=(2,), right_angles=_ONE_AXIS),
    }
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Joint:
    """One joint between two bodies.

    Attributes
    ----------
    name : unique in a model
    kind : which relative motions it locks
    first, second : names of the bodies, one of them may be the ground
    first_frame, second_frame : the frames it holds together, fixed to the two bodies

    Raises
    ------
    InputError
        For a joint between a body and itself.
    """

    name: str
    kind: JointKind
    first: str
    second: str
    first_frame: Frame
    second_frame: Frame

    def __post_init__(self) -> None:
        if self.first == self.second:
            value, rule = f"'{self.first}' and '{self.second}'", "must join two different bodies"
            raise InputError(f"joint '{self.name}'", value, rule, "name another body, or the ground")


def _joint(name: str, kind: JointKind, first: End, second: End, at: Numbers, R: FloatArray) -> Joint:
    frames = [_on(end, np.asarray(at, dtype=np.float64), R) for end in (first, second)]
    names = [end if isinstance(end, str) else end.name for end in (first, second)]
    return Joint(name=name, kind=kind, first=names[0], second=names[1], first_frame=frames[0], second_frame=frames[1])


def _on(end: End, at: FloatArray, R: FloatArray) -> Frame:
    """A frame of the world, fixed to a body as it stands at the start."""
    if isinstance(end, str):
        if end != GROUND:
            rule = "must be a body or the word 'ground'"
            raise InputError("end of a joint", repr(end), rule, "give the body itself, not its name")
        return Frame(position=at, rotation=R)
    R_bw = end.rotation.T
    return Frame(position=R_bw @ (at - end.position), rotation=R_bw @ R)


def fixed(name: str, first: End, second: End, *, at: Numbers = (0.0, 0.0, 0.0)) -> Joint:
    """Weld two bodies as they stand at the start; ``at`` is the point its reaction is given for, world [m]."""
    return _joint(name, JointKind.FIXED, first, second, at, np.eye(3))


def revolute(
    name: str, first: End, second: End, *, at: Numbers, axis: Numbers, reference: Numbers | None = None
) -> Joint:
    """Hinge through the point ``at`` [m] along ``axis``, both in the world as the bodies stand at the start.

    The angle of the second body is counted about the axis, from zero at the start. ``reference`` turns both frames' x.
    """
    return _joint(name, JointKind.REVOLUTE, first, second, at, _turned(axis, reference))


def prismatic(name: str, first: End, second: End, *, at: Numbers, axis: Numbers) -> Joint:
    """Slider along ``axis``, without rotation; the distance is zero at the start."""
    return _joint(name, JointKind.PRISMATIC, first, second, at, _turned(axis))


def cylindrical(name: str, first: End, second: End, *, at: Numbers, axis: Numbers) -> Joint:
    """Slider along ``axis`` that may also turn about it."""
    return _joint(name, JointKind.CYLINDRICAL, first, second, at, _turned(axis))


def spherical(name: str, first: End, second: End, *, at: Numbers) -> Joint:
    """Ball joint in the point ``at``."""
    return _joint(name, JointKind.SPHERICAL, first, second, at, np.eye(3))


def universal(name: str, first: End, second: End, *, at: Numbers, axis: Numbers, second_axis: Numbers) -> Joint:
    """Cross joint: ``axis`` is fixed to the first body, ``second_axis``, at right angles to it, to the second.

    Raises
    ------
    InputError
        If the axes are not at right angles.
    """
    z, x = (np.asarray(a, dtype=np.float64) for a in (axis, second_axis))
    if not abs(float(z @ x)) < 1e-9 * float(np.linalg.norm(z) * np.linalg.norm(x)):
        raise InputError(f"axes of joint '{name}'", f"{z} and {x}", "must be at right angles", "turn one of them")
    return _joint(name, JointKind.UNIVERSAL, first, second, at, rotation_to(z, x))


def planar(name: str, first: End, second: End, *, at: Numbers, normal: Numbers) -> Joint:
    """Keep a point of the second body in a plane of the first, and the bodies parallel to it."""
    return _joint(name, JointKind.PLANAR, first, second, at, _turned(normal))


def _turned(axis: Numbers, reference: Numbers | None = None) -> FloatArray:
    towards = None if reference is None else np.asarray(reference, dtype=np.float64)
    return rotation_to(np.asarray(axis, dtype=np.float64), towards)
