"""Moment of the support forces: it balances that of the obstacle, at the deformed nodes."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.materials import Material
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.problem.balance import support_moment
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

RUBBER = Material(name="soft", young_modulus=1e6, poisson_ratio=0.3, density=1.0, yield_strength=1.0, source="test")


def pressed_column() -> tuple[StaticProblem, np.ndarray]:
    """A slender column held at its head, its foot pressed askew by a tilted plane; residual at the end."""
    tilt = (np.sin(0.3), 0.0, np.cos(0.3))
    mesh = block_mesh((1, 1, 3), lambda X: (X + np.array([1.0, -0.5, 0.0])) * [0.02, 0.02, 0.1])
    touch = float((mesh.points @ tilt).min())
    contact = ObstacleContact(faces=("z0",), normal=tilt, distance_at_touch=-touch, stiffness=1e9)
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": RUBBER}, [Support(faces=("z1",))], contact=contact)
    problem.set_control(0.004)
    outcome = NewtonSolver(problem, NewtonSettings()).solve(rise=0.004)
    assert outcome.converged
    return problem, outcome.residual


def test_support_and_contact_moments_balance() -> None:
    problem, residual = pressed_column()
    (term,) = problem.surfaces.terms
    moment = term.moment()  # type: ignore[attr-defined]
    assert abs(moment[1]) > 1e-4
    assert support_moment(problem, residual) + moment == pytest.approx(0.0, abs=1e-6 * abs(moment[1]))


def test_lever_arms_of_the_undeformed_body_are_caught() -> None:
    """Negative control: the supported nodes do not move, the foot does; at its old place its moment differs."""
    problem, residual = pressed_column()
    (term,) = problem.surfaces.terms
    term._last_x = term._facets.positions  # type: ignore[attr-defined]
    moment = term.moment()  # type: ignore[attr-defined]
    assert abs((support_moment(problem, residual) + moment)[1]) > 1e-3 * abs(moment[1])


def test_supports_that_move_balance_at_their_new_place() -> None:
    """A column whose head is drawn aside and up: without an obstacle its support moments add up to zero, deformed."""
    mesh = block_mesh((1, 1, 3), lambda X: (X + np.array([1.0, -0.5, 0.0])) * [0.02, 0.02, 0.1])
    supports = [Support(faces=("z0",)), Support(faces=("z1",), value=(0.01, 0.0, 0.005))]
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": RUBBER}, supports)
    problem.set_control(1.0)
    outcome = NewtonSolver(problem, NewtonSettings()).solve()
    assert outcome.converged
    largest = np.abs(outcome.residual).max() * 0.1
    assert largest > 1e-4
    assert support_moment(problem, outcome.residual) == pytest.approx(0.0, abs=1e-6 * largest)
    problem.u.x.array[:] = 0.0  # negative control: the same forces at their old places
    assert np.abs(support_moment(problem, outcome.residual)).max() > 1e-2 * largest
