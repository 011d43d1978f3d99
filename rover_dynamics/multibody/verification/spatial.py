"""Spatial models with every kind of joint, with drives, and with loops; no closed form is known for their motions.

Verified by tests/verification/test_multibody_formulations.py: three formulations agree on them.
"""

from __future__ import annotations

import numpy as np

from rover_dynamics.multibody.body import RigidBody, body
from rover_dynamics.multibody.force import HingeTorque, SpringDamper
from rover_dynamics.multibody.joint import cylindrical, fixed, planar, prismatic, revolute, spherical, universal
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion_law import Turn

__all__ = ["every_joint", "spatial_loops"]

Z = (0.0, 0.0, 1.0)


def every_joint(*, ball_at_the_end: bool = True) -> MultibodyModel:
    """A chain with all kinds of joint, some given from the second body, two of them driven."""
    rng, moments = np.random.default_rng(3), (0.1, 0.2, 0.15)
    a, b, c, d, e, f, g, h = (body(n, 1.0 + 0.3 * k, moments, rng.normal(size=3)) for k, n in enumerate("abcdefgh"))
    end = {"at": (0.3, 0.3, 0.3)}
    joints = (
        revolute("base", "ground", a, at=(0, 0, 0), axis=(0, 1, 0.2)),
        universal("cross", b, a, at=(0.5, 0, 0), axis=(0, 0, 1), second_axis=(1, 1, 0)),
        cylindrical("tube", c, b, at=(1, 0, 0), axis=(1, 0, 1)),
        spherical("ball", c, d, at=(1, 1, 0)),
        planar("plane", d, e, at=(1, 1, 1), normal=(0, 1, 1)),
        prismatic("slide", f, e, at=(1, 2, 0), axis=(1, 0, 0)),
        fixed("weld", f, g),
        spherical("end", h, g, **end) if ball_at_the_end else revolute("end", h, g, axis=(0, 1, 0), **end),
    )
    drives = (
        Drive(joint="base", law=Turn(end=1.0, lasts=1.0)),
        Drive(joint="tube", law=Turn(end=0.5, lasts=0.7), coordinate="distance"),
    )
    spring = SpringDamper(
        first="ground",
        second="h",
        first_point=np.array([2.0, 0, 0]),
        second_point=np.array([0.1, 0, 0]),
        stiffness=20.0,
        damping=1.0,
        free_length=0.5,
    )
    return MultibodyModel(bodies=(a, b, c, d, e, f, g, h), joints=joints, drives=drives, forces=(spring,))


def spatial_loops() -> MultibodyModel:
    """A spatial four-bar (hinges, ball, cross) and, on its crank, a driven plane four-bar with redundant equations."""
    J = (0.02, 0.03, 0.025)
    crank, rod, rocker = body("crank", 1.0, J, (0.1, 0, 0)), body("rod", 1.0, J, (0.5, 0.2, 0.2)), _rocker(J)
    left, top, right = (
        body(n, 0.5, J, at) for n, at in (("l", (0, 0.1, 1)), ("t", (0.2, 0.2, 1)), ("r", (0.4, 0.1, 1)))
    )
    joints = (
        revolute("crank", "ground", crank, at=(0, 0, 0), axis=(0, 0.1, 1)),
        spherical("ball", crank, rod, at=(0.2, 0, 0)),
        universal("cross", rod, rocker, at=(0.8, 0.4, 0.4), axis=(0, 1, 0), second_axis=(0, 0, 1)),
        revolute("rocker", "ground", rocker, at=(0.8, 0.4, 0.0), axis=(1, 0, 0)),
        revolute("left", "ground", left, at=(0, 0, 1), axis=Z),
        revolute("upper left", left, top, at=(0, 0.2, 1), axis=Z),
        revolute("upper right", top, right, at=(0.4, 0.2, 1), axis=Z),
        revolute("right", "ground", right, at=(0.4, 0, 1), axis=Z),
    )
    drives = (Drive(joint="upper right", law=Turn(end=0.6, lasts=0.5)),)
    motor = HingeTorque(joint="crank", torque=lambda t, _angle, rate: 0.5 * np.cos(5.0 * t) - 0.05 * rate)
    bodies = (crank, rod, rocker, left, top, right)
    return MultibodyModel(bodies=bodies, joints=joints, drives=drives, forces=(motor,))


def _rocker(J: tuple[float, float, float]) -> RigidBody:
    return body("rocker", 1.0, J, (0.8, 0.4, 0.2))
