"""Virtual work of the loads of a static problem: body forces, tractions, end moments in UFL; line loads as a vector."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.cells import reference_cell
from reference_fe.dolfinx_api import fem, ufl
from reference_fe.problem.domain import Domain
from reference_fe.problem.supports import BodyForce, EdgeLoad, EndMoment, Load, Traction
from reference_fe.solver import process_sums

__all__ = ["edge_force", "edge_load_vector", "virtual_work"]


def virtual_work(domain: Domain, load: BodyForce | EndMoment | Traction, u: api.Expr, v: api.Expr) -> api.Expr:
    """Work of a load at load factor 1 on the virtual displacement v, a UFL form [J].

    Body force b and traction t are dead: int b . v dV and int t . v dA over the undeformed body. For an end moment m
    per area, with d = F D, axis a and d' its part at right angles to a: int m a . (d x dd) / |d'|^2 dA, dd = grad(v) D.
    """
    mesh = domain.mesh
    if isinstance(load, BodyForce):
        dx = ufl.dx(
            domain=mesh,
            subdomain_data=domain.cell_tags,
            subdomain_id=domain.part_tags(load.parts),
            metadata={"quadrature_degree": load.quadrature_degree},
        )
        return domain.width * ufl.inner(load.field(ufl.SpatialCoordinate(mesh)), v) * dx
    ds = ufl.ds(domain=mesh, subdomain_data=domain.facet_tags, subdomain_id=domain.face_tags(load.faces))
    if isinstance(load, Traction):
        return domain.width * ufl.inner(fem.Constant(mesh, load.vector), v) * ds
    if domain.dim == 2:
        raise InputError("end moment", ", ".join(load.faces), "needs a solid mesh", "use a traction on a planar one")
    D, a = ufl.as_vector(load.director), ufl.as_vector(load.axis)
    d = D + ufl.dot(ufl.grad(u), D)
    across = ufl.dot(d, d) - ufl.dot(a, d) ** 2
    turn = ufl.dot(a, ufl.cross(d, ufl.dot(ufl.grad(v), D))) / across
    return fem.Constant(mesh, load.magnitude) * turn * ds(metadata={"quadrature_degree": 6})


def edge_force(domain: Domain, V: api.Expr, loads: Sequence[Load]) -> NDArray[np.float64]:
    """Nodal forces of the line loads among ``loads`` at load factor 1, (n_own_dofs,) [N]; zero without any."""
    total = np.zeros(V.dofmap.index_map.size_local * V.dofmap.index_map_bs)
    for load in loads:
        if isinstance(load, EdgeLoad):
            total += edge_load_vector(domain, V, load)
    return total


def edge_load_vector(domain: Domain, V: api.Expr, load: EdgeLoad) -> NDArray[np.float64]:
    """Consistent nodal forces of a line load at load factor 1, (n_dofs,) [N].

    Raises
    ------
    InputError
        When the two faces have no edge in common.

    Verified by tests/unit/test_fe_loads.py.
    """
    mesh = domain.mesh
    edges = domain.edges_between(*load.meeting)
    if domain.mesh.comm.allreduce(len(edges)) == 0:
        raise InputError("edge load", " and ".join(load.meeting), "must be faces that meet", "name two neighbours")
    forces = fem.Function(V)
    nodal = forces.x.array.reshape(-1, 3)
    nodes_of = api.cell_nodes(mesh)
    rule, weights = api.gauss_rule((3, 1, 1))
    along = rule[:, 0]
    for edge in edges:
        cell, local = domain.cell_of_edge(edge)
        start, end = reference_cell.reference_edge(local)
        points = start + along[:, None] * (end - start)
        gradients = reference_cell.lagrange_gradients(domain.tagged.order, points)
        jacobian = np.einsum("kpn,k,nx->px", gradients, end - start, mesh.geometry.x[nodes_of[cell]])
        length = weights * np.linalg.norm(jacobian, axis=1)
        shape = V.element.basix_element.tabulate(0, points)[0, :, :, 0]
        nodal[V.dofmap.cell_dofs(cell)] += np.outer(length @ shape, load.vector)
    return process_sums.sum_shared(forces)
