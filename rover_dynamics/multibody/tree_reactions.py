"""Reactions in the joints of a tree, from its leaves to the ground.

Verified by tests/verification/test_multibody_reactions.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.constraints import Constraints
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.reactions import at_joint_frame
from rover_dynamics.multibody.spanning_tree import SpanningTree
from rover_dynamics.multibody.tree_jacobians import body_jacobian
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion

__all__ = ["needed_wrenches", "tree_reactions"]

FloatArray = NDArray[np.float64]


def needed_wrenches(
    model: MultibodyModel, tree: Tree, motion: TreeMotion, v_dot: FloatArray, applied: FloatArray
) -> FloatArray:
    """What the joints of each body must exert on it, (n_b, 6) [N, N m], about its centre of mass, world axes.

    Newton's and Euler's equations: m (a - g) - F, and J w' + w x J w - M.

    Parameters
    ----------
    v_dot : (n_v,) float, joint accelerations
    applied : (n_b, 6) float, other wrenches without the weight [N, N m]
    """
    u_dot = motion.accelerations[:-1] + (body_jacobian(tree, motion) @ v_dot).reshape(-1, 6)
    R, w = motion.rotations[:-1], motion.velocities[:-1, 3:]
    J = R @ tree.inertias @ R.swapaxes(1, 2)
    spin, torque = np.einsum("nij,nj->ni", J, w), np.einsum("nij,nj->ni", J, u_dot[:, 3:])
    pull = tree.masses[:, None] * (u_dot[:, :3] - np.array(model.gravity))
    return np.asarray(np.hstack([pull, torque + np.cross(w, spin)]) - applied)


def tree_reactions(
    model: MultibodyModel,
    spanning: SpanningTree,
    motion: TreeMotion,
    needed: FloatArray,
    loops: Constraints,
    loads: FloatArray,
) -> FloatArray:
    """Wrenches of all joints on their second bodies at their frames, (n_j, 6), world axes; see `reactions.Reactions`.

    Parameters
    ----------
    needed : (n_b, 6) float, see `needed_wrenches`
    loops, loads : equations that close loops, and the wrenches of each on its two bodies, (m, 2, 6) [N, N m]
    """
    open_ = np.vstack([needed, np.zeros(6)])
    wrenches = {joint.name: np.zeros(6) for joint in model.joints}
    for equation, bodies, load in zip(loops.equations, loops.table.bodies, loads, strict=True):
        wrenches[equation.joint] += load[1]
        open_[bodies[0]] -= load[0]
        open_[bodies[1]] -= load[1]
    for hung in reversed(spanning.hung):
        load = open_[hung.child]
        arm = motion.positions[hung.child] - motion.positions[hung.parent]
        about_parent = np.concatenate([load[:3], load[3:] + np.cross(arm, load[:3])])
        open_[hung.parent] += about_parent
        forward = hung.child == model.number(hung.joint.second)
        wrenches[hung.joint.name] += load if forward else -about_parent
    return np.array([at_joint_frame(model, joint, motion.rotations, wrenches[joint.name]) for joint in model.joints])
