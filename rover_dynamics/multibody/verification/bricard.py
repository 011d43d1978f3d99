"""Bricard's mechanism, problem A04 of the IFToMM library of multibody benchmarks: one loop, one redundant equation.

Five rods of 1 kg and 1 m (section 0.1 m square) and the ground are the sides of a closed chain of six hinges whose axes
stand at right angles to both sides they join. Counted, six bodies and six hinges have no freedom left; the mechanism
has one in each of its positions, so that one of its equations always follows from the others, but not always the same
one. Verified by tests/verification/test_multibody_bricard.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.body import RigidBody, body
from rover_dynamics.multibody.joint import revolute
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.state import State, rotations

__all__ = ["bricard", "hinges_of_bricard"]

FloatArray = NDArray[np.float64]

X, Y, Z = np.eye(3)
_CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], dtype=np.float64)
_AXES = (Y, Z, X, Y, Z, X)
_LONG, _ACROSS = (0.1**2 + 0.1**2) / 12.0, (1.0 + 0.1**2) / 12.0


def bricard() -> MultibodyModel:
    """The mechanism at rest, weight along -y."""
    along = np.diff(_CORNERS, axis=0)
    middles = 0.5 * (_CORNERS[:-1] + _CORNERS[1:])
    rods = tuple(
        body(f"rod {k + 1}", 1.0, tuple(np.where(np.abs(side) > 0.5, _LONG, _ACROSS)), tuple(middle))
        for k, (side, middle) in enumerate(zip(along, middles, strict=True))
    )
    sides: list[RigidBody | str] = ["ground", *rods, "ground"]
    joints = tuple(
        revolute(f"hinge {k + 1}", sides[k], sides[k + 1], at=tuple(_CORNERS[k]), axis=tuple(_AXES[k]))
        for k in range(6)
    )
    return MultibodyModel(bodies=rods, joints=joints, gravity=(0.0, -9.81, 0.0))


def hinges_of_bricard(state: State) -> FloatArray:
    """Hinges 2 to 5, (4, 3) [m]: the far ends of the first four rods."""
    half = 0.5 * np.diff(_CORNERS, axis=0)[:4]
    return np.asarray(state.positions[:4] + np.einsum("nij,nj->ni", rotations(state.orientations)[:4], half))
