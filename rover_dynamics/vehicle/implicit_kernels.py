"""One step of the generalised-alpha method for a tree of bodies on tires, compiled.

Unknown are the accelerations a of the joint velocities v, M a + h = tau with the tires' wrenches in h, and the rates of
the tires' own states, s' = g. The method (`rover_dynamics.multibody.generalised_alpha`) has accelerations A of its
own, and rates B for the states:

    s = s_n + dt (1 - gamma) B_n + dt gamma B
    (1 - alpha_m) B + alpha_m B_n = (1 - alpha_f) s' + alpha_f s'_n

Newton's matrix is c M - sum J^T E J with c = (1 - alpha_m) / (1 - alpha_f), where J takes v to the hub's velocity and E
holds the derivatives of a tire's wrench by the hub's motion, the tire's states eliminated. Derivatives of M, h and J
are left out: the residual is exact, so that costs iterations and changes no result. A step takes the matrix of the
step before it if that was as long and the same wheels touched the ground.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.brush_derivatives import brush_derivatives
from rover_dynamics.brush_force import BrushResult, HubMotions, brush_forces
from rover_dynamics.multibody.compiled import compiled, cross
from rover_dynamics.multibody.generalised_alpha import Method, newmark, step_frames
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion, bias_and_mass, tree_motion
from rover_dynamics.vehicle.implicit_method import Known, Moment
from rover_dynamics.vehicle.system import Newton, System, Work

__all__ = ["evaluate", "implicit_step"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_FRESH = 3
"""Iterations after which Newton's matrix is computed anew."""
_OLD = 0.1
"""Share of the tolerance that the last change must meet if the matrix is that of an earlier step."""
_SAME = 0.01
"""Relative difference of two steps' lengths that may share a matrix."""


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
def _linearise(
    system: System, motion: TreeMotion, M: FloatArray, work: Work, weights: tuple[float, float, float]
) -> None:
    """Fill ``work.newton`` from the tires' derivatives.

    Parameters
    ----------
    weights : c; dt gamma, the derivative of v by A; dt^2 beta, that of the step
    """
    c, w_v, w_q = weights
    n_v, n_s = len(M), work.derivatives.shape[1] - 6
    matrix, J = c * M, np.empty((6, n_v))
    _, carry, follow, inverse, _ = work.newton
    for i in range(len(work.derivatives)):
        D = work.derivatives[i]
        _wheel_jacobian(system.tree, motion, system.tires.bodies[i], J)
        by_motion = w_q * D[:, :6].copy() + w_v * D[:, 6:12].copy()
        by_state = w_v * D[:, 12:].copy()
        inverse[i] = np.linalg.inv(c * np.eye(n_s) - by_state[6:])
        states = inverse[i] @ by_motion[6:]
        E = by_motion[:6] + by_state[:6] @ states
        follow[i] = states @ J
        carry[i] = J.T @ (by_state[:6] @ inverse[i])
        matrix -= J.T @ (E @ J)
    work.newton.matrix[:] = matrix[system.free][:, system.free]


@compiled
def _fits(newton: Newton, dt: float, loads: FloatArray) -> bool:
    """Whether an earlier linearisation serves a step; notes its length and the wheels that touch."""
    made_for, same = newton.made_for, bool(abs(newton.made_for[0] - dt) <= _SAME * dt)
    made_for[0] = dt
    for i in range(len(loads)):
        touches = 1.0 if loads[i] > 0.0 else 0.0
        same = same and made_for[1 + i] == touches
        made_for[1 + i] = touches
    return same


@compiled
def _end(
    system: System,
    before: Moment,
    start: tuple[FloatArray, FloatArray],
    method_rates: tuple[FloatArray, FloatArray],
    known: Known,
    step_of: tuple[float, Method],
) -> Moment:
    """The end of a step for the method's A and B; ``start`` is what `step_frames` returns."""
    A, B = method_rates
    dt, method = step_of
    m, f, gamma = method.alpha_m, method.alpha_f, method.gamma
    a = ((1.0 - m) * A + m * before.A - f * before.a) / (1.0 - f)
    s_rate = ((1.0 - m) * B + m * before.B - f * before.s_rate) / (1.0 - f)
    q, v = newmark(system.tree, (before.q, before.v, before.A), A, start, step_of)
    s = before.s + dt * ((1.0 - gamma) * before.B + gamma * B)
    for k in range(len(system.driven)):
        i = system.driven[k]
        q[system.driven_q[k]], v[i], a[i], A[i] = known.q[k], known.v[k], known.a[k], known.a[k]
    return Moment(q, v, a, A, s, s_rate, B)


@compiled
def _correct(
    system: System, newton: Newton, residuals: tuple[FloatArray, FloatArray], A: FloatArray, B: FloatArray
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
    system: System, before: Moment, known: Known, dt: float, method: Method, work: Work
) -> tuple[bool, int, float, Moment]:
    """One step.

    Parameters
    ----------
    before : where it starts
    known : what is prescribed at the end
    dt : [s]
    work : overwritten

    Returns
    -------
    converged, iterations : of Newton's method
    error : leading term of the local error of the free joint coordinates, largest entry [m, rad]; the tires' states
        have no part in it
    after : the end of the step
    """
    weights = (1.0 - method.alpha_m) / (1.0 - method.alpha_f), dt * method.gamma, dt * dt * method.beta
    tires, result, step_of, limit = system.tires, work.result, (dt, method), _OLD * method.tolerance
    A, B = before.a.copy(), before.s_rate.copy()  # predictor: accelerations stay
    start = step_frames(system.tree, before.q, before.v)
    after = _end(system, before, start, (A, B), known, step_of)
    last, iteration = np.inf, 0
    while iteration < method.iterations and last >= limit:
        motion, hubs, h, M = evaluate(system, after.q, after.v, after.s, result)
        residuals = known.tau - h - M @ after.a, result.rate - after.s_rate
        if not _fits(work.newton, dt, result.output[:, 1]) or iteration % _FRESH == _FRESH - 1:
            memory = tires.scratch, tires.pair
            brush_derivatives(hubs, after.s, tires.numbers, tires.pieces, work.derivatives, memory)
            _linearise(system, motion, M, work, weights)
            limit = method.tolerance
        last = dt * dt * _correct(system, work.newton, residuals, A, B)
        after = _end(system, before, start, (A, B), known, step_of)
        iteration += 1
    error = method.error * dt * dt * np.max(np.abs((A - before.A)[system.free]))
    return last < limit, iteration, error, after
