"""Andrews' squeezing mechanism: seven bodies, three loops, a spring and a motor.

Data: Test Set for IVP Solvers (problem "andrews"), also problem A03 of the IFToMM library of multibody benchmarks.
Angles are named as there. Verified by tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from contracts.published import published_table
from rover_dynamics.multibody.body import RigidBody, body
from rover_dynamics.multibody.force import HingeTorque, SpringDamper
from rover_dynamics.multibody.joint import Joint, revolute
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.state import State

__all__ = ["andrews_rates", "andrews_squeezer"]

FloatArray = NDArray[np.float64]

MASSES = (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498)
MOMENTS = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
A, B, C = np.array([-0.06934, -0.00227, 0.0]), np.array([-0.03635, 0.03273, 0.0]), np.array([0.014, 0.072, 0.0])
d, da, e, ea, zf, fa = 28e-3, 115e-4, 2e-2, 1421e-5, 2e-2, 1421e-5
rr, ra, sa, sb, sc, sd = 7e-3, 92e-5, 1874e-5, 1043e-5, 18e-3, 2e-2
ta, tb, u, ua, ub, zt = 2308e-5, 916e-5, 4e-2, 1228e-5, 449e-5, 4e-2
STIFFNESS, FREE_LENGTH, MOTOR = 4530.0, 0.07785, 0.033
Z = (0.0, 0.0, 1.0)


def andrews_squeezer(motor: float = MOTOR) -> MultibodyModel:
    """The mechanism at its start; the motor turns the first body with a constant torque [N m]."""
    table = published_table("andrews_squeezer")
    angles = dict(zip(table.text("name"), table["y0"], strict=True))
    K = _bodies(angles)
    return MultibodyModel(
        bodies=K,
        joints=_joints(K, angles),
        forces=(_spring(K[2], angles["gamma"]), HingeTorque(joint="O", torque=lambda _t, _angle, _rate: motor)),
        gravity=(0.0, 0.0, 0.0),
    )


def andrews_rates(state: State) -> dict[str, float]:
    """Rates of the seven angles [rad/s]."""
    w = state.velocities[:, 5]
    return {
        "beta": w[0],
        "Theta": w[1] - w[0],
        "gamma": w[2],
        "Phi": w[3] - w[4],
        "delta": w[4],
        "Omega": w[5] - w[6],
        "epsilon": w[6],
    }


def _bodies(angles: dict[str, float]) -> tuple[RigidBody, ...]:
    b, th, ga, ph, de, om, ep = (angles[k] for k in ("beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"))
    centres = (
        np.array([ra * cos(b), ra * sin(b), 0]),
        np.array([rr * cos(b) - da * cos(b + th), rr * sin(b) - da * sin(b + th), 0]),
        B + _along(ga, sb, -sa),
        A + np.array([zt * cos(de) + (e - ea) * sin(ph + de), zt * sin(de) - (e - ea) * cos(ph + de), 0]),
        A + _along(de, ta, tb),
        A + np.array([u * sin(ep) + (zf - fa) * cos(om + ep), -u * cos(ep) + (zf - fa) * sin(om + ep), 0]),
        A + np.array([ua * sin(ep) - ub * cos(ep), -ua * cos(ep) - ub * sin(ep), 0]),
    )
    turns = (b, b + th, ga, ph + de, de, om + ep, ep)
    parts = zip(MASSES, MOMENTS, centres, turns, strict=True)
    return tuple(
        body(f"K{k}", m, (J, J, J), c, rotation=_turned(angle)) for k, (m, J, c, angle) in enumerate(parts, start=1)
    )


def _joints(K: tuple[RigidBody, ...], angles: dict[str, float]) -> tuple[Joint, ...]:
    b, th, de, ep = (angles[k] for k in ("beta", "Theta", "delta", "epsilon"))
    R = np.array([rr * cos(b), rr * sin(b), 0])
    P = R - np.array([d * cos(b + th), d * sin(b + th), 0])
    E, F = A + _along(de, zt, 0.0), A + np.array([u * sin(ep), -u * cos(ep), 0])
    pins = (
        ("O", "ground", K[0], np.zeros(3)),
        ("R", K[0], K[1], R),
        ("B", "ground", K[2], B),
        ("P3", K[1], K[2], P),
        ("A5", "ground", K[4], A),
        ("E", K[4], K[3], E),
        ("P4", K[1], K[3], P),
        ("A7", "ground", K[6], A),
        ("F", K[6], K[5], F),
        ("P6", K[1], K[5], P),
    )
    return tuple(revolute(name, first, second, at=at, axis=Z) for name, first, second, at in pins)


def _spring(third: RigidBody, gamma: float) -> SpringDamper:
    """From a point of the third body to the fixed point C."""
    D = B + _along(gamma, sd, -sc)
    return SpringDamper(
        first=third.name,
        second="ground",
        first_point=_turned(gamma).T @ (D - third.position),
        second_point=C,
        stiffness=STIFFNESS,
        free_length=FREE_LENGTH,
    )


def _turned(angle: float) -> FloatArray:
    return np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])


def _along(angle: float, x: float, y: float) -> FloatArray:
    """A vector (x, y) in axes turned by an angle."""
    return np.asarray(_turned(angle) @ np.array([x, y, 0.0]))
