"""Pendulum, N-four-bar and slider-crank, and measures of motions.

Pendulum and N-four-bar: problems A01 and A02 of the IFToMM library of multibody benchmarks, numbers in
contracts/published. Verified by tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.body import RigidBody, body
from rover_dynamics.multibody.constraints import build_constraints
from rover_dynamics.multibody.joint import Joint, prismatic, revolute
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion_law import MotionLaw
from rover_dynamics.multibody.state import State, rotations

__all__ = ["constraint_defects", "mechanical_energy", "n_four_bar", "pendulum", "slider_crank", "tip_of_four_bar"]

FloatArray = NDArray[np.float64]

Z = (0.0, 0.0, 1.0)
DOWN = (0.0, -9.81, 0.0)
ROD = 1.0 / 12.0
"""Moment of a rod of 1 kg and 1 m about its centre [kg m^2]."""
SLENDER = 1e-3 * ROD


def pendulum() -> MultibodyModel:
    """A point of 1 kg on an arm of 1 m, at rest at (-1, 0)."""
    bob = body("bob", 1.0, (1e-12, 1e-12, 1e-12), (-1.0, 0.0, 0.0))
    return MultibodyModel(bodies=(bob,), joints=(revolute("pin", "ground", bob, at=(0, 0, 0), axis=Z),), gravity=DOWN)


def n_four_bar(windows: int) -> MultibodyModel:
    """N windows of rods of 1 m and 1 kg, all cranks upright, their ends moving with 1 m/s along x."""
    cranks = [
        body(f"crank {k}", 1.0, (ROD, SLENDER, ROD), (k, 0.5, 0), velocity=(0.5, 0, 0), angular_velocity=(0, 0, -1.0))
        for k in range(windows + 1)
    ]
    couplers = [
        body(f"coupler {k}", 1.0, (SLENDER, ROD, ROD), (k + 0.5, 1, 0), velocity=(1.0, 0, 0)) for k in range(windows)
    ]
    joints: list[Joint] = [
        revolute(f"base {k}", "ground", crank, at=(k, 0, 0), axis=Z) for k, crank in enumerate(cranks)
    ]
    for k, coupler in enumerate(couplers):
        joints.append(revolute(f"left {k}", cranks[k], coupler, at=(k, 1, 0), axis=Z))
        joints.append(revolute(f"right {k}", coupler, cranks[k + 1], at=(k + 1, 1, 0), axis=Z))
    return MultibodyModel(bodies=tuple(cranks + couplers), joints=tuple(joints), gravity=DOWN)


def tip_of_four_bar(state: State) -> FloatArray:
    """Point B0, the upper end of the first crank, (3,) [m]."""
    return np.asarray(state.positions[0] + rotations(state.orientations)[0] @ np.array([0.0, 0.5, 0.0]))


def slider_crank(law: MotionLaw | None = None, *, gravity: tuple[float, float, float] = DOWN) -> MultibodyModel:
    """Crank of 0.1 m, rod of 0.3 m, piston along x; crank and rod start along x. A law [rad] drives the crank.

    ``gravity`` is the acceleration of free fall, world [m/s^2].
    """
    crank: RigidBody = body("crank", 1.0, (1e-3, 1e-3, 1e-3), (0.05, 0, 0))
    rod = body("rod", 0.5, (1e-3, 4e-3, 4e-3), (0.25, 0, 0))
    piston = body("piston", 2.0, (1e-3, 1e-3, 1e-3), (0.4, 0, 0))
    joints = (
        revolute("main bearing", "ground", crank, at=(0, 0, 0), axis=Z),
        revolute("crank pin", crank, rod, at=(0.1, 0, 0), axis=Z),
        revolute("piston pin", rod, piston, at=(0.4, 0, 0), axis=Z),
        prismatic("cylinder", "ground", piston, at=(0.4, 0, 0), axis=(1, 0, 0)),
    )
    drives = () if law is None else (Drive(joint="main bearing", law=law),)
    return MultibodyModel(bodies=(crank, rod, piston), joints=joints, drives=drives, gravity=gravity)


def mechanical_energy(model: MultibodyModel, state: State) -> float:
    """Kinetic energy and that of the weight, zero at the world's origin [J]."""
    m, v, w = np.array([b.mass for b in model.bodies]), state.velocities[:, :3], state.velocities[:, 3:]
    R = rotations(state.orientations)
    w_b = np.einsum("nji,nj->ni", R, w)
    kinetic = 0.5 * np.sum(m * np.sum(v * v, axis=1))
    turning = 0.5 * np.einsum("ni,nij,nj->", w_b, np.array([b.inertia for b in model.bodies]), w_b)
    return float(kinetic + turning - np.sum(m * (state.positions @ np.array(model.gravity))))


def constraint_defects(model: MultibodyModel, t: float, state: State) -> tuple[float, float]:
    """Largest defect of all constraint equations, redundant ones too: of the positions, and of the velocities [SI]."""
    values = build_constraints(model).at(t, state)
    rates = values.jacobian @ state.velocities.ravel() - values.rates
    return float(np.max(np.abs(values.defects), initial=0.0)), float(np.max(np.abs(rates), initial=0.0))
