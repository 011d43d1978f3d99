"""One step of the generalised-alpha method for a tree of bodies on tires, compiled.

Unknown are the accelerations of the free joint velocities, M a + h = J^T W + tau, and the rates of the tires' own states,
s' = g (Arnold and Bruels 2007, in joint coordinates; quaternions are advanced by rotation vectors):

    step = dt v + dt^2 (1/2 - beta) A_n + dt^2 beta A,    v = v_n + dt (1 - gamma) A_n + dt gamma A
    (1 - alpha_m) A + alpha_m A_n = (1 - alpha_f) a + alpha_f a_n,    the same for the states' rates with one integral less

Newton's matrix is c M - sum J^T E J, where E holds the derivatives of a tire's wrench by the hub's motion with the tire's
states eliminated; derivatives of M, h and J are left out, which costs iterations only. Verified by
tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import TerrainPieces
from rover_dynamics.brush_derivatives import brush_derivatives
from rover_dynamics.brush_force import BrushResult, BrushScratch, HubMotions, brush_forces
from rover_dynamics.brush_settings import WheelNumbers
from rover_dynamics.multibody.compiled import compiled, cross
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion, advance, bias_and_mass, tree_motion

__all__ = ["Method", "Moment", "Tires", "evaluate", "implicit_step"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Method(NamedTuple):
    """Coefficients of the generalised-alpha method, and when its iteration ends.

    Attributes
    ----------
    alpha_m, alpha_f, beta, gamma : [-]
    tolerance : largest change of a joint acceleration times dt^2 in the last iteration [m, rad]
    iterations : at most
    """

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    tolerance: float
    iterations: int


class Tires(NamedTuple):
    """The vehicle's tires, for the compiled calls.

    Attributes
    ----------
    bodies : (n_w,) int, rows of the wheels' bodies
    numbers, pieces : of the wheels, of the terrain
    scratch, pair : working memory of `brush_derivatives`
    """

    bodies: IntArray
    numbers: WheelNumbers
    pieces: TerrainPieces
    scratch: BrushScratch
    pair: BrushResult


class Moment(NamedTuple):
    """Everything at one time that a step starts from.

    Attributes
    ----------
    q, v, a : (n_q,), (n_v,), (n_v,) float, coordinates, velocities, accelerations of the joints
    A : (n_v,) float, the method's accelerations
    s, s_rate, B : (n_w, n_s) float, states of the tires, their rates, the method's rates
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    A: FloatArray
    s: FloatArray
    s_rate: FloatArray
    B: FloatArray


@compiled
def hub_motions(motion: TreeMotion, bodies: IntArray) -> HubMotions:
    """Motions of the wheels' bodies."""
    n = len(bodies)
    r, R, v, w = np.empty((n, 3)), np.empty((n, 3, 3)), np.empty((n, 3)), np.empty((n, 3))
    for i in range(n):
        b = bodies[i]
        r[i], R[i], v[i], w[i] = motion.positions[b], motion.rotations[b], motion.velocities[b, :3], motion.velocities[b, 3:]
    return HubMotions(r, R, v, w)


@compiled
def evaluate(
    tree: Tree, tires: Tires, q: FloatArray, v: FloatArray, s: FloatArray, gravity: FloatArray, result: BrushResult
) -> tuple[TreeMotion, HubMotions, FloatArray, FloatArray]:
    """Motion of links and hubs, bias forces with the tires' wrenches in them, and mass matrix; fills ``result``."""
    motion = tree_motion(tree, q, v)
    hubs = hub_motions(motion, tires.bodies)
    brush_forces(hubs, s, tires.numbers, tires.pieces, result, tires.scratch)
    wrenches = np.zeros((len(tree.body_links), 6))
    for i in range(len(tires.bodies)):
        wrenches[tires.bodies[i]] += result.wrench[i]
    h, M = bias_and_mass(tree, motion, wrenches, gravity)
    return motion, hubs, h, M


@compiled
def wheel_jacobian(tree: Tree, motion: TreeMotion, body: int, J: FloatArray) -> None:
    """J (6, n_v): velocity of the body's centre and its angular velocity are J v."""
    J[:] = 0.0
    turn = np.empty(3)
    link = tree.body_links[body]
    while link >= 0:
        for i in range(tree.v_at[link], tree.v_at[link + 1]):
            cross(motion.S[i, :3], motion.positions[body], turn)
            for n in range(3):
                J[n, i] = motion.S[i, 3 + n] + turn[n]
                J[3 + n, i] = motion.S[i, n]
        link = tree.parents[link]


@compiled
def newton_matrix(
    tree: Tree,
    motion: TreeMotion,
    tires: Tires,
    derivatives: FloatArray,
    M: FloatArray,
    weights: tuple[float, float, float],
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """c M - sum J^T E J for all velocities; and what brings the states' changes back: (n_w, s, n_v) and (n_w, s, s).

    weights : c, dt gamma, dt^2 beta
    """
    c, w_v, w_q = weights
    n_w, n_v = len(tires.bodies), len(M)
    n_s = derivatives.shape[1] - 6
    matrix, J = c * M, np.empty((6, n_v))
    follow, inverse = np.zeros((n_w, n_s, n_v)), np.zeros((n_w, n_s, n_s))
    for i in range(n_w):
        D = derivatives[i]
        wheel_jacobian(tree, motion, tires.bodies[i], J)
        by_motion = w_q * D[:, :6].copy() + w_v * D[:, 6:12].copy()
        inverse[i] = np.linalg.inv(c * np.eye(n_s) - w_v * D[6:, 12:].copy())
        states = inverse[i] @ by_motion[6:].copy()
        E = by_motion[:6].copy() + w_v * (D[:6, 12:].copy() @ states)
        follow[i] = states @ J
        matrix -= J.T @ (E @ J)
    return matrix, follow, inverse


@compiled
def implicit_step(
    tree: Tree,
    tires: Tires,
    before: Moment,
    known: tuple[IntArray, IntArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray],
    dt: float,
    method: Method,
    result: BrushResult,
) -> tuple[bool, int, float, Moment]:
    """One step.

    Parameters
    ----------
    before : where it starts
    known : free and driven velocities, (n_f,) and (n_d,) int; driven coordinates, velocities and accelerations at the
        end, (n_d,); joint efforts tau, (n_v,) [N m, N]; gravity, (3,)
    dt : [s]

    Returns
    -------
    converged, iterations : of Newton's method
    error : estimated local error of the joint coordinates, largest entry [m, rad]
    after : the end of the step
    """
    free, driven, q_d, v_d, a_d, tau, gravity = known
    m, f, beta, gamma = method.alpha_m, method.alpha_f, method.beta, method.gamma
    c = (1.0 - m) / (1.0 - f)
    n_f, n_s = len(free), before.s.shape[1]
    A, B = before.a.copy(), before.s_rate.copy()  # predictor: accelerations stay
    start = tree_motion(tree, before.q, before.v)
    derivatives = np.zeros((len(tires.bodies), 6 + n_s, 12 + n_s))
    factors, follow, inverse = np.zeros((n_f, n_f)), np.zeros((1, 1, 1)), np.zeros((1, 1, 1))
    last = 1e300
    for iteration in range(method.iterations):
        a = (  (1.0 - m) * A + m * before.A - f * before.a) / (1.0 - f)
        s_rate = ((1.0 - m) * B + m * before.B - f * before.s_rate) / (1.0 - f)
        v = before.v + dt * ((1.0 - gamma) * before.A + gamma * A)
        step = dt * before.v + dt * dt * ((0.5 - beta) * before.A + beta * A)
        q = advance(tree, before.q, step, start.frames)
        for k in range(len(driven)):
            q[tree.q_at[np.searchsorted(tree.v_at, driven[k], side="right") - 1]] = q_d[k]
            v[driven[k]], a[driven[k]] = v_d[k], a_d[k]
        s = before.s + dt * ((1.0 - gamma) * before.B + gamma * B)
        motion, hubs, h, M = evaluate(tree, tires, q, v, s, gravity, result)
        residual = (tau - h - M @ a)[free]
        state_residual = result.rate - s_rate
        if iteration % 4 == 0:
            brush_derivatives(hubs, s, tires.numbers, tires.pieces, derivatives, (tires.scratch, tires.pair))
            matrix, follow, inverse = newton_matrix(
                tree, motion, tires, derivatives, M, (c, dt * gamma, dt * dt * beta)
            )
            factors = matrix[free][:, free]
        right = residual.copy()
        J = np.empty((6, len(M)))
        for i in range(len(tires.bodies)):
            wheel_jacobian(tree, motion, tires.bodies[i], J)
            shift = dt * gamma * (derivatives[i, :6, 12:].copy() @ (inverse[i] @ state_residual[i]))
            right += (J.T @ shift)[free]
        change = np.linalg.solve(factors, right)
        whole = np.zeros(len(M))
        whole[free] = change
        A += whole
        for i in range(len(tires.bodies)):
            B[i] += inverse[i] @ state_residual[i] + follow[i] @ whole
        last = dt * dt * np.max(np.abs(change))
        if last < method.tolerance:
            break
    a = ((1.0 - m) * A + m * before.A - f * before.a) / (1.0 - f)
    s_rate = ((1.0 - m) * B + m * before.B - f * before.s_rate) / (1.0 - f)
    v = before.v + dt * ((1.0 - gamma) * before.A + gamma * A)
    step = dt * before.v + dt * dt * ((0.5 - beta) * before.A + beta * A)
    q = advance(tree, before.q, step, start.frames)
    for k in range(len(driven)):
        q[tree.q_at[np.searchsorted(tree.v_at, driven[k], side="right") - 1]] = q_d[k]
        v[driven[k]], a[driven[k]], A[driven[k]] = v_d[k], a_d[k], a_d[k]
    s = before.s + dt * ((1.0 - gamma) * before.B + gamma * B)
    error = dt * dt * abs(beta - 1.0 / 6.0) * np.max(np.abs((A - before.A)[free]))
    return last < method.tolerance, iteration + 1, error, Moment(q, v, a, A, s, s_rate, B)
