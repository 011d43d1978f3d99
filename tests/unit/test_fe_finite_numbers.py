"""No solution, residual or force that is no finite number passes for a state: each ends the attempt, and is told."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification import cantilever


class _Problem:
    """Two unknowns, the first one held; ``stiffness`` and ``force`` as given."""

    own_dofs, own_supported = 2, np.array([0])

    def __init__(self, force: float) -> None:
        self._force = force

    def contact_force(self) -> np.ndarray:
        return np.array([self._force, 0.0, 0.0])


@pytest.mark.parametrize("force", [np.inf, np.nan])
def test_forces_without_bound_do_not_pass_for_a_small_residual(force: float) -> None:
    """Out of balance by 1 N against infinite forces is no relative residual of 0."""
    problem: Any = _Problem(force)
    solver = NewtonSolver(problem, NewtonSettings())
    assert solver.relative(np.array([0.0, 1.0]), moved=False) == np.inf


@pytest.mark.parametrize("residual", [[np.inf, 1.0], [np.nan, 1.0], [0.0, np.inf], [1e200, 1.0]])
def test_residuals_that_are_no_numbers_neither(residual: list[float]) -> None:
    problem: Any = _Problem(1.0)
    assert NewtonSolver(problem, NewtonSettings()).relative(np.array(residual), moved=False) == np.inf


def test_a_displacement_that_is_no_number_never_reaches_the_contact_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Infinite solutions, as PETSc gives for a failed factorisation: the attempt fails with its reason."""
    solver, seen = _solver_of_a_beam(), list[bool]()
    monkeypatch.setattr("reference_fe.solver.direct.DirectSolver.solve", lambda self, b, x: x.set(np.inf))
    force = solver.problem.surfaces.force

    def looked_at(u: np.ndarray, rise: float) -> np.ndarray:
        seen.append(bool(np.isfinite(u).all()))
        return force(u, rise)

    monkeypatch.setattr(type(solver.problem.surfaces), "force", lambda self, u, rise: looked_at(u, rise))
    outcome = solver.solve()
    assert not outcome.converged
    assert "no finite number" in outcome.failure
    assert outcome.residuals[-1] == np.inf
    assert all(seen)


def _solver_of_a_beam() -> NewtonSolver:
    """A small cantilever with its end load on."""
    problem = cantilever._cantilever("shear", 4, None, cantilever.THICKNESS)
    problem.set_control(1.0)
    return NewtonSolver(problem, NewtonSettings())
