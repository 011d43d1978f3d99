"""Velocities of bodies, and constraint equations, in terms of the joint velocities of a tree.

Verified by tests/unit/test_multibody_tree.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled, cross
from rover_dynamics.multibody.constraint_kernels import ConstraintTable
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion

__all__ = ["body_jacobian", "in_joint_velocities"]

FloatArray = NDArray[np.float64]


@compiled
def body_jacobian(tree: Tree, motion: TreeMotion) -> FloatArray:
    """B, (6 n_b, n_v): velocities of the centres of mass and angular velocities of all bodies are B v."""
    n_b = len(tree.body_links)
    B, turn = np.zeros((6 * n_b, len(motion.S))), np.empty(3)
    for b in range(n_b):
        link = tree.body_links[b]
        while link >= 0:
            for i in range(tree.v_at[link], tree.v_at[link + 1]):
                cross(motion.S[i, :3], motion.positions[b], turn)
                for n in range(3):
                    B[6 * b + n, i] = motion.S[i, 3 + n] + turn[n]
                    B[6 * b + 3 + n, i] = motion.S[i, n]
            link = tree.parents[link]
    return B


@compiled
def in_joint_velocities(
    tree: Tree, motion: TreeMotion, table: ConstraintTable, C_u: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """J = C_u B, (m, n_v), and C_u B' v, (m,), for equations with the blocks ``C_u`` (m, 2, 6)."""
    m = len(C_u)
    J, bias, moment, covector = np.zeros((m, len(motion.S))), np.zeros(m), np.empty(3), np.empty(6)
    for k in range(m):
        for side in range(2):
            b = table.bodies[k, side]
            if b < 0:
                continue
            row = C_u[k, side]
            bias[k] += np.dot(row, motion.accelerations[b])
            cross(motion.positions[b], row[:3], moment)
            for n in range(3):
                covector[n], covector[3 + n] = row[3 + n] + moment[n], row[n]
            link = tree.body_links[b]
            while link >= 0:
                for i in range(tree.v_at[link], tree.v_at[link + 1]):
                    J[k, i] += np.dot(covector, motion.S[i])
                link = tree.parents[link]
    return J, bias
