"""Deformable cells as UFL forms: any law, any element, any number of processes.

Tangent with mixed integration points (Magisano, Leonetti, Garcea 2017): the geometric stiffness uses the stress stored
at the Gauss points. Verified by tests/verification/test_fe_cells.py against the compiled loops.
"""

from __future__ import annotations

from reference_fe import dolfinx_api as api
from reference_fe.cells.discretisation import Discretisation
from reference_fe.dolfinx_api import Expr, fem, ufl
from reference_fe.material import hyperelastic as law_of
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.domain import Domain

__all__ = ["FormCells"]


class FormCells:
    """Residual and tangent forms of the deformable cells, with the stress stored at their Gauss points.

    Parameters
    ----------
    domain : mesh with tags
    parts : names of the deformable parts
    unknowns : displacement and last Newton step [m]
    lame : Lame parameters lambda, mu [Pa]
    choice : law, quadrature, kind of tangent
    stretch : free thermal stretch of each cell [-]

    Attributes
    ----------
    residual, tangent : UFL forms [J]
    """

    def __init__(
        self,
        domain: Domain,
        parts: tuple[str, ...],
        unknowns: tuple[api.Function, api.Function],
        lame: tuple[api.Function, api.Function],
        choice: Discretisation,
        stretch: Expr = 1.0,
    ) -> None:
        mesh, (u, du) = domain.mesh, unknowns
        V = u.function_space
        v, w = ufl.TestFunction(V), ufl.TrialFunction(V)
        dx = api.cell_measure(mesh, domain.cell_tags, domain.part_tags(parts), choice.gauss_points)
        S = law_of.second_piola_kirchhoff(choice.law, u, lame, stretch)
        self._stored = fem.Function(api.quadrature_space(mesh, choice.gauss_points, (domain.dim, domain.dim)))
        S_geo: Expr = self._stored if choice.mixed_integration_points else S
        dE_v = law_of.linearised_strain(u, v)
        CC_dE = law_of.stress_increment(choice.law, u, w, lame, stretch)
        self.residual = domain.width * ufl.inner(S, dE_v) * dx
        geometric = ufl.inner(S_geo, ufl.sym(ufl.grad(w).T * ufl.grad(v)))
        self.tangent = domain.width * (ufl.inner(CC_dE, dE_v) + geometric) * dx
        points, _ = api.gauss_rule(choice.gauss_points)
        increment = law_of.stress_increment(choice.law, u, du, lame, stretch)
        self._extrapolated = PointEvaluation(S + increment, points)
        self._current = PointEvaluation(S, points)
        self._mesh, self._cells = mesh, domain.cells_of(parts)

    def store_stress(self, *, extrapolate: bool) -> None:
        """Store S(E(u)), with CC : DE(u)[du] added if ``extrapolate``, at the Gauss points."""
        values = (self._extrapolated if extrapolate else self._current)(self._mesh, self._cells)
        stored = self._stored.x.array.reshape(-1, values[0].size)
        stored[self._cells] = values.reshape(len(values), -1)
