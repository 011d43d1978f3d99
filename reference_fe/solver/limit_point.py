"""Tells a limit point, where equilibrium ends, from an iteration that fails: by the tangent's lowest eigenvalue.

Along a path that turns at the control parameter c* the eigenvalue mu nearest to zero goes as mu^2 = k (c* - c), and its
mode does work on what the control parameter drives; at a branch point it goes as mu = k (c* - c) and does none
(Wriggers, Wagner & Miehe 1988, from memory). Both are measured at the last two converged states, with the consistent
tangent there; zero must lie where increments fail, or before that for a branch, over which a run can go.

What depends on the displacement is smooth along the path, so linear in mu: the force of an obstacle or of supports that
move comes to F* = (F - left F_before) / (1 - left), left = mu / mu_before. What supports carry of dead loads goes as c.
docs/theory/finite_elements.md, "Past limit points". Verified by tests/verification/test_fe_limit_point.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh_tridiagonal

from contracts.errors import LimitLoad
from reference_fe.problem.control_rate import control_rate, depends_on_the_way
from reference_fe.problem.problem_state import ProblemState
from reference_fe.solver import process_sums
from reference_fe.solver.direct import SingularMatrixError
from reference_fe.solver.newton import NewtonSolver

__all__ = ["Mode", "limit_point", "lowest_mode"]

type Array = NDArray[np.float64]

REACH, CLOSE = 4.0, 0.05
"""Failed increments, and share of the last converged one, within which beyond it the eigenvalue must reach zero."""
SAME = 0.9
"""Cosine between the modes at the two states from which they are one."""
NO_WORK = 1e-6
"""Cosine of mode and drive below which the drive does no work on it: a branch point."""
STEPS, ACCURACY = 40, 1e-9
"""Lanczos steps at most, and the relative residual of the eigenvalue that ends them."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mode:
    """Eigenvector of the tangent with the eigenvalue nearest to zero.

    Attributes
    ----------
    stiffness : eigenvalue, of the tangent at free unknowns [N/m]
    shape : (n_own_dofs,) of unit length, zero at supports [-]
    negative : negative eigenvalues of the tangent
    work : cosine of the shape and the force that a unit of the control parameter is worth [-]
    """

    stiffness: float
    shape: Array
    negative: int
    work: float


def limit_point(
    solver: NewtonSolver, earlier: tuple[float, ProblemState], last: tuple[float, ProblemState], failed: float
) -> LimitLoad | None:
    """What is known of the limit or branch point that ended a run; None if the eigenvalues do not show one.

    None for friction, multipliers and material with a memory too: their tangent at a state depends on how it was
    reached; and for an obstacle that does not only rise. Leaves the problem in the last state.

    Parameters
    ----------
    earlier, last : control parameter and state of the last two converged increments, the second larger
    failed : length of the increment from the last state that did not converge [unit of the control parameter]
    """
    problem = solver.problem
    if depends_on_the_way(problem) or (problem.contact is not None and problem.contact.travel is not None):
        return None
    begin = (last[1].displacement - earlier[1].displacement)[: problem.own_dofs]
    if process_sums.global_norm(np.where(solver.free, begin, 0.0)) == 0.0:  # nothing has moved yet
        return None
    found = list[tuple[Mode, Array]]()
    try:
        for at in (earlier, last):
            mode = lowest_mode(solver, *at, begin=begin)
            found.append((mode, _driving_force(solver)))
    except SingularMatrixError:
        return None
    (before, force_before), (now, force) = found
    left, branch = now.stiffness / before.stiffness, abs(now.work) < NO_WORK
    if abs(process_sums.global_dot(before.shape, now.shape)) < SAME or left >= 1.0 or (left < 0.0 and not branch):
        return None
    share = left if branch else left**2
    way = share / (1.0 - share) * (last[0] - earlier[0])
    if way > max(REACH * failed, CLOSE * (last[0] - earlier[0])):
        return None
    beyond = share if _dead(solver) else left
    part, place = _moves_most(solver, now.shape)
    return LimitLoad(
        branch=branch,
        control=last[0] + way,
        load=float(np.linalg.norm(force - beyond * force_before) / (1.0 - beyond)),
        left=left,
        part=part,
        place=place,
    )


def lowest_mode(solver: NewtonSolver, control: float, state: ProblemState, *, begin: Array) -> Mode:
    """The eigenvalue nearest to zero at a converged state and its mode, by Lanczos on the inverse.

    Leaves the problem in that state.

    Parameters
    ----------
    control, state : where
    begin : (n_own_dofs,) a guess of the shape

    Raises
    ------
    SingularMatrixError
        If the tangent has no inverse.
    """
    problem = solver.problem
    problem.restore(state)
    problem.set_control(control)
    problem.store_stress(extrapolate=False)
    problem.surfaces.force(problem.u.x.array, 0.0)
    force, moved = control_rate(problem, control, problem.body_residual())
    lifted = solver.factorise(moved if process_sums.global_norm(moved) > 0.0 else np.zeros(0))
    force = np.where(solver.free, force + lifted if lifted.size else force, 0.0)
    negative = solver.negative_pivots
    assert negative is not None
    basis, diagonal, beside = [_unit(np.where(solver.free, begin, 0.0))], list[float](), list[float]()
    while True:
        new = np.where(solver.free, solver.solved(basis[-1]), 0.0)
        diagonal.append(process_sums.global_dot(new, basis[-1]))
        for _ in range(2):
            for one in basis:
                new = new - process_sums.global_dot(new, one) * one
        values, vectors = eigh_tridiagonal(diagonal, beside)
        k, size = int(np.argmax(np.abs(values))), process_sums.global_norm(new)
        error = size * abs(vectors[-1, k])
        if len(basis) == STEPS or error <= ACCURACY * abs(values[k]):
            break
        beside.append(size)
        basis.append(new / size)
    shape = _unit(np.asarray(sum(c * one for c, one in zip(vectors[:, k], basis, strict=True))))
    drive = process_sums.global_norm(force)
    work = process_sums.global_dot(shape, force) / drive if drive else 0.0
    return Mode(stiffness=float(1.0 / values[k]), shape=shape, negative=negative, work=work)


def _driving_force(solver: NewtonSolver) -> Array:
    """Of the obstacle, of the supports that move, or of all supports, whichever drives; now, (dim,) [N]."""
    problem, dim = solver.problem, solver.problem.domain.dim
    if problem.contact is not None:
        return problem.contact_force()
    residual = problem.residual()
    moving = _moving(solver)
    if not moving:
        return problem.reaction(residual)
    rows = np.unique(np.concatenate(moving))
    rows = rows[rows < problem.own_dofs]
    own = np.array([residual[rows[rows % dim == axis]].sum() for axis in range(dim)])
    return np.asarray(problem.domain.mesh.comm.allreduce(own))


def _moving(solver: NewtonSolver) -> list[NDArray[np.int32]]:
    """Unknowns of the supports that move."""
    return [one.dofs for one in solver.problem.prescribed if one.at_load_factor_1]


def _dead(solver: NewtonSolver) -> bool:
    """Whether loads alone drive: dead ones, so that all supports together carry what goes as the control parameter."""
    return solver.problem.contact is None and not _moving(solver)


def _unit(vector: Array) -> Array:
    return np.asarray(vector / process_sums.global_norm(vector))


def _moves_most(solver: NewtonSolver, shape: Array) -> tuple[str, tuple[float, ...]]:
    """Part and reference place [m] of the node that a shape moves most."""
    problem, tagged = solver.problem, solver.problem.domain.tagged
    kept = problem.u.x.array.copy()
    problem.u.x.array[: problem.own_dofs] = shape
    problem.u.x.scatter_forward()
    node = int(np.argmax(np.linalg.norm(problem.nodal_displacement(), axis=1)))
    problem.u.x.array[:] = kept
    tags = tagged.cell_tags[(tagged.cells == node).any(axis=1)]
    part = next(name for name, tag in tagged.parts.items() if tag in tags)
    return part, tuple(float(x) for x in tagged.points[node])
