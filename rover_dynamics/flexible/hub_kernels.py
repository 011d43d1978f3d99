"""Reference nodes that move with wheels' bodies, eliminated onto their joint coordinates (thesis eq. 2.20), compiled.

A reference node has the vectors (r, a_1, a_2, a_3) of a rigid hub: r its centre, a_i the columns of the rotation. With
the twist (v, w) of the hub and its rate

    r' = v,   a_i' = w x a_i,        r'' = v',   a_i'' = w' x a_i + w x (w x a_i)

and forces (f, F_1, F_2, F_3) on the node are the wrench (f, sum a_i x F_i) on the hub. Verified by
tests/unit/test_flexible_hubs.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled, cross
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion

__all__ = ["HubMotion", "hub_motion", "hub_wrenches", "wheel_jacobians"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class HubMotion(NamedTuple):
    """Reference nodes of all wheels.

    Attributes
    ----------
    z, v, a : (n_w, 4, 3) float, vectors [m, -], rates and accelerations, world
    """

    z: FloatArray
    v: FloatArray
    a: FloatArray


@compiled
def hub_motion(motion: TreeMotion, bodies: IntArray, mounts: FloatArray, twist_rates: FloatArray) -> HubMotion:
    """Vectors of the reference nodes.

    Parameters
    ----------
    motion : of the tree
    bodies : (n_w,) int, rows of the wheels' bodies
    mounts : (n_w, 3, 3) float, from the tire's frame to that of the wheel's body
    twist_rates : (n_w, 6) float, acceleration of each hub's centre and angular acceleration, world
    """
    n = len(bodies)
    z, v, a = np.empty((n, 4, 3)), np.empty((n, 4, 3)), np.empty((n, 4, 3))
    turn = np.empty(3)
    for k in range(n):
        b = bodies[k]
        w = motion.velocities[b, 3:]
        z[k, 0], v[k, 0], a[k, 0] = motion.positions[b], motion.velocities[b, :3], twist_rates[k, :3]
        for i in range(3):
            for c in range(3):
                z[k, 1 + i, c] = 0.0
                for d in range(3):
                    z[k, 1 + i, c] += motion.rotations[b, c, d] * mounts[k, d, i]
            cross(w, z[k, 1 + i], v[k, 1 + i])
            cross(twist_rates[k, 3:], z[k, 1 + i], turn)
            cross(w, v[k, 1 + i], a[k, 1 + i])
            a[k, 1 + i] += turn
    return HubMotion(z, v, a)


@compiled
def hub_wrenches(z: FloatArray, forces: FloatArray) -> FloatArray:
    """Force and moment about the hub centre, (n_w, 6), of generalised forces (n_w, 4, 3) on reference nodes at z."""
    out, turn = np.empty((len(z), 6)), np.empty(3)
    for k in range(len(z)):
        out[k, :3], out[k, 3:] = forces[k, 0], 0.0
        for i in range(1, 4):
            cross(z[k, i], forces[k, i], turn)
            out[k, 3:] += turn
    return out


@compiled
def wheel_jacobians(tree: Tree, motion: TreeMotion, bodies: IntArray) -> FloatArray:
    """J (n_w, 6, n_v): velocity of each wheel's centre and its angular velocity are J v."""
    J, turn = np.zeros((len(bodies), 6, len(motion.S))), np.empty(3)
    for k in range(len(bodies)):
        link = tree.body_links[bodies[k]]
        while link >= 0:
            for i in range(tree.v_at[link], tree.v_at[link + 1]):
                cross(motion.S[i, :3], motion.positions[bodies[k]], turn)
                for n in range(3):
                    J[k, n, i] = motion.S[i, 3 + n] + turn[n]
                    J[k, 3 + n, i] = motion.S[i, n]
            link = tree.parents[link]
    return J
