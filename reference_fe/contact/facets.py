"""Quadrature of the faces that may touch an obstacle: points, shape functions, undeformed areas, local stiffness."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.cells import reference_cell
from reference_fe.problem.domain import Domain

__all__ = ["ContactFacets", "LineRule", "gauss_line", "local_stiffness", "simpson_line"]

type LineRule = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Points and weights on [0, 1]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactFacets:
    """Facets of named faces that belong to this process' own cells.

    Attributes
    ----------
    nodes : (m, k) int64, node numbers of the displacement space
    kind : (m,) int64, the facet's number within its cell
    shapes : (kinds, q, k) shape functions of the displacement at the quadrature points [-]
    positions : (m, q, dim) undeformed points [m]
    weights : (m, q) undeformed area of each point; in a planar body length times width [m^2]
    size : (m,) shortest edge of the facet [m]
    depth : (m,) volume of the facet's cell over the facet's area [m]
    cells : (m,) int32, local number of the cell

    Verified by tests/unit/test_fe_contact_facets.py.
    """

    nodes: NDArray[np.int64]
    kind: NDArray[np.int64]
    shapes: NDArray[np.float64]
    positions: NDArray[np.float64]
    weights: NDArray[np.float64]
    size: NDArray[np.float64]
    depth: NDArray[np.float64]
    cells: NDArray[np.int32]

    @classmethod
    def of(cls, domain: Domain, V: api.Expr, faces: Iterable[str], line: LineRule) -> ContactFacets:
        """Lay out the quadrature of the named faces, the same rule along each axis of a facet."""
        rule = reference_cell.facet_rule(V, line)
        cells, kind = _cells_of_facets(domain, domain.facets_of(tuple(faces)))
        order, dim = domain.tagged.order, domain.mesh.geometry.dim
        x = domain.mesh.geometry.x[api.cell_nodes(domain.mesh)[cells]][:, :, :dim]
        shapes = np.stack([reference_cell.lagrange_shapes(order, points) for points in rule.points])
        gradients = np.stack([reference_cell.lagrange_gradients(order, points) for points in rule.points])
        tangents = np.einsum("mdqn,mtd,mni->mtqi", gradients[kind], rule.edges[kind], x)
        area = _area(tangents)
        return cls(
            nodes=V.dofmap.list[cells[:, None], rule.closure[kind]].astype(np.int64),
            kind=kind,
            shapes=rule.shapes,
            positions=np.einsum("mqn,mni->mqi", shapes[kind], x),
            weights=rule.weights * area * _widths(domain, cells)[:, None],
            size=np.linalg.norm(tangents, axis=-1).mean(axis=-1).min(axis=-1),
            depth=_volumes(order, x) / (area @ rule.weights),
            cells=cells,
        )


def gauss_line(points: int) -> LineRule:
    """Gauss points: the most accurate integral."""
    at, weights = api.gauss_rule((points,))
    return at[:, 0], weights


def simpson_line(points: int) -> LineRule:
    """An odd number of evenly spaced points, both ends included, with Simpson's weights: nothing slips between them."""
    if points < 3 or points % 2 == 0:
        raise InputError("points of Simpson's rule", points, "must be odd and at least 3", "17 is usual")
    weights = np.full(points, 2.0)
    weights[1::2], weights[[0, -1]] = 4.0, 1.0
    return np.linspace(0.0, 1.0, points), weights / (3.0 * (points - 1))


def local_stiffness(facets: ContactFacets, young_modulus: NDArray[np.float64]) -> NDArray[np.float64]:
    """Penalty stiffness of each facet from the cell under it, (m,) [N/m^3].

    k = (E / h) (min(t, h) / h)^3 with the facet's shortest edge h and the cell's depth t: the stiffness per area with
    which the cell resists a bump of its own size, by bending where it is thinner than wide, else by compression. With
    the penalty alone a Hertz contact on cells of a sixth of its half width then comes out 5 % too wide; the augmented
    Lagrangian does not depend on it.

    young_modulus : (m,) of the cells under the facets [Pa]

    Verified by tests/unit/test_fe_contact_facets.py.
    """
    thinness = np.minimum(facets.depth, facets.size) / facets.size
    return np.asarray(young_modulus / facets.size * thinness**3)


def _cells_of_facets(domain: Domain, facets: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Own cell of each facet, and the facet's number within it; facets of other processes' cells are left out."""
    topology = domain.mesh.topology
    dim = topology.dim
    topology.create_connectivity(dim - 1, dim)
    topology.create_connectivity(dim, dim - 1)
    cell_of, facets_of = topology.connectivity(dim - 1, dim), topology.connectivity(dim, dim - 1)
    own = topology.index_map(dim).size_local
    found = []
    for facet in facets:
        cells = cell_of.links(facet)
        if len(cells) > 1:
            rule = "must lie on the surface; a facet between two cells does not"
            raise InputError("contact faces", "inner facets", rule, "name faces of the boundary")
        if cells[0] < own:
            found.append((cells[0], int(np.flatnonzero(facets_of.links(cells[0]) == facet)[0])))
    table = np.array(found, dtype=np.int64).reshape(-1, 2)
    return table[:, 0].astype(np.int32), table[:, 1]


def _area(tangents: NDArray[np.float64]) -> NDArray[np.float64]:
    """Area (length in the plane) per reference area from the tangents (m, dim - 1, q, dim), (m, q)."""
    if tangents.shape[1] == 1:
        return np.linalg.norm(tangents[:, 0], axis=-1)
    return np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=-1)


def _widths(domain: Domain, cells: NDArray[np.int32]) -> NDArray[np.float64]:
    """Width of each cell at right angles to a planar mesh [m]; 1 in a solid one."""
    width = domain.width
    return np.full(len(cells), width) if isinstance(width, float) else np.asarray(width.x.array[cells])


def _volumes(order: int, nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Volume (area in the plane) of cells given by their nodes (m, n, dim), (m,)."""
    points, weights = api.gauss_rule((3,) * nodes.shape[2])
    jacobian = np.einsum("dqn,mni->mqdi", reference_cell.lagrange_gradients(order, points), nodes)
    return np.asarray(np.abs(np.linalg.det(jacobian)) @ weights)
