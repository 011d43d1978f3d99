"""Nonlinear statics of a tagged mesh, solid or planar: total Lagrangian, a law for each part, supports, loads, contact.

Weak form (Bonet & Wood 2008, ch. 8): find u with
    int S(E(u)) : DE(u)[v] dV - W(u)[v] - C(u)[v] = 0  for every v that vanishes on the supports,
with W the work of the loads (see `reference_fe.problem.loads`) and C that of the surface terms, i.e. of contact.
Tangent with mixed integration points (Magisano, Leonetti, Garcea 2017): the geometric stiffness uses the stress stored
at the Gauss points, S_m = S(E(u)) + CC : DE(u)[du] of the last solve, in place of S(E(u)); the residual, and with it
the solution, stay the same. docs/theory.md has the derivation. Verified by tests/verification/test_fe_*.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe.cells.choice import compiled_groups, form_laws
from reference_fe.cells.compiled_assembly import CompiledCells
from reference_fe.cells.discretisation import Discretisation, ElementFamily
from reference_fe.cells.form_assembly import FormCells, form_matrix
from reference_fe.cells.histories import Histories
from reference_fe.contact.obstacle import ObstacleContact, ObstacleTerm
from reference_fe.contact.surface_assembly import SurfaceAssembly
from reference_fe.contact.surface_term import SurfaceDescription
from reference_fe.contact.touch import check_touch
from reference_fe.dolfinx_api import fem, fem_petsc, ufl
from reference_fe.material import hyperelastic as law_of
from reference_fe.material.elastic_fields import elastic_fields
from reference_fe.material.law_constants import laws_of
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.domain import Domain
from reference_fe.problem.loads import edge_force, virtual_work
from reference_fe.problem.problem_state import ProblemState
from reference_fe.problem.support_dofs import build_supports
from reference_fe.problem.supports import EdgeLoad, EndMoment, Load, Support
from reference_fe.solver import process_sums

__all__ = ["Discretisation", "ElementFamily", "ProblemState", "StaticProblem"]


class StaticProblem:
    """Forms, unknowns and operators of one static problem; the load is set by one control parameter.

    Parameters
    ----------
    domain : mesh with tags
    materials : part name -> material, for every part that deforms; parts left out are rigid and must be supported. A
        part's law is its material's, or where that leaves it open the discretisation's
    supports, loads : boundary conditions
    contact : an obstacle that just touches the undeformed body at control parameter 0
    surfaces : further contacts, see `surface_term`
    discretisation : law, degree, quadrature
    transverse_constraint : planar mesh only, part -> how it is held across the plane, from `PLANE_STRESS` to
        `PLANE_STRAIN`, see `plane_state`; parts left out are in plane strain

    Attributes
    ----------
    u : displacement (DOLFINx function) [m]
    du : last Newton step [m]
    bcs : Dirichlet conditions of the supports (DOLFINx)
    prescribed : components of the supports, each with its unknowns
    supported : unknowns held by a support, ascending
    laws : part name -> its law
    lame, stretch, transverse_strain : constants on each cell, see `elastic_fields.ElasticFields`
    general, general_laws : cells of other laws than St. Venant-Kirchhoff and these laws by part, where compiled loops
        assemble them, else None and empty
    histories : what material points remember; `accept` commits it
    """

    def __init__(
        self,
        domain: Domain,
        materials: Mapping[str, Material],
        supports: Sequence[Support],
        *,
        loads: Sequence[Load] = (),
        contact: ObstacleContact | None = None,
        surfaces: Sequence[SurfaceDescription] = (),
        discretisation: Discretisation | None = None,
        transverse_constraint: Mapping[str, float] | None = None,
    ) -> None:
        self.domain, self.contact = domain, contact
        self.discretisation = discretisation or Discretisation(gauss_points=(2, 3, 3)[: domain.dim])
        self.materials = dict(materials)
        self._check_parts(supports)
        mesh = domain.mesh
        self.V = fem.functionspace(mesh, (str(self.discretisation.family), self.discretisation.degree, (domain.dim,)))
        self.u, self.du = fem.Function(self.V, name="displacement"), fem.Function(self.V)
        self.laws = laws_of(materials, self.discretisation.law)
        fields = elastic_fields(domain, materials, transverse_constraint or {}, self.laws)
        self.lame, self.stretch, self.transverse_strain = fields.lame, fields.stretch, fields.transverse
        self.load_factor = fem.Constant(mesh, 0.0)
        self._build_forms(loads)
        self._edge_force = edge_force(domain, self.V, loads)
        self.bcs, self.prescribed = build_supports(domain, self.V, supports)
        marked = [bc.dof_indices()[0] for bc in self.bcs]
        self.supported = np.unique(np.concatenate(marked)) if marked else np.zeros(0, dtype=np.int32)
        terms = [surface.build(domain, self.V) for surface in surfaces]
        self.surfaces = SurfaceAssembly([*self._obstacle_terms(), *terms], self.V)
        self._pattern_version: tuple[int, ...] | None = None
        self.set_control(0.0)

    @property
    def dofs(self) -> int:
        """Number of displacement unknowns, supported ones included."""
        return int(self.V.dofmap.index_map.size_global * self.V.dofmap.index_map_bs)

    @property
    def needs_matrix(self) -> bool:
        """Whether the next tangent has another pattern than the last one, and is another matrix."""
        return self._pattern_version != self.surfaces.pattern_version

    @property
    def own_dofs(self) -> int:
        """Number of displacement unknowns that belong to this process."""
        return int(self.V.dofmap.index_map.size_local * self.V.dofmap.index_map_bs)

    @property
    def own_supported(self) -> NDArray[np.int32]:
        """Unknowns held by a support that belong to this process, (n,) int, ascending."""
        return self.supported[self.supported < self.own_dofs]

    def set_control(self, control: float) -> None:
        """Set the control parameter: load factor of supports and loads [-], or rise of the plane [m]."""
        self.load_factor.value = control
        for prescribed in self.prescribed:
            prescribed.set_control(control)
        self.surfaces.set_control(control)

    def residual(self) -> NDArray[np.float64]:
        """Internal minus external force at every unknown, supported ones included, (n_own_dofs,) [N]."""
        return self.body_residual() - self.surfaces.force(self.u.x.array, 0.0)

    def body_residual(self) -> NDArray[np.float64]:
        """Internal force minus loads and tractions, without the surface terms, (n_own_dofs,) [N]."""
        array = -float(self.load_factor.value) * self._edge_force
        if self._residual_form is not None:
            b = fem_petsc.assemble_vector(self._residual_form)
            b.ghostUpdate(addv=api.PETSc.InsertMode.ADD, mode=api.PETSc.ScatterMode.REVERSE)
            array += b.array
            b.destroy()
        if self._compiled is not None:
            array += self._compiled.internal_force(self.u.x.array)
        return array

    def tangent(self, matrix: api.PETSc.Mat | None = None) -> api.PETSc.Mat:
        """Tangent stiffness with unit rows at supported unknowns [N/m]; give the last one back to spare its set-up.

        Surface terms enter with the stiffness of their last evaluation. Another matrix object than the one given means
        another pattern.
        """
        if self._compiled is not None:
            self._assemble_compiled()
            return self._compiled.supported_matrix()
        if self.needs_matrix:
            self._pattern_version, matrix = self.surfaces.pattern_version, None
        return form_matrix(self._tangent_form, self.surfaces, self.bcs, self.supported, matrix)

    def lifted_tangent(
        self, matrix: api.PETSc.Mat | None, offset: NDArray[np.float64]
    ) -> tuple[api.PETSc.Mat, NDArray[np.float64]]:
        """`tangent`, and the one without regard to supports times their offset [m]; both (n_own_dofs,), forces in N."""
        if self._compiled is not None:
            self._assemble_compiled()
            lifted = self._compiled.product(offset)  # before it is supported
            return self._compiled.supported_matrix(), lifted
        full = self.unsupported_tangent()
        lifted = api.matrix_product(full, offset)
        full.destroy()
        return self.tangent(matrix), lifted

    def unsupported_tangent(self) -> api.PETSc.Mat:
        """Tangent stiffness without regard to the supports [N/m]; a new matrix, to be destroyed by the caller."""
        if self._compiled is not None:
            self._assemble_compiled()
            return self._compiled.copied_matrix()
        return form_matrix(self._tangent_form, self.surfaces, (), np.zeros(0, dtype=np.int32))

    def _assemble_compiled(self) -> None:
        assert self._compiled is not None
        if not self.discretisation.mixed_integration_points:
            self.store_stress(extrapolate=False)
        if self.needs_matrix:
            self._pattern_version = self.surfaces.pattern_version
            self._compiled.prepare_matrix(self.supported, self.surfaces, self._tangent_form)
        self._compiled.assemble(self.u.x.array, self._tangent_form, self.surfaces)

    def state(self) -> ProblemState:
        """Displacement and committed history of surface terms and material points, to come back to."""
        return ProblemState(
            displacement=self.u.x.array.copy(), surfaces=self.surfaces.state(), histories=self.histories.state()
        )

    def restore(self, state: ProblemState) -> None:
        """Go back to a state; the control parameter is the caller's."""
        self.u.x.array[:] = state.displacement
        self.surfaces.restore(state.surfaces)
        self.histories.restore(state.histories)

    def accept(self) -> None:
        """Commit the step to the present displacement: slip of the surface terms, flow of the material."""
        self.surfaces.accept()
        self.histories.accept(self.u.x.array)

    def contact_force(self) -> NDArray[np.float64]:
        """Force of the obstacles on the body, integral of the contact tractions, (dim,) [N]."""
        return self.surfaces.resultant()

    def reaction(self, residual: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sum of the support forces on the body, from the residual at supported unknowns, (dim,) [N]."""
        rows, dim = self.own_supported, self.domain.dim
        own = np.array([residual[rows[rows % dim == axis]].sum() for axis in range(dim)])
        return np.asarray(self.domain.mesh.comm.allreduce(own))

    def store_stress(self, *, extrapolate: bool) -> None:
        """Store S(E(u)), with CC : DE(u)[du] added if ``extrapolate``, at the Gauss points; call before u changes."""
        if self._compiled is not None:
            step = self.du.x.array if extrapolate else np.zeros_like(self.du.x.array)
            self._compiled.store_stress(self.u.x.array, step)
            return
        assert self._forms is not None
        self._forms.store_stress(extrapolate=extrapolate)

    def smallest_stretch(self, parts: Sequence[str] | None = None) -> float:
        """Smallest principal stretch at any Gauss point of some or all parts that deform [-].

        Zero or less where a cell is turned inside out, infinite without a part.
        """
        F = self._deformation_gradient(self.domain.mesh, self.domain.cells_of(self.laws if parts is None else parts))
        squared = np.linalg.eigvalsh(np.swapaxes(F, -1, -2) @ F)[..., 0]
        stretch = np.sqrt(np.maximum(squared, 0.0)) * np.sign(np.linalg.det(F))
        return -float(process_sums.largest_of_all(np.max(-stretch, keepdims=True, initial=-np.inf).ravel())[0])

    def nodal_displacement(self) -> NDArray[np.float64]:
        """Displacement at the nodes of the tagged mesh, (n_points, dim) [m]."""
        mesh, order, dim = self.domain.mesh, self.domain.tagged.order, self.domain.dim
        u = self.u
        if (order, ElementFamily.LAGRANGE) != (self.discretisation.degree, self.discretisation.family):
            u = fem.Function(fem.functionspace(mesh, ("Lagrange", order, (dim,))))
            u.interpolate(self.u)
        dofs, nodes = u.function_space.dofmap.list, api.cell_nodes(mesh)
        local = np.zeros((len(mesh.geometry.x), dim))
        local[nodes] = u.x.array.reshape(-1, dim)[dofs]
        out = np.full_like(self.domain.tagged.points, -np.inf)
        here = np.unique(nodes[: mesh.topology.index_map(mesh.topology.dim).size_local])
        out[mesh.geometry.input_global_indices[here]] = local[here]
        out = process_sums.largest_of_all(out)
        return np.where(np.isneginf(out), 0.0, out)  # nodes without a cell

    def _check_parts(self, supports: Sequence[Support]) -> None:
        held = {part for support in supports for part in support.parts}
        for part in self.domain.tagged.parts:
            if part not in self.materials and part not in held:
                raise InputError(f"part {part}", "no material", "every part needs a material or a support", "add one")
        self.domain.part_tags(self.materials)

    def _build_forms(self, loads: Sequence[Load]) -> None:
        domain, choice, u = self.domain, self.discretisation, self.u
        v, w = ufl.TestFunction(self.V), ufl.TrialFunction(self.V)
        residual, tangent = None, None
        self._compiled, self._forms = None, None
        elastic, self.general = compiled_groups(domain, self.V, self.materials, self.laws, choice)
        self.general_laws = self.general.laws if self.general else {}
        self.histories = Histories(self.general)
        if elastic or self.general:
            self._compiled = CompiledCells(self.V, [group for group in (elastic, self.general) if group])
        else:
            self._forms = FormCells(domain, form_laws(self.laws), (u, self.du), self.lame, choice, self.stretch)
            residual, tangent = self._forms.residual, self._forms.tangent
        for load in loads:
            if isinstance(load, EdgeLoad):
                continue  # see `loads.edge_force`
            work = self.load_factor * virtual_work(domain, load, u, v)
            residual = _sum(residual, -work)
            if isinstance(load, EndMoment):
                tangent = _sum(tangent, -ufl.derivative(work, u, w))
        points, _ = api.gauss_rule(choice.gauss_points)
        self._deformation_gradient = PointEvaluation(law_of.deformation_gradient(u), points)
        self._residual_form = None if residual is None else api.compile_form(residual)
        self._tangent_form = None if tangent is None else api.compile_form(tangent)

    def _obstacle_terms(self) -> list[ObstacleTerm]:
        """The obstacle's surface term, with the stiffness of the cells known to it; refused unless it just touches."""
        if self.contact is None:
            return []
        check_touch(self.domain, self.contact, self.materials)
        lam, mu = (field.x.array for field in self.lame)
        young_modulus = np.divide(mu * (3.0 * lam + 2.0 * mu), lam + mu, out=np.zeros_like(mu), where=mu > 0.0)
        return [self.contact.build(self.domain, self.V, young_modulus)]


def _sum(form: api.Expr, term: api.Expr) -> api.Expr:
    """A form plus a term, where the form may not exist yet."""
    return term if form is None else form + term
