"""A cart of three bodies on two flexible tires, one of them driven: small enough for tests of whole motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.terrain import Plane
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle, on_flexible_tires
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.joint import revolute
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion_law import SpeedTrapezoid
from rover_dynamics.vehicle.joint_actions import JointEffort
from rover_dynamics.vehicle.vehicle import Vehicle

__all__ = ["LAW", "TIRE", "cart"]

TIRE = build_tire(replace(thesis_preset(), quadrature=(3, 3, 2)))
LAW = ContactLaw(stiffness=1000.0, damping=5.0, friction=0.6, slip_velocity=0.1)
RADIUS = 0.1425


def cart(*, height: float = 0.0, ratio: float = 0.0, law: ContactLaw = LAW, speed: float = 0.5) -> FlexibleVehicle:
    """Frame with a wheel in front, driven, and one behind, turned by a torque; ``height`` above the ground."""
    z = RADIUS + height
    wheel = (0.05941, 0.08571, 0.05941)
    frame = body("frame", 14.0, (0.6, 0.8, 0.9), (0.0, 0.0, z + 0.05))
    front = body("front", 5.0, wheel, (0.4, 0.05, z))
    rear = body("rear", 5.0, wheel, (-0.3, -0.05, z))
    joints = (
        revolute("front axle", frame, front, at=(0.4, 0.05, z), axis=(0.0, 1.0, 0.0)),
        revolute("rear axle", frame, rear, at=(-0.3, -0.05, z), axis=(0.0, 1.0, 0.0)),
    )
    law_of_drive = SpeedTrapezoid(speed=speed / RADIUS, accelerates=0.1, decelerates=0.1, ends=np.inf)
    model = MultibodyModel(
        bodies=(frame, front, rear),
        joints=joints,
        drives=(Drive(joint="front axle", law=law_of_drive),),
        gravity=(0.0, 0.0, -3.711),
    )
    efforts = (JointEffort(joint="rear axle", effort=lambda t: 0.4),)
    vehicle = Vehicle(model=model, wheels=("front", "rear"), terrain=Plane(), efforts=efforts)
    tires = wheel_set(TIRE, Plane(), 2, law=law, damping_ratio=ratio)
    return on_flexible_tires(vehicle, tires, np.array([0.0, 0.3]))
