"""Deformable cells as UFL forms: any law that UFL has, any element, any number of processes.

Tangent with mixed integration points (Magisano, Leonetti, Garcea 2017): the geometric stiffness uses the stress stored
at the Gauss points. Verified by tests/verification/test_fe_cells.py against the compiled loops.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.cells.discretisation import Discretisation
from reference_fe.contact.surface_assembly import SurfaceAssembly
from reference_fe.dolfinx_api import Expr, fem, ufl
from reference_fe.material import hyperelastic as law_of
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.domain import Domain

__all__ = ["FormCells", "form_matrix"]


class FormCells:
    """Residual and tangent forms of the deformable cells, with the stress stored at their Gauss points.

    Parameters
    ----------
    domain : mesh with tags
    laws : law of each deformable part
    unknowns : displacement and last Newton step [m]
    lame : Lame parameters lambda, mu [Pa]
    choice : quadrature, kind of tangent
    stretch : free thermal stretch of each cell [-]

    Attributes
    ----------
    residual, tangent : UFL forms [J]
    """

    def __init__(
        self,
        domain: Domain,
        laws: Mapping[str, MaterialLaw],
        unknowns: tuple[api.Function, api.Function],
        lame: tuple[api.Function, api.Function],
        choice: Discretisation,
        stretch: Expr = 1.0,
    ) -> None:
        u, du = unknowns
        self._stored = fem.Function(api.quadrature_space(domain.mesh, choice.gauss_points, (domain.dim, domain.dim)))
        self._mesh, points = domain.mesh, api.gauss_rule(choice.gauss_points)[0]
        self._stress = list[tuple[NDArray[np.int32], PointEvaluation, PointEvaluation]]()
        residuals, tangents = [], []
        for law in sorted(set(laws.values())):
            parts = tuple(part for part in laws if laws[part] is law)
            dx = api.cell_measure(domain.mesh, domain.cell_tags, domain.part_tags(parts), choice.gauss_points)
            S, (residual, tangent) = self._integrands(law, u, lame, stretch, choice)
            residuals.append(domain.width * residual * dx)
            tangents.append(domain.width * tangent * dx)
            increment = law_of.stress_increment(law, u, du, lame, stretch)
            both = PointEvaluation(S, points), PointEvaluation(S + increment, points)
            self._stress.append((domain.cells_of(parts), *both))
        self.residual, self.tangent = sum(residuals[1:], residuals[0]), sum(tangents[1:], tangents[0])

    def _integrands(
        self,
        law: MaterialLaw,
        u: api.Function,
        lame: tuple[api.Function, api.Function],
        stretch: Expr,
        choice: Discretisation,
    ) -> tuple[Expr, tuple[Expr, Expr]]:
        """Stress [Pa], and the integrands of residual and tangent [J/m^3]."""
        v, w = ufl.TestFunction(u.function_space), ufl.TrialFunction(u.function_space)
        S = law_of.second_piola_kirchhoff(law, u, lame, stretch)
        S_geo: Expr = self._stored if choice.mixed_integration_points else S
        dE_v = law_of.linearised_strain(u, v)
        CC_dE = law_of.stress_increment(law, u, w, lame, stretch)
        geometric = ufl.inner(S_geo, ufl.sym(ufl.grad(w).T * ufl.grad(v)))
        return S, (ufl.inner(S, dE_v), ufl.inner(CC_dE, dE_v) + geometric)

    def store_stress(self, *, extrapolate: bool) -> None:
        """Store S(E(u)), with CC : DE(u)[du] added if ``extrapolate``, at the Gauss points."""
        for cells, current, extrapolated in self._stress:
            values = (extrapolated if extrapolate else current)(self._mesh, cells)
            size = int(np.prod(values.shape[1:]))
            self._stored.x.array.reshape(-1, size)[cells] = values.reshape(-1, size)


def form_matrix(
    form: api.Expr,
    surfaces: SurfaceAssembly,
    bcs: Sequence[api.DirichletBC],
    supported: NDArray[np.int32],
    matrix: api.PETSc.Mat | None = None,
) -> api.PETSc.Mat:
    """Matrix of a tangent's form and the surfaces [N/m], with unit rows at supported unknowns; written into one given.

    bcs, supported : the supports' conditions, and the unknowns (n,) that they hold
    """
    if matrix is None:
        matrix = api.create_matrix(form, np.unique(supported // surfaces.dim).astype(np.int32), surfaces.couplings())
    else:
        matrix.zeroEntries()
    api.fem_petsc.assemble_matrix(matrix, form, bcs=bcs)
    api.flush(matrix)
    surfaces.add_to_matrix(matrix, supported)
    matrix.assemble()
    return matrix
