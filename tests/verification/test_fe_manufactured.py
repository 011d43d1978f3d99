"""Claim: at finite strain the displacement converges with the theoretical orders, k + 1 in L2 and k in the H1
seminorm, for degree k = 1 and 2, for both laws, on distorted (degree 2: curved) cells, with the default quadrature too.

Method: manufactured solution (Roache 2002). A displacement that vanishes on the surface of the unit cube and stretches
by up to 30 % is put into the first Piola-Kirchhoff stress P, written here from the textbook independently of the
solver (Bonet & Wood 2008, eqs. 6.28 and 6.29 with P = F S); the body force -Div P then has it as exact solution.
Source of the orders: Ciarlet (1978), theorems 3.2.2 and 3.2.5; quadrature exact for degree 2k - 1 along each axis keeps
them (4.1), which the two-point direction of the default rule is. Tolerance on the order: 0.15, fitted on three meshes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import Expr, fem, ufl
from reference_fe.domain import Domain
from reference_fe.hyperelastic import MaterialLaw
from reference_fe.increments import solve_increments
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.static_problem import Discretisation, ElementFamily, StaticProblem
from reference_fe.supports import BodyForce, Support
from tests.structured_hexahedra import block_mesh

RUBBER = Material(
    name="block", young_modulus=1e6, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="round numbers"
)
MESHES = {1: (6, 9, 13), 2: (4, 6, 9)}
LOAD_STEPS = (0.5, 1.0)
"""Two increments: the St. Venant-Kirchhoff energy has other equilibria, with crushed cells, and one increment with
mixed integration points ended there on some meshes (plain Newton did not)."""


def with_shear_modulus(factor: float) -> Material:
    """The same lambda, mu times a factor."""
    lam, mu = RUBBER.lame_lambda, factor * RUBBER.lame_mu
    E, nu = mu * (3.0 * lam + 2.0 * mu) / (lam + mu), lam / (2.0 * (lam + mu))
    return replace(RUBBER, young_modulus=E, poisson_ratio=nu)


def exact_displacement(X: Expr) -> Expr:
    """Zero on the surface of the unit cube, without symmetry, gradient up to about 0.3 [m]."""
    bubble = ufl.sin(ufl.pi * X[0]) * ufl.sin(ufl.pi * X[1]) * ufl.sin(ufl.pi * X[2])
    return bubble * ufl.as_vector((0.08, -0.05 * (1.0 + X[0]), 0.06 + 0.04 * X[1]))


def body_force(law: MaterialLaw, X: Expr) -> Expr:
    """-Div P of the exact displacement [N/m^3]."""
    lam, mu, eye = RUBBER.lame_lambda, RUBBER.lame_mu, ufl.Identity(3)
    F = eye + ufl.grad(exact_displacement(X))
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        E = 0.5 * (F.T * F - eye)
        return -ufl.div(F * (lam * ufl.tr(E) * eye + 2.0 * mu * E))
    F_inv_T = ufl.inv(F).T
    return -ufl.div(mu * (F - F_inv_T) + lam * ufl.ln(ufl.det(F)) * F_inv_T)


def distorted(X: NDArray[np.float64]) -> NDArray[np.float64]:
    """The unit cube with its inside moved smoothly: the same map on every mesh."""
    bubble = 0.06 * np.prod(np.sin(np.pi * X), axis=1)
    return X + bubble[:, None] * np.array([1.0, -0.7, 0.5])


def errors(law: MaterialLaw, cells: int, discretisation: Discretisation, material: Material) -> tuple[float, float]:
    """L2 norm [m^(5/2)] and H1 seminorm [m^(3/2)] of the displacement error."""
    mesh = block_mesh((cells,) * 3, distorted, order=discretisation.degree)
    problem = StaticProblem(
        Domain.from_tagged(mesh),
        {"body": material},
        [Support(faces=tuple(mesh.faces))],
        loads=[BodyForce(parts=("body",), field=lambda X: body_force(law, X))],
        discretisation=discretisation,
    )
    list(solve_increments(NewtonSolver(problem, NewtonSettings()), LOAD_STEPS, []))
    difference = problem.u - exact_displacement(ufl.SpatialCoordinate(problem.domain.mesh))
    dx = ufl.dx(domain=problem.domain.mesh, metadata={"quadrature_degree": 6})
    squares = [ufl.inner(difference, difference) * dx, ufl.inner(ufl.grad(difference), ufl.grad(difference)) * dx]
    value = [np.sqrt(fem.assemble_scalar(api.compile_form(square))) for square in squares]
    return float(value[0]), float(value[1])


def fitted_orders(
    law: MaterialLaw,
    discretisation: Discretisation,
    material: Material = RUBBER,
    counts: tuple[int, ...] | None = None,
) -> tuple[float, float]:
    """Slopes of log error against log cell size over three meshes: L2, H1."""
    counts = counts or MESHES[discretisation.degree]
    table = np.log([errors(law, cells, discretisation, material) for cells in counts])
    slope = np.polyfit(-np.log(counts), table, 1)[0]
    return float(slope[0]), float(slope[1])


@pytest.mark.slow
@pytest.mark.parametrize("law", list(MaterialLaw))
@pytest.mark.parametrize(
    ("degree", "gauss_points"),
    [(1, (2, 2, 2)), (2, (3, 3, 3)), (2, Discretisation().gauss_points)],
    ids=["degree 1", "degree 2", "degree 2, default rule"],
)
def test_orders_of_convergence(law: MaterialLaw, degree: int, gauss_points: tuple[int, int, int]) -> None:
    orders = fitted_orders(law, Discretisation(law=law, degree=degree, gauss_points=gauss_points))
    assert orders == pytest.approx((degree + 1.0, degree), abs=0.15)


@pytest.mark.slow
def test_serendipity_elements_reach_the_same_orders() -> None:
    """20-node shape functions with 2 x 2 x 2 points; the geometry is curved but smoothly so."""
    law = MaterialLaw.NEO_HOOKEAN
    choice = Discretisation(law=law, family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 2))
    assert fitted_orders(law, choice, counts=(6, 8, 11)) == pytest.approx((3.0, 2.0), abs=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("degree", [1, 2])
def test_a_wrong_shear_modulus_loses_the_order(degree: int) -> None:
    """Negative control: 25 % off in mu leaves an error that does not shrink with the mesh."""
    law = MaterialLaw.ST_VENANT_KIRCHHOFF
    gauss_points = (2, 2, 2) if degree == 1 else (3, 3, 3)
    choice = Discretisation(law=law, degree=degree, gauss_points=gauss_points)
    in_l2, in_h1 = fitted_orders(law, choice, with_shear_modulus(1.25))
    assert in_l2 < 0.5
    assert in_h1 < degree - 0.3
