"""Claim: the solid solver reproduces constant strain exactly, stores no energy in a rigid motion, and has no
hourglass modes. Source: patch test as in Bathe, Finite Element Procedures (1996), 4.4; a free solid has 6 rigid modes.
Tolerances: round-off (1e-9 of the stress or stiffness scale), since the solution lies in the finite element space.
The model is reference_fe/verification/patch.py.
"""

from __future__ import annotations

import numpy as np
import pytest

from reference_fe import dolfinx_api as api
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.patch import (
    STEEL,
    distorted_cube,
    linear_field_error,
    rigid_rotation_force,
    uniaxial_tension,
    zero_energy_modes,
)


@pytest.mark.parametrize("law", list(MaterialLaw))
@pytest.mark.parametrize("order", [1, 2])
def test_uniaxial_tension_gives_the_uniform_stress(law: MaterialLaw, order: int) -> None:
    """A dead traction of 0.1 % of E on a distorted mesh: uniform true stress, force over deformed area."""
    found = uniaxial_tension(law, order)
    assert found.error < 1e-7
    principal = found.principal_stress * found.lateral**2 / found.traction
    np.testing.assert_allclose(principal, np.tile([1.0, 0.0, 0.0], (len(principal), 1)), atol=1e-7)
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:  # P = F S, S = E (F^2 - 1)/2: a cubic for the stretch
        stress = STEEL.young_modulus * found.stretch * (found.stretch**2 - 1.0) / 2.0
        assert stress == pytest.approx(found.traction, rel=1e-9)


def test_a_curved_mesh_reproduces_a_prescribed_linear_displacement() -> None:
    """Displacements of the outer faces from one linear field: the inside follows it to round-off."""
    assert linear_field_error() < 1e-10


def test_rigid_rotation_stores_no_energy() -> None:
    """A rotation by 70 degrees about a skew axis leaves no internal force, on curved cells."""
    assert rigid_rotation_force() < 1e-12


def test_a_stretch_is_not_taken_for_a_rotation() -> None:
    """Negative control: one part in a million of stretch on top of the rotation is seen."""
    assert rigid_rotation_force(stretch=1.0 + 1e-6) > 1e-8


@pytest.mark.parametrize("gauss_points", [Discretisation().gauss_points, (3, 3, 3)])
def test_the_default_quadrature_leaves_only_the_rigid_modes(gauss_points: tuple[int, int, int]) -> None:
    assert zero_energy_modes(gauss_points) == 6


def test_hourglassing_quadrature_is_caught() -> None:
    """Negative control: with 2x2x2 points the same count finds 27 zero-energy modes beyond the rigid ones."""
    assert zero_energy_modes((2, 2, 2)) == 6 + 27


def test_tangent_is_the_derivative_of_the_residual() -> None:
    """Central differences of the residual, plain Newton tangent (the mixed one differs by design), both laws."""
    for law in MaterialLaw:
        choice = Discretisation(law=law, mixed_integration_points=False)
        problem = StaticProblem(
            Domain.from_tagged(distorted_cube()), {"body": STEEL}, [Support(faces=("x0",))], discretisation=choice
        )
        rng = np.random.default_rng(1)
        base = 0.02 * rng.standard_normal(problem.dofs)
        direction = rng.standard_normal(problem.dofs)
        problem.u.x.array[:] = base
        matrix = problem.unsupported_tangent()
        x, y = matrix.createVecRight(), matrix.createVecLeft()
        x.array[:] = direction
        matrix.mult(x, y)
        h = 1e-6
        problem.u.x.array[:] = base + h * direction
        forward = problem.residual()
        problem.u.x.array[:] = base - h * direction
        difference = (forward - problem.residual()) / (2.0 * h)
        np.testing.assert_allclose(y.array, difference, rtol=0.0, atol=1e-6 * np.abs(difference).max())


@pytest.mark.parametrize(("law", "spurious"), [("st_venant_kirchhoff", True), ("neo_hookean", False)])
def test_a_state_beyond_the_law_is_not_taken_for_a_solution(law: str, spurious: bool) -> None:
    """A cube pressed to half its height balances with either law; St. Venant-Kirchhoff's answer is refused."""
    supports = [Support(faces=(face,), components=(axis,)) for axis, face in enumerate(("x0", "y0", "z0"))]
    supports.append(Support(faces=("x1",), components=(0,), value=(-0.5,)))
    choice = Discretisation(law=MaterialLaw(law), degree=1)
    problem = StaticProblem(Domain.from_tagged(distorted_cube(1)), {"body": STEEL}, supports, discretisation=choice)
    problem.set_control(1.0)
    outcome = NewtonSolver(problem, NewtonSettings()).solve()
    assert outcome.residuals[-1] < 1e-8
    assert problem.smallest_stretch() == pytest.approx(0.5, rel=1e-6)
    assert (outcome.spurious, outcome.converged) == (spurious, not spurious)


def test_versions_are_reported() -> None:
    assert set(api.versions()) == {"dolfinx", "petsc", "basix"}
