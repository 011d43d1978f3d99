"""A Newton step that finds the touching set: the body is linearised once, its contact forces are taken as they are.

Newton on body and contact together spends most of its factorisations on the question which points touch. Here only the
body is linearised about the last iterate u_k, with tangent K_B and residual R_B, and du solves

    R_B + K_B du - f(u_k + du) = 0        at the free unknowns,

f the contact forces, K_f = -df/du. An inner Newton iteration does: (K_B + K_f(u_k + du)) d = -r with r the left side,
then du <- du + a d. Its first matrix is the one that is factorised anyway; the others differ from it at the nodes of
the touching facets alone and share its factors (`solver.nearby`). As K_B d = -r - K_f d, the body's part of r is
carried along without a look at the body. The share a shortens a direction that goes too far: d . r, the slope of the
energy, must not rise above half its first size (Matthies & Strang, Int. J. Numer. Meth. Engng 14, 1979).

docs/theory.md 2.3 has the equations, benchmarks/README.md what it spares. Verified by
tests/unit/test_fe_contact_step.py and tests/verification/test_fe_wheel_iterations.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference_fe.problem.static_problem import StaticProblem
from reference_fe.solver import process_sums
from reference_fe.solver.nearby import NearbySolver

__all__ = ["settle_contact"]

type Array = NDArray[np.float64]

TOLERANCE = 1e-4
"""Norm of r, relative to that of the nodal contact forces, at which the touching set is found."""
LINEAR_TOLERANCE = 1e-2
"""Part of r that an inner linear solve may leave."""
INNER_LIMIT = 30
"""Inner iterations before the body is linearised anew, whether or not the touching set is found."""
CAPACITY = 60
"""Solves with one factorisation, after which a new one is worth its price."""
SEARCHES, SLOPE = 4, 0.5
"""Shortenings of a direction, and part of its first slope that suffices."""


def settle_contact(
    problem: StaticProblem, solve: Callable[[Array], Array], first_force: Array, free: NDArray[np.bool_]
) -> Array:
    """Improve ``problem.du`` until body and contact balance, as far as the body is linear.

    Parameters
    ----------
    problem : at u_k, with the plain Newton step in ``du``; its surface terms were last evaluated at u_k
    solve : inverse of the matrix that gave ``du``, times a vector (n_own_dofs,)
    first_force : contact forces in that step's right-hand side [N], lagged ones included
    free : (n_own_dofs,) unknowns without support

    Returns
    -------
    force : contact forces f(u_k + du), (n_own_dofs,) [N]; the surface terms were last evaluated there
    """
    step = _Step(problem, first_force, free)
    nearby = NearbySolver(solve, CAPACITY)
    for _ in range(INNER_LIMIT):
        residual = step.residual()
        size = process_sums.global_norm(residual)
        if nearby.full or not size > TOLERANCE * process_sums.global_norm(step.force):  # found, or not a number
            break
        direction, left = nearby.solve(-residual, step.change_of_stiffness(), LINEAR_TOLERANCE * size)
        step.advance(direction, left)
    return step.force


class _Step:
    """Step du, contact forces there, and those that the linearised body needs for balance."""

    def __init__(self, problem: StaticProblem, first_force: Array, free: NDArray[np.bool_]) -> None:
        self._problem, self._free = problem, free
        first_du = problem.du.x.array[: problem.own_dofs].copy()
        self._first_stiffness = problem.surfaces.stiffness()
        self._balancing = first_force - problem.surfaces.product(self._first_stiffness, first_du)
        self._move(first_du)

    def residual(self) -> Array:
        """r, (n_own_dofs,) [N]."""
        return np.where(self._free, self._balancing - self.force, 0.0)

    def change_of_stiffness(self) -> Callable[[Array], Array]:
        """Contact stiffness here minus that in the factors [N/m], times a vector (n_own_dofs,)."""
        surfaces, first, free = self._problem.surfaces, self._first_stiffness, self._free
        here = surfaces.stiffness()
        return lambda x: np.where(free, surfaces.product(here, x) - surfaces.product(first, x), 0.0)

    def advance(self, direction: Array, left: Array) -> None:
        """Add as much of a direction as the line search allows.

        direction : (n_own_dofs,) [m]
        left : (n_own_dofs,) [N], what its linear solve left over of -r
        """
        surfaces, residual, start, balancing = self._problem.surfaces, self.residual(), self._du, self._balancing
        body = -residual - left - surfaces.product(surfaces.stiffness(), direction)
        first, share = process_sums.global_dot(direction, residual), 1.0
        for attempt in range(SEARCHES + 1):
            self._balancing = balancing + share * body
            self._move(start + share * direction)
            slope = process_sums.global_dot(direction, self.residual())
            if first >= 0.0 or slope <= -SLOPE * first or attempt == SEARCHES:
                return
            share *= max(0.1, first / (first - slope))

    def _move(self, du: Array) -> None:
        """Go to du, (n_own_dofs,) [m], and take the contact forces there."""
        problem, self._du = self._problem, du
        problem.du.x.array[: problem.own_dofs] = du
        problem.du.x.scatter_forward()
        self.force = problem.surfaces.force(problem.u.x.array + problem.du.x.array, 0.0)
