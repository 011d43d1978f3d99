"""Nonlinear statics of a tagged hexahedral mesh: total Lagrangian, hyperelastic, supports, tractions, plane contact.

Weak form (Bonet & Wood 2008, ch. 8): find u with
    int S(E(u)) : DE(u)[v] dV - int t . v dA - int p(g(u)) n . v dA = 0  for every v that vanishes on the supports.
Tangent with mixed integration points (Magisano, Leonetti, Garcea 2017): the geometric stiffness uses the stress stored
at the Gauss points, S_m = S(E(u)) + CC : DE(u)[du] of the last solve, in place of S(E(u)); the residual, and with it
the solution, stay the same. docs/theory.md has the derivation. Verified by tests/verification/test_fe_*.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe import hyperelastic as law_of
from reference_fe.contact_law import plane_pressure
from reference_fe.contact_patch import contact_faces, distance_at_touch
from reference_fe.dolfinx_api import fem, fem_petsc, ufl
from reference_fe.domain import Domain
from reference_fe.hyperelastic import MaterialLaw
from reference_fe.supports import PlaneContact, Support, Traction

__all__ = ["Discretisation", "StaticProblem"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Discretisation:
    """Choice of law, element and quadrature.

    Attributes
    ----------
    law : stored energy
    degree : degree of the displacement, 1 or 2
    gauss_points : Gauss points along the cell's three local axes; 27-node hexahedra keep full rank as long as two of
        them have 3 points. 2 along the curved axis (see `orientation.curved_axis_first`) cures membrane locking
    mixed_integration_points : store the stress at the points for the geometric stiffness; False is plain Newton
    """

    law: MaterialLaw = MaterialLaw.ST_VENANT_KIRCHHOFF
    degree: int = 2
    gauss_points: tuple[int, int, int] = (2, 3, 3)
    mixed_integration_points: bool = True


class StaticProblem:
    """Forms, unknowns and operators of one static problem; the load is set by one control parameter.

    Parameters
    ----------
    domain : mesh with tags
    materials : part name -> material, for every part that deforms; parts left out are rigid and must be supported
    supports, tractions, contact : boundary conditions
    discretisation : law, degree, quadrature

    Attributes
    ----------
    u : displacement (DOLFINx function) [m]
    du : last Newton step [m]
    contact_lag : linearise the contact pressure about the gap plus this lag [m]; 0 but in an increment's first solve
    """

    def __init__(
        self,
        domain: Domain,
        materials: Mapping[str, Material],
        supports: Sequence[Support],
        *,
        tractions: Sequence[Traction] = (),
        contact: PlaneContact | None = None,
        discretisation: Discretisation | None = None,
    ) -> None:
        self.domain, self.contact = domain, contact
        self.discretisation = discretisation or Discretisation()
        self.materials = dict(materials)
        self._check_parts(supports)
        mesh = domain.mesh
        self.V = fem.functionspace(mesh, ("Lagrange", self.discretisation.degree, (3,)))
        self.u, self.du = fem.Function(self.V, name="displacement"), fem.Function(self.V)
        self.lame = self._lame_fields()
        self.stored_stress = fem.Function(api.quadrature_space(mesh, self.discretisation.gauss_points, (3, 3)))
        self.load_factor = fem.Constant(mesh, 0.0)
        self.plane_normal, self.plane_distance = fem.Constant(mesh, np.zeros(3)), fem.Constant(mesh, 1.0)
        self.penalty = fem.Constant(mesh, 0.0)
        self.contact_lag = fem.Constant(mesh, 0.0)
        self._build_forms(tractions)
        self._build_supports(supports)
        self.set_control(0.0)

    @property
    def dofs(self) -> int:
        """Number of displacement unknowns, supported ones included."""
        return int(self.V.dofmap.index_map.size_global * self.V.dofmap.index_map_bs)

    def set_control(self, control: float) -> None:
        """Set the control parameter: load factor of supports and tractions [-], or rise of the plane [m]."""
        self.load_factor.value = control
        for function, value in self._prescribed:
            function.x.array[:] = control * value
        if self.contact is not None:
            self.plane_normal.value = np.asarray(self.contact.normal)
            self.plane_distance.value = self.contact.distance_at_touch - control
            self.penalty.value = self.contact.stiffness

    def residual(self) -> NDArray[np.float64]:
        """Internal minus external force at every unknown, supported ones included, (n_dofs,) [N]."""
        b = fem_petsc.assemble_vector(self._residual_form)
        b.ghostUpdate(addv=api.PETSc.InsertMode.ADD, mode=api.PETSc.ScatterMode.REVERSE)
        array = np.array(b.array)
        b.destroy()
        return array

    def tangent(self, matrix: api.PETSc.Mat | None = None) -> api.PETSc.Mat:
        """Tangent stiffness with unit rows at supported unknowns [N/m]."""
        if matrix is None:
            matrix = api.create_matrix(self._tangent_form, np.unique(self.supported // 3).astype(np.int32))
        else:
            matrix.zeroEntries()
        fem_petsc.assemble_matrix(matrix, self._tangent_form, bcs=self.bcs)
        matrix.assemble()
        return matrix

    def unsupported_tangent(self) -> api.PETSc.Mat:
        """Tangent stiffness without regard to the supports [N/m]; a new matrix, to be destroyed by the caller."""
        matrix: api.PETSc.Mat = fem_petsc.assemble_matrix(self._tangent_form)
        matrix.assemble()
        return matrix

    def contact_force(self) -> NDArray[np.float64]:
        """Force of the plane on the body, integral of the contact pressure, (3,) [N]."""
        if self._contact_form is None:
            return np.zeros(3)
        total = self.domain.mesh.comm.allreduce(fem.assemble_scalar(self._contact_form))
        return np.asarray(self.plane_normal.value * total, dtype=np.float64)

    def reaction(self, residual: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sum of the support forces on the body, from the residual at supported unknowns, (3,) [N]."""
        rows = self.supported
        return np.array([residual[rows[rows % 3 == axis]].sum() for axis in range(3)])

    def store_stress(self, *, extrapolate: bool) -> None:
        """Store S(E(u)), with CC : DE(u)[du] added if ``extrapolate``, at the Gauss points; call before u changes."""
        point_stress = self._extrapolated_stress if extrapolate else self._current_stress
        values = point_stress(self.domain.mesh, self._flexible_cells)
        stored = self.stored_stress.x.array.reshape(-1, values[0].size)
        stored[self._flexible_cells] = values.reshape(len(values), -1)

    def nodal_displacement(self) -> NDArray[np.float64]:
        """Displacement at the nodes of the tagged mesh, (n_points, 3) [m]."""
        mesh, order = self.domain.mesh, self.domain.tagged.order
        u = self.u
        if order != self.discretisation.degree:
            u = fem.Function(fem.functionspace(mesh, ("Lagrange", order, (3,))))
            u.interpolate(self.u)
        dofs, nodes = u.function_space.dofmap.list, api.cell_nodes(mesh)
        local = np.zeros((len(mesh.geometry.x), 3))
        local[nodes] = u.x.array.reshape(-1, 3)[dofs]
        out = np.zeros_like(self.domain.tagged.points)
        out[mesh.geometry.input_global_indices] = local
        return out

    def _check_parts(self, supports: Sequence[Support]) -> None:
        held = {part for support in supports for part in support.parts}
        for part in self.domain.tagged.parts:
            if part not in self.materials and part not in held:
                raise InputError(f"part {part}", "no material", "every part needs a material or a support", "add one")
        self.domain.part_tags(self.materials)

    def _lame_fields(self) -> tuple[api.Function, api.Function]:
        space = fem.functionspace(self.domain.mesh, ("DG", 0))
        lam, mu = fem.Function(space), fem.Function(space)
        for part, material in self.materials.items():
            cells = self.domain.cells_of([part])
            lam.x.array[cells], mu.x.array[cells] = material.lame_lambda, material.lame_mu
        self._flexible_cells = self.domain.cells_of(self.materials)
        return lam, mu

    def _build_forms(self, tractions: Sequence[Traction]) -> None:
        choice, u, mesh = self.discretisation, self.u, self.domain.mesh
        v, w = ufl.TestFunction(self.V), ufl.TrialFunction(self.V)
        parts = self.domain.part_tags(self.materials)
        dx = api.cell_measure(mesh, self.domain.cell_tags, parts, choice.gauss_points)
        S = law_of.second_piola_kirchhoff(choice.law, u, self.lame)
        S_geo = self.stored_stress if choice.mixed_integration_points else S
        dE_v = law_of.linearised_strain(u, v)
        CC_dE = law_of.stress_increment(choice.law, u, w, self.lame)
        residual = ufl.inner(S, dE_v) * dx
        tangent = ufl.inner(CC_dE, dE_v) * dx + ufl.inner(S_geo, ufl.sym(ufl.grad(w).T * ufl.grad(v))) * dx
        residual, tangent = self._add_boundary(residual, tangent, tractions, v, w)
        self._residual_form, self._tangent_form = api.compile_form(residual), api.compile_form(tangent)
        points, _ = api.gauss_rule(choice.gauss_points)
        increment = law_of.stress_increment(choice.law, u, self.du, self.lame)
        self._extrapolated_stress = api.PointEvaluation(S + increment, points)
        self._current_stress = api.PointEvaluation(S, points)

    def _add_boundary(
        self, residual: api.Expr, tangent: api.Expr, tractions: Sequence[Traction], v: api.Expr, w: api.Expr
    ) -> tuple[api.Expr, api.Expr]:
        mesh, tags = self.domain.mesh, self.domain.facet_tags
        for traction in tractions:
            ds = ufl.ds(domain=mesh, subdomain_data=tags, subdomain_id=self.domain.face_tags(traction.faces))
            residual -= self.load_factor * ufl.inner(fem.Constant(mesh, traction.vector), v) * ds
        self._contact_form = None
        if self.contact is not None:
            _check_plane(self.domain, self.contact)
            ds = ufl.ds(
                domain=mesh,
                subdomain_data=tags,
                subdomain_id=self.domain.face_tags(self.contact.faces),
                metadata={"quadrature_degree": self.contact.quadrature_degree},
            )
            n = self.plane_normal
            gap = ufl.dot(n, ufl.SpatialCoordinate(mesh) + self.u) + self.plane_distance
            pressure, stiffness = plane_pressure(gap, self.contact_lag, self.penalty, self.contact.ramp)
            residual -= pressure * ufl.dot(n, v) * ds
            tangent += stiffness * ufl.dot(n, v) * ufl.dot(n, w) * ds
            self._contact_form = api.compile_form(pressure * ds)
        return residual, tangent

    def _build_supports(self, supports: Sequence[Support]) -> None:
        mesh = self.domain.mesh
        self.bcs: list[api.DirichletBC] = []
        self._prescribed: list[tuple[api.Function, float]] = []
        mesh.topology.create_connectivity(2, 3)
        mesh.topology.create_connectivity(3, 3)
        for support in supports:
            for position, component in enumerate(support.components):
                subspace, _ = self.V.sub(component).collapse()
                value = fem.Function(subspace)
                self._prescribed.append((value, support.value[position] if support.value else 0.0))
                for dim, entities in (
                    (2, self.domain.facets_of(support.faces)),
                    (3, self.domain.cells_of(support.parts)),
                ):
                    if len(entities):
                        dofs = fem.locate_dofs_topological((self.V.sub(component), subspace), dim, entities)
                        self.bcs.append(fem.dirichletbc(value, dofs, self.V.sub(component)))
        marked = [bc.dof_indices()[0] for bc in self.bcs]
        self.supported = np.unique(np.concatenate(marked)) if marked else np.zeros(0, dtype=np.int32)


def _check_plane(domain: Domain, contact: PlaneContact) -> None:
    """Refuse a plane that does not just touch the undeformed body (to a thousandth of its distance)."""
    domain.face_tags(contact.faces)
    facets = contact_faces(domain.tagged, contact.faces)
    reach = distance_at_touch(domain.tagged, facets, -np.asarray(contact.normal))
    gap = contact.distance_at_touch - reach
    if abs(gap) > 1e-3 * max(abs(reach), abs(contact.distance_at_touch)):
        raise InputError(
            "contact plane at the start",
            f"{abs(gap) * 1e3:.4g} mm {'off' if gap > 0 else 'inside'} the undeformed body",
            "must just touch it, with its normal pointing to the body",
            "flip the normal, or take distance_at_touch from contact_patch.distance_at_touch",
        )
