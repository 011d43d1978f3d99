"""A vehicle whose wheels carry flexible tires with a mass of their own.

Verified by tests/verification/test_flexible_motion.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.nodal_tires import NodalTires
from rover_dynamics.multibody.body import RigidBody
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion

__all__ = ["FlexibleMotion", "FlexibleVehicle", "on_flexible_tires", "rigid_tire_mass", "rigid_vectors"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlexibleVehicle:
    """Rigid bodies, and the tires on its wheels.

    Attributes
    ----------
    vehicle : bodies, wheels and ground; its wheels' bodies hold what the tires do not, see `on_flexible_tires`. Its
        brush tire only serves to measure deflections: the depth to which the undeformed wheel stands in the ground
    tires : one for each wheel, on the same ground
    mounts : (n_w, 3, 3) float, from each tire's frame to that of its wheel's body

    Raises
    ------
    InputError
        If there is not one tire for each wheel.
    """

    vehicle: Vehicle
    tires: NodalTires
    mounts: FloatArray

    def __post_init__(self) -> None:
        wheels = len(self.vehicle.wheels)
        if self.tires.n_wheels != wheels or self.mounts.shape != (wheels, 3, 3):
            value = f"{self.tires.n_wheels} tires, mounts {self.mounts.shape}"
            raise InputError("flexible tires", value, f"need one for each of {wheels} wheels", "build as many")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlexibleMotion(VehicleMotion):
    """A motion at the times asked for, with the tires' shapes.

    ``tires`` is laid out as that of brush tires: deflection is the depth of the undeformed wheel in the ground (the
    hub's drop), slip that of the undeformed wheel; load, patch point, tractive and lateral force are the tires' own.

    Attributes
    ----------
    vectors, rates : (n, n_w, n_vectors, 3) float, of the tires [m, -] and [m/s, 1/s]
    linearisations : matrices made for Newton's method
    """

    vectors: FloatArray
    rates: FloatArray
    linearisations: int = 0


def rigid_tire_mass(tires: NodalTires) -> FloatArray:
    """Mass matrix (4, 4) of one undeformed tire in the vectors of its reference node [kg, kg m, kg m^2]."""
    X = rigid_vectors(tires)
    return np.asarray(X.T @ tires.mass @ X)


def rigid_vectors(tires: NodalTires) -> FloatArray:
    """X (n, 4): the vectors of an undeformed tire are X times those of its reference node, and so are their rates."""
    X = np.zeros((len(tires.mass), 4))
    X[tires.position_rows, 0] = 1.0
    X[:, 1:] = tires.reference()
    return X


def on_flexible_tires(vehicle: Vehicle, tires: NodalTires, angles: FloatArray | None = None) -> FlexibleVehicle:
    """The vehicle with the tires' mass and inertia taken out of its wheels' bodies, so that neither counts twice.

    Parameters
    ----------
    vehicle : with whole wheels
    tires : one for each of them
    angles : (n_w,) float [rad], by which each tire is turned about the axle on its wheel, positive rolls forward

    Raises
    ------
    InputError
        If a tire has more mass or inertia than its wheel.
    """
    J = rigid_tire_mass(tires)
    inertia = np.trace(J[1:, 1:]) * np.eye(3) - J[1:, 1:]
    turned = np.zeros(len(vehicle.wheels)) if angles is None else np.asarray(angles, dtype=np.float64)
    mounts = np.array([_about_axle(angle) for angle in turned])
    bodies = list(vehicle.model.bodies)
    for wheel, mount in zip(vehicle.wheels, mounts, strict=True):
        k = vehicle.model.number(wheel)
        bodies[k] = _without(bodies[k], float(J[0, 0]), mount @ inertia @ mount.T)
    model = replace(vehicle.model, bodies=tuple(bodies))
    return FlexibleVehicle(vehicle=replace(vehicle, model=model), tires=tires, mounts=mounts)


def _about_axle(angle: float) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _without(body: RigidBody, mass: float, inertia: FloatArray) -> RigidBody:
    """A wheel's body less its tire; both have their centre of mass in the hub's."""
    left = np.asarray(body.inertia) - 0.5 * (inertia + inertia.T)
    if mass >= body.mass or np.linalg.eigvalsh(left)[0] <= 0.0:
        found = f"{body.mass:g} kg, least inertia left {np.linalg.eigvalsh(left)[0]:.3g} kg m^2"
        rule = f"must hold more than its tire of {mass:.4g} kg"
        raise InputError(f"wheel {body.name}", found, rule, "make the tire lighter or the wheel heavier")
    return replace(body, mass=body.mass - mass, inertia=left)
