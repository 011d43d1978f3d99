"""A tree of links and bodies, and its motion, as the arrays that compiled loops read.

Verified by tests/unit/test_multibody_tree.py.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled

__all__ = ["LinkKind", "Tree", "TreeMotion", "tree_memory"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class LinkKind(IntEnum):
    """How a link moves against its parent; it has 1, 1, 4, 7 coordinates and 1, 1, 3, 6 velocities."""

    REVOLUTE = 0
    PRISMATIC = 1
    SPHERICAL = 2
    FREE = 3


class Tree(NamedTuple):
    """A tree of links and the bodies on them; a parent comes before its children.

    Attributes
    ----------
    parents : (n_l,) int, -1 for the ground
    kinds : (n_l,) int, see `LinkKind`
    q_at, v_at : (n_l + 1,) int, first coordinate and first velocity of each link
    offsets, turns : (n_l, 3), (n_l, 3, 3) float, joint frame in the parent's frame [m]
    axes : (n_l, 3) float, unit axis in the joint frame
    body_links : (n_b,) int, the link that carries each body, -1 for the ground
    body_points, body_turns : (n_b, 3), (n_b, 3, 3) float, body frame in its link's frame [m]
    masses, inertias : (n_b,), (n_b, 3, 3) float, about the centre of mass in body axes [kg, kg m^2]
    """

    parents: IntArray
    kinds: IntArray
    q_at: IntArray
    v_at: IntArray
    offsets: FloatArray
    turns: FloatArray
    axes: FloatArray
    body_links: IntArray
    body_points: FloatArray
    body_turns: FloatArray
    masses: FloatArray
    inertias: FloatArray


class TreeMotion(NamedTuple):
    """Where links and bodies are and how they move, all in world axes.

    Attributes
    ----------
    S : (n_v, 6) float, spatial velocity for a unit of each joint velocity
    V, A : (n_l + 1, 6) float, spatial velocity, and spatial acceleration for joint accelerations of zero, of each
        link; the last row is the ground's
    positions, rotations, velocities : (n_b + 1, 3), (n_b + 1, 3, 3), (n_b + 1, 6) float, of the bodies' centres of
        mass; the last row is the ground's
    accelerations : (n_b + 1, 6) float, of the bodies for joint accelerations of zero
    frames : (n_l, 3, 3) float, joint frames, whose axes are the links' before their own motion
    points, turns : (n_l + 1, 3), (n_l + 1, 3, 3) float, frames of the links; the last row is the ground's
    """

    S: FloatArray
    V: FloatArray
    A: FloatArray
    positions: FloatArray
    rotations: FloatArray
    velocities: FloatArray
    accelerations: FloatArray
    frames: FloatArray
    points: FloatArray
    turns: FloatArray


@compiled
def tree_memory(tree: Tree) -> TreeMotion:
    """Arrays of a motion, with the ground at rest in their last rows."""
    n_l, n_b, n_v = len(tree.parents), len(tree.body_links), tree.v_at[-1]
    S, V, A = np.zeros((n_v, 6)), np.zeros((n_l + 1, 6)), np.zeros((n_l + 1, 6))
    r, R_b, u, a = np.zeros((n_b + 1, 3)), np.zeros((n_b + 1, 3, 3)), np.zeros((n_b + 1, 6)), np.zeros((n_b + 1, 6))
    frames, o, R = np.zeros((n_l, 3, 3)), np.zeros((n_l + 1, 3)), np.zeros((n_l + 1, 3, 3))
    for i in range(3):
        R_b[n_b, i, i] = R[n_l, i, i] = 1.0
    return TreeMotion(S, V, A, r, R_b, u, a, frames, o, R)
