"""Kinematics of a tree of links in joint coordinates, compiled.

Spatial vectors are referred to the world's origin: a velocity is (w, v_O), a force (n_O, f). A link turns about or
slides along one axis, turns about a point, or is free (Featherstone 2008, table 5.1, here in world axes). What the
motion needs in forces is in `tree_forces`. Verified by tests/unit/test_multibody_tree.py and
tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled, multiply_quaternions, rotation_matrix, rotation_quaternion
from rover_dynamics.multibody.rows import (
    Vector,
    along,
    cross,
    matrix,
    put_matrix,
    put_pair,
    put_vector,
    times,
    times_matrix,
    transposed_times,
    turn_matrix,
    vector,
)
from rover_dynamics.multibody.tree_arrays import LinkKind, Tree, TreeMotion, tree_memory
from rover_dynamics.multibody.tree_forces import bias_and_mass

__all__ = ["LinkKind", "Tree", "TreeMotion", "advance", "bias_and_mass", "coordinate_rates", "move_tree", "tree_motion"]

FloatArray = NDArray[np.float64]

_REVOLUTE, _PRISMATIC, _SPHERICAL = int(LinkKind.REVOLUTE), int(LinkKind.PRISMATIC), int(LinkKind.SPHERICAL)


@compiled
def tree_motion(tree: Tree, q: FloatArray, v: FloatArray) -> TreeMotion:
    """Positions, velocities and velocity-dependent accelerations of all links and bodies.

    Parameters
    ----------
    q, v : (n_q,), (n_v,) float, joint coordinates [rad, m, -] and velocities [rad/s, m/s]
    """
    motion = tree_memory(tree)
    move_tree(tree, q, v, motion)
    return motion


@compiled
def move_tree(tree: Tree, q: FloatArray, v: FloatArray, motion: TreeMotion) -> None:
    """Overwrite a motion with that of q (n_q,) and v (n_v,), see `tree_motion`; allocates nothing."""
    for k in range(len(tree.parents)):
        if tree.kinds[k] in (_REVOLUTE, _PRISMATIC):
            _place_on_axis(tree, k, q, motion)
            _move_on_axis(tree, k, v, motion)
        else:
            _place_at_point(tree, k, q, motion)
            _move_at_point(tree, k, v, motion)
    for b in range(len(tree.body_links)):
        _carry_body(tree, b, motion)


@compiled
def _place_on_axis(tree: Tree, k: int, q: FloatArray, motion: TreeMotion) -> None:
    """Frame and motion vector of link k, which turns about or slides along an axis."""
    parent, dof, x = tree.parents[k], tree.v_at[k], q[tree.q_at[k]]
    R_parent, axis = matrix(motion.turns, parent), vector(tree.axes, k, 0)
    frame = times_matrix(R_parent, matrix(tree.turns, k))
    o = along(vector(motion.points, parent, 0), 1.0, times(R_parent, vector(tree.offsets, k, 0)))
    axis_w = times(frame, axis)
    put_matrix(motion.frames, k, frame)
    if tree.kinds[k] == _REVOLUTE:
        put_matrix(motion.turns, k, times_matrix(frame, turn_matrix(axis, x)))
        put_pair(motion.S, dof, axis_w, cross(o, axis_w))
    else:
        o = along(o, x, axis_w)
        put_matrix(motion.turns, k, frame)
        put_pair(motion.S, dof, (0.0, 0.0, 0.0), axis_w)
    put_vector(motion.points, k, o)


@compiled
def _move_on_axis(tree: Tree, k: int, v: FloatArray, motion: TreeMotion) -> None:
    """Its velocity, and its acceleration for joint accelerations of zero: its axis is the parent's, S' v = V x s."""
    parent, dof = tree.parents[k], tree.v_at[k]
    S, V, A = motion.S, motion.V, motion.A
    w, u = vector(V, parent, 0), vector(V, parent, 3)
    s_w, s_u, rate = vector(S, dof, 0), vector(S, dof, 3), v[dof]
    put_pair(V, k, along(w, rate, s_w), along(u, rate, s_u))
    a_u = along(along(vector(A, parent, 3), rate, cross(w, s_u)), rate, cross(u, s_w))
    put_pair(A, k, along(vector(A, parent, 0), rate, cross(w, s_w)), a_u)


@compiled
def _place_at_point(tree: Tree, k: int, q: FloatArray, motion: TreeMotion) -> None:
    """Frame and motion vectors of link k, which turns about a point or is free."""
    parent, at, dof = tree.parents[k], tree.q_at[k], tree.v_at[k]
    R_parent = matrix(motion.turns, parent)
    frame = times_matrix(R_parent, matrix(tree.turns, k))
    o = along(vector(motion.points, parent, 0), 1.0, times(R_parent, vector(tree.offsets, k, 0)))
    put_matrix(motion.frames, k, frame)
    if tree.kinds[k] != _SPHERICAL:
        o = along(o, 1.0, times(frame, (q[at], q[at + 1], q[at + 2])))
        for i in range(3):
            put_pair(motion.S, dof + i, (0.0, 0.0, 0.0), _unit(i))
        at, dof = at + 3, dof + 3
    rotation_matrix(q[at : at + 4], motion.turns[k])
    put_matrix(motion.turns, k, times_matrix(frame, matrix(motion.turns, k)))
    for i in range(3):
        put_pair(motion.S, dof + i, _unit(i), cross(o, _unit(i)))
    put_vector(motion.points, k, o)


@compiled
def _move_at_point(tree: Tree, k: int, v: FloatArray, motion: TreeMotion) -> None:
    """Its velocity, and its acceleration for joint accelerations of zero: the axes' point moves, S' v = (0, o' x w)."""
    parent, dof, o = tree.parents[k], tree.v_at[k], vector(motion.points, k, 0)
    V, A = motion.V, motion.A
    w, u = vector(V, parent, 0), vector(V, parent, 3)
    if tree.kinds[k] == _SPHERICAL:
        turning = v[dof], v[dof + 1], v[dof + 2]
        o_rate = along(u, 1.0, cross(w, o))
        w, u = along(w, 1.0, turning), along(u, 1.0, cross(o, turning))
    else:
        turning = v[dof + 3], v[dof + 4], v[dof + 5]
        w = along(w, 1.0, turning)
        u = along(along(u, 1.0, (v[dof], v[dof + 1], v[dof + 2])), 1.0, cross(o, turning))
        o_rate = along(u, 1.0, cross(w, o))
    put_pair(V, k, w, u)
    put_pair(A, k, vector(A, parent, 0), along(vector(A, parent, 3), 1.0, cross(o_rate, turning)))


@compiled
def _unit(i: int) -> Vector:
    """World axis i."""
    return 1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0, 1.0 if i == 2 else 0.0


@compiled
def _carry_body(tree: Tree, b: int, motion: TreeMotion) -> None:
    """Place, velocity and acceleration of a body on its link."""
    k = tree.body_links[b]
    R, w, a_w = matrix(motion.turns, k), vector(motion.V, k, 0), vector(motion.A, k, 0)
    r = along(vector(motion.points, k, 0), 1.0, times(R, vector(tree.body_points, b, 0)))
    put_vector(motion.positions, b, r)
    put_matrix(motion.rotations, b, times_matrix(R, matrix(tree.body_turns, b)))
    u = along(vector(motion.V, k, 3), 1.0, cross(w, r))
    put_pair(motion.velocities, b, u, w)
    a = along(along(vector(motion.A, k, 3), 1.0, cross(a_w, r)), 1.0, cross(w, u))
    put_pair(motion.accelerations, b, a, a_w)


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
            out[at], out[at + 1], out[at + 2] = _in_frame(frames, k, v, dof)
            at, dof = at + 3, dof + 3
        turn[1], turn[2], turn[3] = along((0.0, 0.0, 0.0), 0.5, _in_frame(frames, k, v, dof))
        multiply_quaternions(turn, q[at : at + 4], out[at : at + 4])
    return out


@compiled
def advance(tree: Tree, q: FloatArray, step: FloatArray, frames: FloatArray) -> FloatArray:
    """Coordinates after the joint displacements ``step``, (n_v,); quaternions keep their length."""
    out, turn, turned = np.empty_like(q), np.empty(3), np.empty(4)
    for k in range(len(tree.parents)):
        at, dof, kind = tree.q_at[k], tree.v_at[k], tree.kinds[k]
        if kind in (_REVOLUTE, _PRISMATIC):
            out[at] = q[at] + step[dof]
            continue
        if kind != _SPHERICAL:
            out[at], out[at + 1], out[at + 2] = along(
                (q[at], q[at + 1], q[at + 2]), 1.0, _in_frame(frames, k, step, dof)
            )
            at, dof = at + 3, dof + 3
        turn[0], turn[1], turn[2] = _in_frame(frames, k, step, dof)
        rotation_quaternion(turn, turned)
        multiply_quaternions(turned, q[at : at + 4], out[at : at + 4])
        length = np.sqrt(out[at] ** 2 + out[at + 1] ** 2 + out[at + 2] ** 2 + out[at + 3] ** 2)
        for i in range(at, at + 4):
            out[i] /= length
    return out


@compiled
def _in_frame(frames: FloatArray, k: int, x: FloatArray, at: int) -> Vector:
    """Three numbers of x, a world vector, in joint frame k."""
    return transposed_times(matrix(frames, k), (x[at], x[at + 1], x[at + 2]))
