"""Newton's matrix of an implicit step of a vehicle, from its mass matrix and its tires' derivatives, compiled.

The matrix is c M - sum J^T E J of the free joint velocities, see `implicit_kernels`, and on the diagonal how motors'
torques fall with speed; J has columns for the joints between a wheel and the ground only. The tires' derivatives do not
depend on the step's length: for another length the matrix is put together again from the same ones. Its inverse is
kept, as it serves many iterations.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled
from rover_dynamics.multibody.rows import along, cross, put_pair, vector
from rover_dynamics.multibody.small_matrices import inverse, product
from rover_dynamics.multibody.tree_arrays import Tree, TreeMotion
from rover_dynamics.multibody.tree_forces import mass_matrix
from rover_dynamics.vehicle.system import Newton, System, Work

__all__ = ["changes", "linearise"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_SAME = 0.01
"""Relative difference of two steps' lengths that may share a matrix."""
_OLDEST = 50.0
"""Evaluations that may share the tires' derivatives."""


@compiled
def changes(newton: Newton, dt: float, outputs: FloatArray) -> tuple[bool, bool]:
    """Whether the matrix is that of another length of step, and whether the tires' derivatives are due; notes for what.

    They are due where other wheels touch the ground, and after `_OLDEST` uses.

    Parameters
    ----------
    dt : length of the step [s]
    outputs : (n_w, 10) float, of the tires, see `rover_dynamics.tires.brush_force.OUTPUT_SIZE`
    """
    made_for = newton.made_for
    made_for[1] += 1.0
    other_length, due = not abs(made_for[0] - dt) <= _SAME * dt, made_for[1] > _OLDEST
    made_for[0] = dt
    for i in range(len(outputs)):
        touches = 1.0 if outputs[i, 1] > 0.0 else 0.0
        due = due or made_for[2 + i] != touches
        made_for[2 + i] = touches
    return other_length, due


@compiled
def linearise(system: System, motion: TreeMotion, work: Work, weights: tuple[float, float, float]) -> None:
    """Fill ``work.newton`` from ``work.derivatives``, those of the tires.

    Parameters
    ----------
    weights : c [-]; dt gamma, the derivative of v by A [s]; dt^2 beta, that of the step [s^2]
    """
    M, free = mass_matrix(system.tree, motion), system.free
    matrix = weights[0] * M
    for i in range(len(system.motors.places)):
        matrix[system.motors.places[i], system.motors.places[i]] += weights[1] * work.slopes[i]
    J, path = np.zeros((len(M), 6)), np.zeros(len(M), dtype=np.int64)
    for i in range(len(work.derivatives)):
        n = _wheel_jacobian(system.tree, motion, system.tires.bodies[i], J, path)
        E, states, on_wrench, of_motion = _eliminated(work.derivatives[i], weights)
        work.newton.states[i] = states
        _subtract(matrix, E, J, path[:n])
        for k in path[:n]:
            work.newton.carry[i, k] = product(on_wrench.T, J[k])
            work.newton.follow[i, k] = product(of_motion, J[k])
    unknown = np.empty((len(free), len(free)))
    for i in range(len(free)):
        for j in range(len(free)):
            unknown[i, j] = matrix[free[i], free[j]]
    work.newton.inverse[:] = inverse(unknown)


@compiled
def _wheel_jacobian(tree: Tree, motion: TreeMotion, body: int, J: FloatArray, path: IntArray) -> int:
    """Rows of J^T, (n_v, 6), for velocity and angular velocity of a body; the joints on its path, and their number."""
    n, link, r = 0, tree.body_links[body], vector(motion.positions, body, 0)
    while link >= 0:
        for i in range(tree.v_at[link], tree.v_at[link + 1]):
            w = vector(motion.S, i, 0)
            put_pair(J, i, along(vector(motion.S, i, 3), 1.0, cross(w, r)), w)
            path[n] = i
            n += 1
        link = tree.parents[link]
    return n


@compiled
def _eliminated(
    D: FloatArray, weights: tuple[float, float, float]
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """E, (6, 6), of one wheel with its states eliminated, and what gives them back.

    These are the inverse of the states' own matrix, the wrench by a residual of the states, (6, n_s), and the states'
    rates by the motion, (n_s, 6).
    """
    c, w_v, w_q = weights
    n_s = len(D) - 6
    own, by_motion, on_wrench = np.empty((n_s, n_s)), np.empty((6 + n_s, 6)), np.empty((6, n_s))
    for i in range(6 + n_s):
        for j in range(6):
            by_motion[i, j] = w_q * D[i, j] + w_v * D[i, 6 + j]
    for i in range(n_s):
        for j in range(n_s):
            own[i, j] = (c if i == j else 0.0) - w_v * D[6 + i, 12 + j]
    states = inverse(own)
    for m in range(6):
        on_wrench[m] = product(states.T, w_v * D[m, 12:])
    of_motion, E = np.empty((n_s, 6)), by_motion[:6].copy()
    for m in range(6):
        of_motion[:, m] = product(states, by_motion[6:, m])
        E[:, m] += product(on_wrench, by_motion[6:, m])
    return E, states, on_wrench, of_motion


@compiled
def _subtract(matrix: FloatArray, E: FloatArray, J: FloatArray, path: IntArray) -> None:
    """matrix -= J^T E J."""
    for j in path:
        pull = product(E, J[j])
        for i in path:
            for m in range(6):
                matrix[i, j] -= J[i, m] * pull[m]
