"""Rigid bodies, and frames fixed to them.

Verified by tests/unit/test_multibody_model.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.compiled import quaternion_of, rotation_matrix

__all__ = ["GROUND", "Frame", "RigidBody", "body", "rotation_to"]

FloatArray = NDArray[np.float64]

GROUND = "ground"
"""Name of the body that does not move; its frame is the world frame."""
_UNIT = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RigidBody:
    """One rigid body; its frame has its origin in the centre of mass.

    Attributes
    ----------
    name : unique in a model, not ``"ground"``
    mass : > 0 [kg]
    inertia : (3, 3) float, about the centre of mass in body axes, symmetric positive definite, no principal moment
        above the sum of the others [kg m^2]
    position : (3,) float, centre of mass in the world at the start [m]
    orientation : (4,) float, unit quaternion at the start, scalar first, body to world
    velocity : (3,) float, of the centre of mass at the start, world [m/s]
    angular_velocity : (3,) float, at the start, world [rad/s]

    Raises
    ------
    InputError
        For a mass or an inertia no body can have, or an orientation that is no unit quaternion.
    """

    name: str
    mass: float
    inertia: FloatArray
    position: FloatArray
    orientation: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray

    def __post_init__(self) -> None:
        if not self.name or self.name == GROUND:
            rule = "must be a word other than 'ground', which is always there"
            raise InputError("body name", repr(self.name), rule, "give the body a name of its own")
        if not (np.isfinite(self.mass) and self.mass > 0.0):
            rule, hint = "must be finite and > 0", "a part without mass belongs to the body it is fixed to"
            raise InputError(f"mass of body '{self.name}'", f"{self.mass:g} kg", rule, hint)
        self._check_inertia()
        for what, vector in (
            ("position", self.position),
            ("velocity", self.velocity),
            ("angular velocity", self.angular_velocity),
        ):
            if vector.shape != (3,) or not np.isfinite(vector).all():
                raise InputError(
                    f"{what} of body '{self.name}'", vector, "must be three finite numbers", "x, y, z in SI"
                )
        length = float(np.linalg.norm(self.orientation))
        if self.orientation.shape != (4,) or not abs(length - 1.0) < _UNIT:
            rule = "must be a unit quaternion, scalar first"
            raise InputError(f"orientation of body '{self.name}'", self.orientation, rule, "divide it by its length")

    def _check_inertia(self) -> None:
        what, J = f"inertia of body '{self.name}'", self.inertia
        if J.shape != (3, 3) or not np.isfinite(J).all() or not np.allclose(J, J.T, rtol=1e-12, atol=0.0):
            raise InputError(what, f"{J.tolist()} kg m^2", "must be a symmetric 3 x 3 matrix", "give three moments")
        moments = np.linalg.eigvalsh(J)
        if not moments[0] > 0.0:
            hint = "a rod needs a small moment about its axis too"
            raise InputError(what, f"{moments} kg m^2 (principal)", "must be > 0 about every axis", hint)
        if moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-9):
            rule = "no body has a moment above the sum of the other two"
            raise InputError(what, f"{moments} kg m^2 (principal)", rule, "check the units and the axes")

    @property
    def rotation(self) -> FloatArray:
        """R_wb at the start, (3, 3)."""
        R = np.empty((3, 3))
        rotation_matrix(self.orientation, R)
        return R


def body(
    name: str,
    mass: float,
    inertia: object,
    position: object = (0.0, 0.0, 0.0),
    *,
    rotation: object = None,
    velocity: object = (0.0, 0.0, 0.0),
    angular_velocity: object = (0.0, 0.0, 0.0),
) -> RigidBody:
    """Make a rigid body from plain numbers.

    Parameters
    ----------
    name, mass : see `RigidBody`
    inertia : three principal moments along the body axes, or a 3 x 3 matrix [kg m^2]
    position, velocity, angular_velocity : three numbers each, world [m, m/s, rad/s]
    rotation : (3, 3) rotation matrix body to world, or (4,) unit quaternion; body axes are the world's without it

    Raises
    ------
    InputError
        See `RigidBody`.
    """
    moments = np.array(inertia, dtype=np.float64)
    turned = np.array(np.eye(3) if rotation is None else rotation, dtype=np.float64)
    if turned.shape == (3, 3) and not _is_rotation(turned):
        rule, hint = "must be a right-handed rotation matrix", "give orthonormal columns, or a unit quaternion"
        raise InputError(f"rotation of body '{name}'", turned.tolist(), rule, hint)
    return RigidBody(
        name=name,
        mass=float(mass),
        inertia=np.diag(moments) if moments.shape == (3,) else moments,
        position=np.array(position, dtype=np.float64),
        orientation=quaternion_of(turned) if turned.shape == (3, 3) else turned,
        velocity=np.array(velocity, dtype=np.float64),
        angular_velocity=np.array(angular_velocity, dtype=np.float64),
    )


def _is_rotation(R: FloatArray) -> bool:
    return bool(np.allclose(R.T @ R, np.eye(3), rtol=0.0, atol=_UNIT) and np.linalg.det(R) > 0.0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """A frame fixed to a body.

    Attributes
    ----------
    position : (3,) float, origin from the body's centre of mass, body axes [m]; world for the ground
    rotation : (3, 3) float, takes the frame's axes to body axes
    """

    position: FloatArray
    rotation: FloatArray


def rotation_to(axis: FloatArray, reference: FloatArray | None = None) -> FloatArray:
    """Rotation (3, 3) whose third column is along ``axis`` (3,) and whose first lies towards ``reference`` (3,).

    Without a reference the first column is at right angles to the axis and to the world axis it is least aligned with.

    Raises
    ------
    InputError
        If the axis has no length, or the reference is along it.
    """
    length = float(np.linalg.norm(axis))
    if not (np.isfinite(length) and length > 0.0):
        raise InputError("joint axis", axis, "must have a direction", "give e.g. (0, 1, 0)")
    z = axis / length
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z) if reference is None else reference - (reference @ z) * z
    width = float(np.linalg.norm(x))
    if not width > 1e-9:
        raise InputError("second joint axis", reference, "must not be along the first", "give one at right angles")
    x = x / width
    return np.stack([x, np.cross(z, x), z], axis=1)
