"""Forces and inertia of a tree of links in joint coordinates, compiled.

The mass matrix is that of composite bodies, kept as mass, first moments and moments of inertia about the world's
origin; forces are those of the recursive Newton-Euler method (Featherstone 2008, tables 6.2 and 5.1, here in world
axes). Verified by tests/unit/test_multibody_tree.py and tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled
from rover_dynamics.multibody.rows import (
    Vector,
    along,
    cross,
    dot,
    matrix,
    put_pair,
    times,
    times_matrix,
    transposed_times,
    vector,
)
from rover_dynamics.multibody.tree_arrays import Tree, TreeMotion

__all__ = ["bias_and_mass", "mass_matrix", "needed_efforts"]

FloatArray = NDArray[np.float64]
_XX, _YY, _ZZ, _XY, _XZ, _YZ, _MASS = 3, 4, 5, 6, 7, 8, 9
"""Places of a composite body's numbers behind its first moments."""


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
    n_v = len(motion.S)
    return needed_efforts(tree, motion, np.zeros(n_v), wrenches, gravity), mass_matrix(tree, motion)


@compiled
def needed_efforts(
    tree: Tree, motion: TreeMotion, rates: FloatArray, wrenches: FloatArray, gravity: FloatArray
) -> FloatArray:
    """M v' + h for joint accelerations v', (n_v,), without the mass matrix; the others as for `bias_and_mass`.

    Parameters
    ----------
    rates : v', (n_v,) float [rad/s^2, m/s^2]
    """
    n_l = len(tree.parents)
    further, force, out = np.zeros((n_l + 1, 6)), np.zeros((n_l + 1, 6)), np.empty(len(rates))
    for k in range(n_l):  # spatial accelerations by the joints'
        parent = tree.parents[k]
        w, u = vector(further, parent, 0), vector(further, parent, 3)
        for i in range(tree.v_at[k], tree.v_at[k + 1]):
            w, u = along(w, rates[i], vector(motion.S, i, 0)), along(u, rates[i], vector(motion.S, i, 3))
        put_pair(further, k, w, u)
    for b in range(len(tree.body_links)):
        _add_rate_of_momentum(tree, b, motion, further, force)
        _add_loads(tree, b, motion, (wrenches, gravity), force)
    for k in range(n_l - 1, -1, -1):
        parent = tree.parents[k]
        n, f = vector(force, k, 0), vector(force, k, 3)
        for i in range(tree.v_at[k], tree.v_at[k + 1]):
            out[i] = dot(vector(motion.S, i, 0), n) + dot(vector(motion.S, i, 3), f)
        _add(force, parent, n, f)
    return out


@compiled
def _add_rate_of_momentum(tree: Tree, b: int, motion: TreeMotion, further: FloatArray, force: FloatArray) -> None:
    """What a body's acceleration needs."""
    k, m, c, R = tree.body_links[b], tree.masses[b], vector(motion.positions, b, 0), matrix(motion.rotations, b)
    J, turn = matrix(tree.inertias, b), vector(further, k, 0)
    a = along(along(vector(motion.accelerations, b, 0), 1.0, vector(further, k, 3)), 1.0, cross(turn, c))
    w = transposed_times(R, vector(motion.velocities, b, 3))
    w_rate = transposed_times(R, along(vector(motion.accelerations, b, 3), 1.0, turn))
    moment = times(R, along(times(J, w_rate), 1.0, cross(w, times(J, w))))
    f = m * a[0], m * a[1], m * a[2]
    _add(force, k, along(moment, 1.0, cross(c, f)), f)


@compiled
def _add_loads(tree: Tree, b: int, motion: TreeMotion, loads: tuple[FloatArray, FloatArray], force: FloatArray) -> None:
    """Less its weight and the wrench on it."""
    (wrenches, g), c, m = loads, vector(motion.positions, b, 0), -tree.masses[b]
    f = along((m * g[0], m * g[1], m * g[2]), -1.0, vector(wrenches, b, 0))
    _add(force, tree.body_links[b], along(cross(c, f), -1.0, vector(wrenches, b, 3)), f)


@compiled
def _add(force: FloatArray, k: int, n: Vector, f: Vector) -> None:
    """Add (n, f) to row k."""
    put_pair(force, k, along(vector(force, k, 0), 1.0, n), along(vector(force, k, 3), 1.0, f))


@compiled
def mass_matrix(tree: Tree, motion: TreeMotion) -> FloatArray:
    """M, (n_v, n_v)."""
    n_l, n_v = len(tree.parents), len(motion.S)
    composite, M = np.zeros((n_l + 1, 10)), np.zeros((n_v, n_v))
    for b in range(len(tree.body_links)):
        _add_body(tree, b, motion, composite)
    for k in range(n_l - 1, -1, -1):
        for i in range(tree.v_at[k], tree.v_at[k + 1]):
            n, f = _momentum(composite, k, vector(motion.S, i, 0), vector(motion.S, i, 3))
            link = k
            while link >= 0:
                for j in range(tree.v_at[link], tree.v_at[link + 1]):
                    M[i, j] = M[j, i] = dot(vector(motion.S, j, 0), n) + dot(vector(motion.S, j, 3), f)
                link = tree.parents[link]
        for i in range(10):
            composite[tree.parents[k], i] += composite[k, i]
    return M


@compiled
def _add_body(tree: Tree, b: int, motion: TreeMotion, composite: FloatArray) -> None:
    """Mass, first moments and moments of inertia of a body about the world's origin."""
    k, m, (x, y, z), R = tree.body_links[b], tree.masses[b], vector(motion.positions, b, 0), matrix(motion.rotations, b)
    RJ = times_matrix(R, matrix(tree.inertias, b))
    row = composite[k]
    row[0], row[1], row[2] = along((row[0], row[1], row[2]), m, (x, y, z))
    row[_XX] += dot(RJ[0], R[0]) + m * (y * y + z * z)
    row[_YY] += dot(RJ[1], R[1]) + m * (x * x + z * z)
    row[_ZZ] += dot(RJ[2], R[2]) + m * (x * x + y * y)
    row[_XY] += dot(RJ[0], R[1]) - m * x * y
    row[_XZ] += dot(RJ[0], R[2]) - m * x * z
    row[_YZ] += dot(RJ[1], R[2]) - m * y * z
    row[_MASS] += m


@compiled
def _momentum(composite: FloatArray, k: int, w: Vector, u: Vector) -> tuple[Vector, Vector]:
    """Angular momentum about the origin and momentum of composite body k with the velocity (w, u)."""
    row, p = composite[k], vector(composite, k, 0)
    J = (
        (row[_XX], row[_XY], row[_XZ]),
        (row[_XY], row[_YY], row[_YZ]),
        (row[_XZ], row[_YZ], row[_ZZ]),
    )
    m = row[_MASS]
    return along(times(J, w), 1.0, cross(p, u)), along((m * u[0], m * u[1], m * u[2]), -1.0, cross(p, w))
