"""A rover as numbers: bodies, pivots and legs, mirrored rows made two.

Verified by tests/unit/test_rover_file.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rover_dynamics.vehicle.drive_control import DriveControl
from rover_dynamics.vehicle.motors import Motor

__all__ = ["SIDES", "BodyRow", "Leg", "PivotRow", "RoverDesign", "WheelDrive"]

SIDES = {"left": 1.0, "right": -1.0}
"""Sign of y on each side."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyRow:
    """One body: mass [kg], principal inertia in vehicle axes [kg m^2], centre of mass [m], z above the wheel's axle."""

    name: str
    mass: float
    inertia: tuple[float, float, float]
    position: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class PivotRow:
    """A passive hinge between two bodies; position [m], z above the wheel's axle."""

    name: str
    first: str
    second: str
    position: tuple[float, float, float]
    axis: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """Deployment, steering and drive hinge of one wheel with the bodies between them; places as in `PivotRow`.

    Attributes
    ----------
    name : such as ``"front_left"``
    carrier : body it hangs on
    deployment, steering, drive : points of the three axes
    """

    name: str
    carrier: str
    deployment: tuple[float, float, float]
    steering: tuple[float, float, float]
    drive: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelDrive:
    """The motor of every wheel, and what tells it what to do."""

    motor: Motor = field(default_factory=Motor)
    control: DriveControl = field(default_factory=DriveControl)


@dataclass(frozen=True, slots=True, kw_only=True)
class RoverDesign:
    """A rover as numbers; mirrored rows have become two.

    Attributes
    ----------
    name, gravity : [m/s^2]
    wheel_radius, wheel_width : [m]
    bodies, pivots, legs : see there
    leg_bodies : arm, spindle and wheel of every leg; x and y of their positions are the drive's, z counts from the axle
    drive : the wheels' motors, or None for drives that follow their speed whatever torque that takes
    warnings : what is unusual in the file, a line each
    """

    name: str
    gravity: float
    wheel_radius: float
    wheel_width: float
    bodies: tuple[BodyRow, ...]
    pivots: tuple[PivotRow, ...]
    legs: tuple[Leg, ...]
    leg_bodies: tuple[BodyRow, ...]
    drive: WheelDrive | None = None
    warnings: tuple[str, ...] = field(default=(), repr=False)

    @property
    def mass(self) -> float:
        """Of all bodies [kg]."""
        return sum(body.mass for body in self.bodies) + len(self.legs) * sum(body.mass for body in self.leg_bodies)

    @property
    def static_load(self) -> float:
        """Weight divided by the number of wheels [N]."""
        return self.mass * self.gravity / len(self.legs)
