"""Kinematics, mass matrix and bias forces of a tree of links in joint coordinates, compiled.

Spatial vectors are referred to the world's origin: a velocity is (w, v_O), a force (n_O, f). A link turns about or
slides along one axis, turns about a point, or is free. The mass matrix is that of composite bodies, the bias force that
of the recursive Newton-Euler method (Featherstone 2008, tables 6.2 and 5.1, here in world axes). Verified by
tests/unit/test_multibody_tree.py and tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import (
    compiled,
    cross,
    multiply_quaternions,
    rotation_matrix,
    rotation_quaternion,
)

__all__ = ["LinkKind", "Tree", "TreeMotion", "advance", "bias_and_mass", "coordinate_rates", "tree_motion"]

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
    """

    S: FloatArray
    V: FloatArray
    A: FloatArray
    positions: FloatArray
    rotations: FloatArray
    velocities: FloatArray
    accelerations: FloatArray
    frames: FloatArray


_REVOLUTE, _PRISMATIC, _SPHERICAL = int(LinkKind.REVOLUTE), int(LinkKind.PRISMATIC), int(LinkKind.SPHERICAL)


@compiled
def tree_motion(tree: Tree, q: FloatArray, v: FloatArray) -> TreeMotion:
    """Positions, velocities and velocity-dependent accelerations of all links and bodies."""
    n_l, n_b = len(tree.parents), len(tree.body_links)
    S, V, A = np.zeros((tree.v_at[n_l], 6)), np.zeros((n_l + 1, 6)), np.zeros((n_l + 1, 6))
    o, R, frames = np.zeros((n_l + 1, 3)), np.zeros((n_l + 1, 3, 3)), np.empty((n_l, 3, 3))
    R[n_l] = np.eye(3)
    for k in range(n_l):
        frames[k] = R[tree.parents[k]] @ tree.turns[k]
        _place(tree, k, q, v, frames[k], o, R, S, V)
        _accelerate(tree, k, v, o, S, V, A)
    r, R_b = np.zeros((n_b + 1, 3)), np.zeros((n_b + 1, 3, 3))
    u, a = np.zeros((n_b + 1, 6)), np.zeros((n_b + 1, 6))
    R_b[n_b] = np.eye(3)
    turn, other = np.empty(3), np.empty(3)
    for b in range(n_b):
        k = tree.body_links[b]
        r[b], R_b[b] = o[k] + R[k] @ tree.body_points[b], R[k] @ tree.body_turns[b]
        cross(V[k, :3], r[b], turn)
        u[b, :3], u[b, 3:] = V[k, 3:] + turn, V[k, :3]
        cross(A[k, :3], r[b], turn)
        cross(V[k, :3], u[b, :3], other)
        a[b, :3], a[b, 3:] = A[k, 3:] + turn + other, A[k, :3]
    return TreeMotion(S, V, A, r, R_b, u, a, frames)


@compiled
def _place(
    tree: Tree,
    k: int,
    q: FloatArray,
    v: FloatArray,
    frame: FloatArray,
    o: FloatArray,
    R: FloatArray,
    S: FloatArray,
    V: FloatArray,
) -> None:
    """Frame of link k, its motion vectors and its velocity."""
    parent, kind, at, dof = tree.parents[k], tree.kinds[k], tree.q_at[k], tree.v_at[k]
    o[k] = o[parent] + R[parent] @ tree.offsets[k]
    turned, quaternion = np.empty((3, 3)), np.empty(4)
    V[k] = V[parent]
    if kind == _REVOLUTE:
        axis = frame @ tree.axes[k]
        rotation_quaternion(q[at] * tree.axes[k], quaternion)
        rotation_matrix(quaternion, turned)
        R[k] = frame @ turned
        S[dof, :3] = axis
        cross(o[k], axis, S[dof, 3:])
        V[k] += v[dof] * S[dof]
    elif kind == _PRISMATIC:
        axis = frame @ tree.axes[k]
        o[k] += q[at] * axis
        R[k] = frame
        S[dof, 3:] = axis
        V[k] += v[dof] * S[dof]
    else:
        first = at
        if kind != _SPHERICAL:
            o[k] += frame @ q[at : at + 3]
            for i in range(3):
                S[dof + i, 3 + i] = 1.0
                V[k, 3 + i] += v[dof + i]
            first, dof = at + 3, dof + 3
        rotation_matrix(q[first : first + 4], turned)
        R[k] = frame @ turned
        for i in range(3):
            S[dof + i, i] = 1.0
            cross(o[k], S[dof + i, :3], S[dof + i, 3:])
            V[k] += v[dof + i] * S[dof + i]


@compiled
def _accelerate(tree: Tree, k: int, v: FloatArray, o: FloatArray, S: FloatArray, V: FloatArray, A: FloatArray) -> None:
    """Spatial acceleration of link k for joint accelerations of zero: that of its parent, and S' v."""
    parent, dof = tree.parents[k], tree.v_at[k]
    A[k] = A[parent]
    a, b = np.empty(3), np.empty(3)
    if tree.kinds[k] in (_REVOLUTE, _PRISMATIC):
        s = v[dof] * S[dof]  # the axis is fixed to the parent: S' v = V_parent x s
        cross(V[parent, :3], s[:3], a)
        A[k, :3] += a
        cross(V[parent, :3], s[3:], a)
        cross(V[parent, 3:], s[:3], b)
        A[k, 3:] += a + b
        return
    w = v[dof : dof + 3] if tree.kinds[k] == _SPHERICAL else v[dof + 3 : dof + 6]
    base = V[parent] if tree.kinds[k] == _SPHERICAL else V[k]  # axes through a point that moves: S' v = (0, o' x w)
    cross(base[:3], o[k], a)
    a += base[3:]
    cross(a, w, b)
    A[k, 3:] += b


@compiled
def bias_and_mass(
    tree: Tree, motion: TreeMotion, wrenches: FloatArray, gravity: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """h, (n_v,) and M, (n_v, n_v), of M v' + h = 0, with the applied wrenches of the bodies in h.

    Parameters
    ----------
    wrenches : (n_b, 6) float, force, and moment about the centre of mass, world [N, N m]; without the weight
    gravity : (3,) float, acceleration of free fall [m/s^2]
    """
    n_l, n_v = len(tree.parents), len(motion.S)
    inertia, force = np.zeros((n_l + 1, 6, 6)), np.zeros((n_l + 1, 6))
    for b in range(len(tree.body_links)):
        _add_body(tree, b, motion, wrenches[b], gravity, inertia, force)
    h, M = np.empty(n_v), np.zeros((n_v, n_v))
    for k in range(n_l - 1, -1, -1):
        parent = tree.parents[k]
        for i in range(tree.v_at[k], tree.v_at[k + 1]):
            h[i] = np.dot(motion.S[i], force[k])
            momentum = inertia[k] @ motion.S[i]
            link = k
            while link >= 0:
                for j in range(tree.v_at[link], tree.v_at[link + 1]):
                    M[i, j] = np.dot(motion.S[j], momentum)
                    M[j, i] = M[i, j]
                link = tree.parents[link]
        inertia[parent] += inertia[k]
        force[parent] += force[k]
    return h, M


@compiled
def _add_body(
    tree: Tree,
    b: int,
    motion: TreeMotion,
    wrench: FloatArray,
    gravity: FloatArray,
    inertia: FloatArray,
    force: FloatArray,
) -> None:
    """Inertia of a body about the world's origin, and its rate of momentum less the forces on it."""
    k, m, c, R = tree.body_links[b], tree.masses[b], motion.positions[b], motion.rotations[b]
    J = R @ tree.inertias[b] @ R.T
    w = motion.velocities[b, 3:]
    spin, gyroscopic, pull, moment = J @ w, np.empty(3), np.empty(3), np.empty(3)
    cross(w, spin, gyroscopic)
    a = motion.accelerations[b]
    pull[:] = m * (a[:3] - gravity) - wrench[:3]
    cross(c, pull, moment)
    force[k, :3] += J @ a[3:] + gyroscopic - wrench[3:] + moment
    force[k, 3:] += pull
    square = np.dot(c, c)
    for i in range(3):
        for j in range(3):
            inertia[k, i, j] += J[i, j] + m * ((square if i == j else 0.0) - c[i] * c[j])
        inertia[k, 3 + i, 3 + i] += m
    for i, j, x in ((0, 1, -c[2]), (0, 2, c[1]), (1, 2, -c[0])):
        inertia[k, i, 3 + j] += m * x
        inertia[k, j, 3 + i] -= m * x
        inertia[k, 3 + j, i] += m * x
        inertia[k, 3 + i, j] -= m * x


@compiled
def coordinate_rates(tree: Tree, q: FloatArray, v: FloatArray, frames: FloatArray) -> FloatArray:
    """q' of joint velocities v, (n_q,); ``frames`` as in `TreeMotion`."""
    out, turn = np.empty_like(q), np.zeros(4)
    for k in range(len(tree.parents)):
        at, dof, kind = tree.q_at[k], tree.v_at[k], tree.kinds[k]
        if kind in (_REVOLUTE, _PRISMATIC):
            out[at] = v[dof]
            continue
        if kind != _SPHERICAL:
            out[at : at + 3] = frames[k].T @ v[dof : dof + 3]
            at, dof = at + 3, dof + 3
        turn[1:] = 0.5 * (frames[k].T @ v[dof : dof + 3])
        multiply_quaternions(turn, q[at : at + 4], out[at : at + 4])
    return out


@compiled
def advance(tree: Tree, q: FloatArray, step: FloatArray, frames: FloatArray) -> FloatArray:
    """Coordinates after the joint displacements ``step``, (n_v,); quaternions keep their length."""
    out, turn = np.empty_like(q), np.empty(4)
    for k in range(len(tree.parents)):
        at, dof, kind = tree.q_at[k], tree.v_at[k], tree.kinds[k]
        if kind in (_REVOLUTE, _PRISMATIC):
            out[at] = q[at] + step[dof]
            continue
        if kind != _SPHERICAL:
            out[at : at + 3] = q[at : at + 3] + frames[k].T @ step[dof : dof + 3]
            at, dof = at + 3, dof + 3
        rotation_quaternion(frames[k].T @ step[dof : dof + 3], turn)
        multiply_quaternions(turn, q[at : at + 4], out[at : at + 4])
        out[at : at + 4] /= np.sqrt(np.sum(out[at : at + 4] ** 2))
    return out
