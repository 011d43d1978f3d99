"""Claim: the solid solver reproduces constant strain exactly, stores no energy in a rigid motion, and has no
hourglass modes. Source: patch test as in Bathe, Finite Element Procedures (1996), 4.4; a free solid has 6 rigid modes.
Tolerances: round-off (1e-9 of the stress or stiffness scale), since the solution lies in the finite element space.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from contracts.mesh import TaggedMesh
from reference_fe import dolfinx_api as api
from reference_fe.domain import Domain
from reference_fe.hyperelastic import MaterialLaw
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.static_problem import Discretisation, StaticProblem
from reference_fe.stress import StressRecovery
from reference_fe.supports import Support, Traction
from tests.structured_hexahedra import block_mesh

STEEL = Material(
    name="steel", young_modulus=200e9, poisson_ratio=0.3, density=7850.0, yield_strength=1e9, source="round numbers"
)


def distorted_cube(order: int = 2) -> TaggedMesh:
    """A 2 x 2 x 2 cube of side 1 m whose inner nodes are moved (curved cells at order 2)."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        bubble = 0.06 * np.prod(np.sin(np.pi * X), axis=1)
        return X + bubble[:, None] * np.array([1.0, -0.7, 0.5])

    return block_mesh((2, 2, 2), mapping, order)


@pytest.mark.parametrize("law", list(MaterialLaw))
@pytest.mark.parametrize("order", [1, 2])
def test_uniaxial_tension_gives_the_uniform_stress(law: MaterialLaw, order: int) -> None:
    """A dead traction of 0.1 % of E on a distorted mesh: uniform true stress, force over deformed area."""
    traction = 2.0e8
    supports = [Support(faces=(face,), components=(axis,)) for axis, face in enumerate(("x0", "y0", "z0"))]
    problem = StaticProblem(
        Domain.from_tagged(distorted_cube(order)),
        {"body": STEEL},
        supports,
        tractions=[Traction(faces=("x1",), vector=(traction, 0.0, 0.0))],
        discretisation=Discretisation(law=law, degree=order),
    )
    problem.set_control(1.0)
    outcome = NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-12)).solve()
    assert outcome.converged
    u = problem.nodal_displacement()
    stretch = 1.0 + u[:, 0].max()
    lateral = 1.0 + u[:, 1].min()
    recovery = StressRecovery(problem)
    stress = np.append(recovery.cell_stations().ravel(), recovery.nodal_von_mises())
    np.testing.assert_allclose(stress, traction / lateral**2, rtol=1e-7)  # true stress: force over deformed area
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:  # P = F S, S = E (F^2 - 1)/2: a cubic for the stretch
        assert STEEL.young_modulus * stretch * (stretch**2 - 1.0) / 2.0 == pytest.approx(traction, rel=1e-9)


def test_a_curved_mesh_reproduces_a_prescribed_linear_displacement() -> None:
    """Displacements of the outer faces from one linear field: the inside follows it to round-off."""
    mesh = distorted_cube()
    gradient = np.array([0.02, -0.01, 0.015])
    faces = ("x0", "x1", "y0", "y1", "z0", "z1")
    supports = [Support(faces=(f"{'xyz'[k]}1",), components=(k,), value=(gradient[k],)) for k in range(3)]
    supports += [Support(faces=(f"{'xyz'[k]}0",), components=(k,)) for k in range(3)]
    assert set(mesh.faces) == set(faces)
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": STEEL}, supports)
    problem.set_control(1.0)
    assert NewtonSolver(problem, NewtonSettings()).solve().converged
    np.testing.assert_allclose(problem.nodal_displacement(), mesh.points * gradient, atol=1e-10)


def test_rigid_rotation_stores_no_energy() -> None:
    """A rotation by 70 degrees about a skew axis leaves no internal force, on curved cells."""
    problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": STEEL}, [Support(faces=("x0",))])
    axis = np.array([1.0, 2.0, -1.0]) / np.sqrt(6.0)
    K = np.cross(np.eye(3), axis)
    R = np.eye(3) + np.sin(1.2) * K + (1.0 - np.cos(1.2)) * K @ K
    problem.u.interpolate(lambda x: (R - np.eye(3)) @ x)
    assert np.abs(problem.residual()).max() < 1e-12 * STEEL.young_modulus


def zero_energy_modes(gauss_points: tuple[int, int, int]) -> int:
    """Modes of one free 27-node hexahedron without stiffness; 6 rigid ones belong there."""
    mesh = block_mesh((1, 1, 1), lambda X: X * np.array([1.0, 0.8, 0.1]))
    discretisation = Discretisation(gauss_points=gauss_points)
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": STEEL}, [], discretisation=discretisation)
    matrix = problem.unsupported_tangent()
    indptr, indices, values = matrix.getValuesCSR()
    dense = np.zeros((problem.dofs, problem.dofs))
    for row in range(problem.dofs):
        dense[row, indices[indptr[row] : indptr[row + 1]]] = values[indptr[row] : indptr[row + 1]]
    stiffness = np.linalg.eigvalsh(0.5 * (dense + dense.T))
    return int(np.sum(stiffness < 1e-10 * stiffness[-1]))


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
