"""Positions and velocities of all bodies of a model, in absolute coordinates.

Verified by tests/unit/test_multibody_model.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.body import RigidBody
from rover_dynamics.multibody.compiled import compiled, multiply_quaternions, rotation_matrix, rotation_quaternion

__all__ = ["State", "moved", "rotations", "start_state"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class State:
    """All bodies at one time.

    Attributes
    ----------
    positions : (n, 3) float, centres of mass, world [m]
    orientations : (n, 4) float, unit quaternions body to world, scalar first
    velocities : (n, 6) float, of the centre of mass and angular, world [m/s, rad/s]
    """

    positions: FloatArray
    orientations: FloatArray
    velocities: FloatArray


def start_state(bodies: tuple[RigidBody, ...]) -> State:
    """The bodies as they were given."""
    return State(
        positions=np.array([b.position for b in bodies]),
        orientations=np.array([b.orientation for b in bodies]),
        velocities=np.array([np.concatenate([b.velocity, b.angular_velocity]) for b in bodies]),
    )


@compiled
def rotations(orientations: FloatArray) -> FloatArray:
    """Rotation matrices body to world, (n, 3, 3), of quaternions, (n, 4)."""
    R = np.empty((len(orientations), 3, 3))
    for k in range(len(orientations)):
        rotation_matrix(orientations[k], R[k])
    return R


def moved(state: State, change: FloatArray) -> State:
    """The state after small displacements and rotations, (n, 6), world axes; velocities are kept."""
    return State(
        positions=state.positions + change[:, :3],
        orientations=_turned(state.orientations, np.ascontiguousarray(change[:, 3:])),
        velocities=state.velocities,
    )


@compiled
def _turned(orientations: FloatArray, turns: FloatArray) -> FloatArray:
    out, turn = np.empty_like(orientations), np.empty(4)
    for k in range(len(orientations)):
        rotation_quaternion(turns[k], turn)
        multiply_quaternions(turn, orientations[k], out[k])
        out[k] /= np.sqrt(np.sum(out[k] * out[k]))
    return out
