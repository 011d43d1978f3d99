"""One step of the generalised-alpha method for a tree of bodies on tires, compiled.

Unknown are the accelerations a of the joint velocities v, M a + h = tau with the tires' wrenches in h and the motors'
torques in tau, and the rates of the tires' own states, s' = g. The method
(`rover_dynamics.multibody.generalised_alpha`) has accelerations A of its own, and rates B for the states:

    s = s_n + dt (1 - gamma) B_n + dt gamma B
    (1 - alpha_m) B + alpha_m B_n = (1 - alpha_f) s' + alpha_f s'_n

Newton's matrix is c M - sum J^T E J with c = (1 - alpha_m) / (1 - alpha_f), where J takes v to the hub's velocity and E
holds the derivatives of a tire's wrench by the hub's motion, the tire's states eliminated. Derivatives of M, h and J
are left out: the residual is exact, so that costs iterations and changes no result. A step takes the tires' derivatives
of the steps before it, up to fifty, while the same wheels touch the ground, and the matrix if its step was as long
(`linearisation`).

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled
from rover_dynamics.multibody.generalised_alpha import Method, newmark, step_frames
from rover_dynamics.multibody.rows import matrix, put_matrix, put_vector, vector
from rover_dynamics.multibody.small_matrices import product
from rover_dynamics.multibody.tree_arrays import TreeMotion, tree_memory
from rover_dynamics.multibody.tree_forces import bias_and_mass, needed_efforts
from rover_dynamics.multibody.tree_kernels import move_tree, tree_motion
from rover_dynamics.tires.brush_force import BrushResult, HubMotions
from rover_dynamics.vehicle.ground import tire_derivatives, tire_forces
from rover_dynamics.vehicle.implicit_method import Known, Moment
from rover_dynamics.vehicle.linearisation import changes, linearise
from rover_dynamics.vehicle.motor_kernels import add_motor_torques
from rover_dynamics.vehicle.system import Newton, System, Work

__all__ = ["evaluate", "hub_motions", "implicit_step"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_FRESH = 3
"""Iterations after which Newton's matrix is computed anew."""
_OLD = 0.1
"""Share of the tolerance that the last change must meet if the matrix is that of an earlier step."""


@compiled
def hub_motions(motion: TreeMotion, bodies: IntArray) -> HubMotions:
    """Motions of the wheels' bodies, whose rows are ``bodies`` (n_w,) int."""
    n = len(bodies)
    hubs = HubMotions(np.empty((n, 3)), np.empty((n, 3, 3)), np.empty((n, 3)), np.empty((n, 3)))
    for i in range(n):
        b = bodies[i]
        put_vector(hubs.position, i, vector(motion.positions, b, 0))
        put_matrix(hubs.rotation, i, matrix(motion.rotations, b))
        put_vector(hubs.velocity, i, vector(motion.velocities, b, 0))
        put_vector(hubs.angular_velocity, i, vector(motion.velocities, b, 3))
    return hubs


@compiled
def evaluate(
    system: System, q: FloatArray, v: FloatArray, s: FloatArray, result: BrushResult
) -> tuple[TreeMotion, HubMotions, FloatArray, FloatArray]:
    """Motion of links and hubs, bias forces with the tires' wrenches in them, and mass matrix; fills ``result``.

    Parameters
    ----------
    q, v : (n_q,), (n_v,) float, joint coordinates [rad, m, -] and velocities [rad/s, m/s]
    s : (n_w, n_s) float, states of the tires [m]

    Returns
    -------
    motion, hubs : of links and bodies, and of the wheels' hubs
    h, M : (n_v,), (n_v, n_v) float, of M a + h = tau [N m, N], [kg m^2, kg m, kg]
    """
    motion = tree_motion(system.tree, q, v)
    hubs, wrenches = _tires(system, motion, s, result)
    h, M = bias_and_mass(system.tree, motion, wrenches, system.gravity)
    return motion, hubs, h, M


@compiled
def _tires(system: System, motion: TreeMotion, s: FloatArray, result: BrushResult) -> tuple[HubMotions, FloatArray]:
    """Motions of the hubs, and the tires' wrenches on all bodies; fills ``result``."""
    tires = system.tires
    hubs, wrenches = hub_motions(motion, tires.bodies), np.zeros((len(system.tree.body_links), 6))
    tire_forces(hubs, s, tires, result)
    for i in range(len(tires.bodies)):
        for n in range(6):
            wrenches[tires.bodies[i], n] += result.wrench[i, n]
    return hubs, wrenches


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
def _residuals(
    system: System, after: Moment, known: Known, motion: TreeMotion, work: Work
) -> tuple[HubMotions, FloatArray, FloatArray, bool]:
    """Motions of the hubs, tau - h - M a, g - s', whether motors' slopes changed; fills ``motion`` and ``work``."""
    move_tree(system.tree, after.q, after.v, motion)
    hubs, wrenches = _tires(system, motion, after.s, work.result)
    residual = known.tau - needed_efforts(system.tree, motion, after.a, wrenches, system.gravity)
    changed = add_motor_torques(system.motors, known.asked, after.v, residual, work.slopes)
    return hubs, residual, work.result.rate - after.s_rate, changed


@compiled
def _correct(
    system: System, newton: Newton, residuals: tuple[FloatArray, FloatArray], A: FloatArray, B: FloatArray
) -> float:
    """Change A and B by one Newton correction; the largest change of A, infinite if there is none."""
    residual, state_residual = residuals
    n_w, n_s = state_residual.shape
    for i in range(n_w):
        for j in range(len(residual)):
            for k in range(n_s):
                residual[j] += newton.carry[i, j, k] * state_residual[i, k]
    found, change, largest = product(newton.inverse, residual[system.free]), np.zeros_like(A), 0.0
    for i in range(len(found)):
        if not np.isfinite(found[i]):
            return np.inf
        change[system.free[i]] = found[i]
        A[system.free[i]] += found[i]
        largest = max(largest, abs(found[i]))
    for i in range(n_w):
        B[i] += product(newton.states[i], state_residual[i])
        for j in system.free:
            for k in range(n_s):
                B[i, k] += newton.follow[i, j, k] * change[j]
    return largest


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
    A, B, motion = before.a.copy(), before.s_rate.copy(), tree_memory(system.tree)  # predictor: accelerations stay
    start = step_frames(system.tree, before.q, before.v)
    after = _end(system, before, start, (A, B), known, step_of)
    last, iteration = np.inf, 0
    while iteration < method.iterations and last >= limit:
        hubs, residual, state_residual, switched = _residuals(system, after, known, motion, work)
        other_length, due = changes(work.newton, dt, result.output)
        other_length = other_length or switched
        if due or iteration % _FRESH == _FRESH - 1:
            tire_derivatives(hubs, after.s, tires, work.derivatives)
            work.newton.made_for[1] = 0.0
            other_length, limit = True, method.tolerance
        if other_length:
            linearise(system, motion, work, weights)
        last = dt * dt * _correct(system, work.newton, (residual, state_residual), A, B)
        after = _end(system, before, start, (A, B), known, step_of)
        iteration += 1
    if not last < limit:
        work.newton.made_for[:] = -1.0  # from a state that is none
    error = 0.0
    for i in system.free:
        error = max(error, abs(A[i] - before.A[i]))
    return last < limit, iteration, method.error * dt * dt * error, after
