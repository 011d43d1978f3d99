"""One step of the generalised-alpha method for a tree of bodies on tires, compiled.

Unknown are the accelerations a of the joint velocities v, M a + h = tau with the tires' wrenches in h, and the rates of
the tires' own states, s' = g. The method (Chung and Hulbert 1993; Arnold and Bruels 2007; in joint
coordinates: quaternions are turned by rotation vectors) has accelerations A and rates B of its own:

    step = dt v_n + dt^2 (1/2 - beta) A_n + dt^2 beta A,    v = v_n + dt (1 - gamma) A_n + dt gamma A
    s = s_n + dt (1 - gamma) B_n + dt gamma B
    (1 - alpha_m) A + alpha_m A_n = (1 - alpha_f) a + alpha_f a_n,    the same for B and s'

Newton's matrix is c M - sum J^T E J with c = (1 - alpha_m) / (1 - alpha_f), where J takes v to the hub's velocity and E
holds the derivatives of a tire's wrench by the hub's motion, the tire's states eliminated. Derivatives of M, h and J
are left out: the residual is exact, so that costs iterations and changes no result.

Verified by tests/verification/test_vehicle_step.py.
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
from rover_dynamics.multibody.tree_kernels import LinkKind, Tree, TreeMotion, advance, bias_and_mass, tree_motion
from rover_dynamics.vehicle.implicit_method import Known, Method, Moment

__all__ = ["System", "Tires", "evaluate", "implicit_step"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_SPHERICAL = int(LinkKind.SPHERICAL)
_FRESH = 4
"""Iterations after which Newton's matrix is computed anew."""


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


class System(NamedTuple):
    """What does not change in time.

    Attributes
    ----------
    tree, tires : of the vehicle
    gravity : (3,) float, acceleration of free fall [m/s^2]
    free, driven : (n_f,), (n_d,) int, velocities that are unknown, and those that follow laws
    driven_q : (n_d,) int, coordinates of the driven velocities
    """

    tree: Tree
    tires: Tires
    gravity: FloatArray
    free: IntArray
    driven: IntArray
    driven_q: IntArray


class _Newton(NamedTuple):
    """One linearisation.

    Attributes
    ----------
    matrix : (n_f, n_f) float, c M - sum J^T E J of the free velocities
    carry : (n_w, n_v, n_s) float, what a residual of the states adds to that of the accelerations
    follow, inverse : (n_w, n_s, n_v), (n_w, n_s, n_s) float, change of B for that of A, and for the states' residual
    """

    matrix: FloatArray
    carry: FloatArray
    follow: FloatArray
    inverse: FloatArray


@compiled
def hub_motions(motion: TreeMotion, bodies: IntArray) -> HubMotions:
    """Motions of the wheels' bodies."""
    n = len(bodies)
    r, R, v, w = np.empty((n, 3)), np.empty((n, 3, 3)), np.empty((n, 3)), np.empty((n, 3))
    for i in range(n):
        b = bodies[i]
        r[i], R[i], v[i], w[i] = (
            motion.positions[b],
            motion.rotations[b],
            motion.velocities[b, :3],
            motion.velocities[b, 3:],
        )
    return HubMotions(r, R, v, w)


@compiled
def evaluate(
    system: System, q: FloatArray, v: FloatArray, s: FloatArray, result: BrushResult
) -> tuple[TreeMotion, HubMotions, FloatArray, FloatArray]:
    """Motion of links and hubs, bias forces with the tires' wrenches in them, and mass matrix; fills ``result``."""
    tree, tires = system.tree, system.tires
    motion = tree_motion(tree, q, v)
    hubs = hub_motions(motion, tires.bodies)
    brush_forces(hubs, s, tires.numbers, tires.pieces, result, tires.scratch)
    wrenches = np.zeros((len(tree.body_links), 6))
    for i in range(len(tires.bodies)):
        wrenches[tires.bodies[i]] += result.wrench[i]
    h, M = bias_and_mass(tree, motion, wrenches, system.gravity)
    return motion, hubs, h, M


@compiled
def _wheel_jacobian(tree: Tree, motion: TreeMotion, body: int, J: FloatArray) -> None:
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
def _newton(
    system: System, motion: TreeMotion, M: FloatArray, derivatives: FloatArray, weights: tuple[float, float, float]
) -> _Newton:
    """Linearise about a motion.

    Parameters
    ----------
    derivatives : (n_w, 6 + n_s, 12 + n_s) float, of `brush_derivatives`
    weights : c; dt gamma, the derivative of v by A; dt^2 beta, that of the step
    """
    c, w_v, w_q = weights
    n_w, n_v, n_s = len(derivatives), len(M), derivatives.shape[1] - 6
    matrix, J = c * M, np.empty((6, n_v))
    carry, follow, inverse = np.zeros((n_w, n_v, n_s)), np.zeros((n_w, n_s, n_v)), np.zeros((n_w, n_s, n_s))
    for i in range(n_w):
        D = derivatives[i]
        _wheel_jacobian(system.tree, motion, system.tires.bodies[i], J)
        by_motion = w_q * D[:, :6].copy() + w_v * D[:, 6:12].copy()
        by_state = w_v * D[:, 12:].copy()
        inverse[i] = np.linalg.inv(c * np.eye(n_s) - by_state[6:])
        states = inverse[i] @ by_motion[6:]
        E = by_motion[:6] + by_state[:6] @ states
        follow[i] = states @ J
        carry[i] = J.T @ (by_state[:6] @ inverse[i])
        matrix -= J.T @ (E @ J)
    return _Newton(matrix[system.free][:, system.free], carry, follow, inverse)


@compiled
def _turning(tree: Tree, motion: TreeMotion, v: FloatArray) -> FloatArray:
    """Factor of dt^2 in the step, (n_v,), since ball joints count in frames that turn with their carriers.

    The rate of F^T w is F^T (w' - W x w), with W the carrier's angular velocity, and not F^T w'.
    """
    out = np.zeros_like(v)
    for k in range(len(tree.parents)):
        if tree.kinds[k] == _SPHERICAL:
            at = tree.v_at[k]
            cross(-0.5 * motion.V[tree.parents[k], :3], v[at : at + 3], out[at : at + 3])
    return out


@compiled
def _end(
    system: System,
    before: Moment,
    start: tuple[FloatArray, FloatArray],
    method_rates: tuple[FloatArray, FloatArray],
    known: Known,
    step_of: tuple[float, Method],
) -> Moment:
    """The end of a step for the method's A and B; ``start``: the joint frames there, and what `_turning` returns."""
    A, B = method_rates
    frames, turning = start
    dt, method = step_of
    m, f, beta, gamma = method.alpha_m, method.alpha_f, method.beta, method.gamma
    a = ((1.0 - m) * A + m * before.A - f * before.a) / (1.0 - f)
    s_rate = ((1.0 - m) * B + m * before.B - f * before.s_rate) / (1.0 - f)
    v = before.v + dt * ((1.0 - gamma) * before.A + gamma * A)
    step = dt * before.v + dt * dt * ((0.5 - beta) * before.A + beta * A) + dt * dt * turning
    s = before.s + dt * ((1.0 - gamma) * before.B + gamma * B)
    q = advance(system.tree, before.q, step, frames)
    for k in range(len(system.driven)):
        i = system.driven[k]
        q[system.driven_q[k]], v[i], a[i], A[i] = known.q[k], known.v[k], known.a[k], known.a[k]
    return Moment(q, v, a, A, s, s_rate, B)


@compiled
def _correct(
    system: System, newton: _Newton, residuals: tuple[FloatArray, FloatArray], A: FloatArray, B: FloatArray
) -> float:
    """Change A and B by one Newton correction; the largest change of A, infinite if there is none."""
    residual, state_residual = residuals
    for i in range(len(state_residual)):
        residual += newton.carry[i] @ state_residual[i]
    if not np.all(np.isfinite(residual)):
        return np.inf
    change = np.zeros_like(A)
    change[system.free] = np.linalg.solve(newton.matrix, residual[system.free])
    A += change
    for i in range(len(state_residual)):
        B[i] += newton.inverse[i] @ state_residual[i] + newton.follow[i] @ change
    return float(np.max(np.abs(change)))


@compiled
def implicit_step(
    system: System, before: Moment, known: Known, dt: float, method: Method, result: BrushResult
) -> tuple[bool, int, float, Moment]:
    """One step.

    Parameters
    ----------
    before : where it starts
    known : what is prescribed at the end
    dt : [s]
    result : overwritten

    Returns
    -------
    converged, iterations : of Newton's method
    error : leading term of the local error of the free joint coordinates, largest entry [m, rad]; the tires' states
        have no part in it
    after : the end of the step
    """
    weights = (1.0 - method.alpha_m) / (1.0 - method.alpha_f), dt * method.gamma, dt * dt * method.beta
    tires, n_s, step_of = system.tires, before.s.shape[1], (dt, method)
    A, B = before.a.copy(), before.s_rate.copy()  # predictor: accelerations stay
    motion = tree_motion(system.tree, before.q, before.v)
    start = motion.frames, _turning(system.tree, motion, before.v)
    derivatives = np.zeros((len(tires.bodies), 6 + n_s, 12 + n_s))
    after = _end(system, before, start, (A, B), known, step_of)
    last, iteration = np.inf, 0
    while iteration < method.iterations and last >= method.tolerance:
        motion, hubs, h, M = evaluate(system, after.q, after.v, after.s, result)
        residuals = known.tau - h - M @ after.a, result.rate - after.s_rate
        if iteration % _FRESH == 0:
            brush_derivatives(hubs, after.s, tires.numbers, tires.pieces, derivatives, (tires.scratch, tires.pair))
            newton = _newton(system, motion, M, derivatives, weights)
        last = dt * dt * _correct(system, newton, residuals, A, B)
        after = _end(system, before, start, (A, B), known, step_of)
        iteration += 1
    error = method.error * dt * dt * np.max(np.abs((A - before.A)[system.free]))
    return last < method.tolerance, iteration, error, after
