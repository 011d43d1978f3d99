"""A manufactured displacement at finite strain: errors on refined meshes, which must fall with the theoretical orders.

Method: Roache (2002). A displacement that vanishes on the surface of the unit cube and stretches by up to 30 % is put
into the first Piola-Kirchhoff stress P, written here from the textbook independently of the solver (Bonet & Wood 2008,
eqs. 6.28 and 6.29 with P = F S); the body force -Div P then has it as exact solution. Orders: k + 1 in L2 and k in the
H1 seminorm for degree k (Ciarlet 1978, theorems 3.2.2 and 3.2.5), with a quadrature exact for degree 2k - 1 along each
axis (4.1). Verified by tests/verification/test_fe_manufactured.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import Expr, fem, ufl
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import BodyForce, Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["MESHES", "RUBBER", "Convergence", "convergence", "with_shear_modulus"]

RUBBER = Material(
    name="block", young_modulus=1e6, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="round numbers"
)
MESHES = {1: (6, 9, 13), 2: (4, 6, 9)}
"""Degree -> cells along each edge of the cube."""
LOAD_STEPS = (0.5, 1.0)
"""Two increments: the St. Venant-Kirchhoff energy has other equilibria, with crushed cells, and one increment with
mixed integration points ended there on some meshes (plain Newton did not)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Convergence:
    """Errors of the displacement on n meshes.

    Attributes
    ----------
    cells : (n,) int, along each edge of the unit cube
    l2, h1 : (n,) float, L2 norm [m^(5/2)] and H1 seminorm [m^(3/2)] of the error
    iterations : linear solves in all
    """

    cells: NDArray[np.int64]
    l2: NDArray[np.float64]
    h1: NDArray[np.float64]
    iterations: int

    @property
    def orders(self) -> tuple[float, float]:
        """Slopes of log error against log cell size: L2, H1 [-]."""
        slope = np.polyfit(-np.log(self.cells), np.log(np.column_stack([self.l2, self.h1])), 1)[0]
        return float(slope[0]), float(slope[1])


def convergence(
    discretisation: Discretisation, material: Material = RUBBER, counts: Sequence[int] | None = None
) -> Convergence:
    """Solve on each mesh; the body force is always that of `RUBBER`."""
    cells = counts or MESHES[discretisation.degree]
    rows = [_errors(discretisation, material, count) for count in cells]
    l2, h1, iterations = zip(*rows, strict=True)
    return Convergence(cells=np.array(cells), l2=np.array(l2), h1=np.array(h1), iterations=sum(iterations))


def with_shear_modulus(factor: float) -> Material:
    """`RUBBER` with the same lambda and mu times a factor [-]: a damaged material, as negative control."""
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
    """Places (n, 3) [m] of points (n, 3) [-] of the unit cube, its inside moved smoothly: one map for all meshes."""
    bubble = 0.06 * np.prod(np.sin(np.pi * X), axis=1)
    return np.asarray(X + bubble[:, None] * np.array([1.0, -0.7, 0.5]))


def _errors(discretisation: Discretisation, material: Material, cells: int) -> tuple[float, float, int]:
    """L2 norm, H1 seminorm and linear solves on one mesh."""
    mesh = block_mesh((cells,) * 3, distorted, order=discretisation.degree)
    problem = StaticProblem(
        Domain.from_tagged(mesh),
        {"body": material},
        [Support(faces=tuple(mesh.faces))],
        loads=[BodyForce(parts=("body",), field=lambda X: body_force(discretisation.law, X))],
        discretisation=discretisation,
    )
    states = list(solve_increments(NewtonSolver(problem, NewtonSettings()), LOAD_STEPS, []))
    difference = problem.u - exact_displacement(ufl.SpatialCoordinate(problem.domain.mesh))
    dx = ufl.dx(domain=problem.domain.mesh, metadata={"quadrature_degree": 6})
    squares = [ufl.inner(difference, difference) * dx, ufl.inner(ufl.grad(difference), ufl.grad(difference)) * dx]
    l2, h1 = [float(np.sqrt(fem.assemble_scalar(api.compile_form(square)))) for square in squares]
    return l2, h1, sum(state.outcome.iterations for state in states)
