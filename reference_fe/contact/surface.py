"""Named faces as surfaces that may touch each other: facets in lattice order, their outward side, points on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from reference_fe import dolfinx_api as api
from reference_fe.contact.facet_kernels import surface_frames
from reference_fe.contact.patch import facet_widths
from reference_fe.contact.whole_body import WholeBody, global_nodes
from reference_fe.problem.domain import Domain
from reference_fe.solver import process_sums

__all__ = ["ContactSurface", "contact_surface", "node_positions"]

# Places of gmsh's facet nodes on the lattice, and the lattice's nodes along its two axes, by number of nodes.
_LATTICE = {
    2: ((0, 1), (2, 1)),
    3: ((0, 2, 1), (3, 1)),
    4: ((0, 2, 3, 1), (2, 2)),
    9: ((0, 6, 8, 2, 3, 7, 5, 1, 4), (3, 3)),
}

_EDGES = {4: ((0, 1), (1, 2), (2, 3), (3, 0)), 9: ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))}
"""gmsh's nodes of a quadrilateral's edges, by number of nodes."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactSurface:
    """Facets of one face group.

    Attributes
    ----------
    facets : (f, k) int64, nodes of the displacement space in lattice order
    sides : (f,) float, +1 where the lattice's t_1 x t_2 points out of the body, else -1
    lattice : nodes along the lattice's two axes
    at : (q, 2) Gauss points in [-1, 1]^2
    weights : (q,) their weights
    widths : (f,) width of each facet's part across a planar mesh [m]; ones for a solid mesh
    """

    facets: NDArray[np.int64]
    sides: NDArray[np.float64]
    lattice: tuple[int, int]
    at: NDArray[np.float64]
    weights: NDArray[np.float64]
    widths: NDArray[np.float64]

    def frames(
        self, x: NDArray[np.float64], rows: NDArray[np.int64] | slice = slice(None)
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Positions (f, q, 3) [m], outward unit normals (f, q, 3), area ratios (f, q) [m^2] at the Gauss points."""
        return surface_frames(x, self.facets[rows], self.sides[rows], self.lattice, self.at)

    def middle_normals(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Outward unit normal in the middle of each facet, (f, 3)."""
        return surface_frames(x, self.facets, self.sides, self.lattice, np.zeros((1, 2)))[1][:, 0]


def node_positions(domain: Domain, V: api.Expr) -> NDArray[np.float64]:
    """Undeformed positions of all the space's nodes, (n_nodes, 3) [m]; the third is zero for a planar body."""
    here = np.ascontiguousarray(V.tabulate_dof_coordinates(), dtype=np.float64)
    return here if domain.mesh.comm.size == 1 else WholeBody(V).gathered(here.ravel()).reshape(-1, 3)


def contact_surface(
    domain: Domain, V: api.Expr, face: str, gauss_points: int, across: Sequence[str] = ()
) -> ContactSurface:
    """The surface of one face group, integrated with ``gauss_points`` along each axis.

    across : parts of a planar mesh whose joints with the face's own part belong to the surface, which would have a hole
        there: the weld of a spring in another axial band

    Raises
    ------
    InputError
        For an unknown face, and where displacement and geometry do not share their nodes.
    """
    mesh = domain.tagged
    (tag,) = domain.face_tags([face])
    facets = mesh.facets[mesh.facet_tags == tag]
    cells = mesh.cells
    if across:
        cells = _cells_below(mesh, facets)
        facets = np.vstack([facets, _joints(mesh, cells, across)])
    order, lattice = _LATTICE[facets.shape[1]]
    points, weights = np.polynomial.legendre.leggauss(gauss_points)
    second = (np.zeros(1), np.ones(1)) if lattice[1] == 1 else (points, weights)
    at = np.stack(np.meshgrid(points, second[0], indexing="ij"), axis=-1).reshape(-1, 2)
    in_order = np.empty_like(facets)
    in_order[:, list(order)] = facets
    return ContactSurface(
        facets=_node_numbers(domain, V)[in_order],
        sides=_outward(mesh, cells, facets, in_order, lattice),
        lattice=lattice,
        at=at,
        weights=np.outer(weights, second[1]).ravel(),
        widths=facet_widths(mesh, facets),
    )


def _node_numbers(domain: Domain, V: api.Expr) -> NDArray[np.int64]:
    """Node of the displacement space at each point of the tagged mesh, in numbers over all processes, (n_points,)."""
    nodes, dofs = api.cell_nodes(domain.mesh), V.dofmap.list
    if nodes.shape != dofs.shape:
        rule = "must be interpolated by the nodes of the geometry where bodies touch"
        raise InputError("displacement", f"{dofs.shape[1]} nodes a cell", rule, "use Lagrange of the mesh's order")
    local = np.full(len(domain.mesh.geometry.x), -1, dtype=np.int64)
    local[nodes] = global_nodes(V)[dofs]
    out = np.full(len(domain.tagged.points), -1, dtype=np.int64)
    out[domain.mesh.geometry.input_global_indices] = local
    return process_sums.largest_of_all(out)


def _cells_below(mesh: TaggedMesh, facets: NDArray[np.int64]) -> NDArray[np.int64]:
    """Cells of the part that the facets bound, (n, nodes of a cell)."""
    on_face = np.isin(mesh.cells, facets).sum(axis=1)
    return np.asarray(mesh.cells[mesh.cell_tags == mesh.cell_tags[on_face.argmax()]], dtype=np.int64)


def _joints(mesh: TaggedMesh, cells: NDArray[np.int64], parts: Sequence[str]) -> NDArray[np.int64]:
    """Edges of the planar cells (n, k) that lie on cells of ``parts``, (m, nodes of an edge)."""
    edges = cells[:, _EDGES[cells.shape[1]]].reshape(-1, len(_EDGES[cells.shape[1]][0]))
    tags = [mesh.parts[part] for part in parts]
    joined = np.isin(edges, mesh.cells[np.isin(mesh.cell_tags, tags)]).all(axis=1)
    return np.asarray(edges[joined], dtype=np.int64)


def _outward(
    mesh: TaggedMesh,
    cells: NDArray[np.int64],
    facets: NDArray[np.int64],
    in_order: NDArray[np.int64],
    lattice: tuple[int, int],
) -> NDArray[np.float64]:
    """+1 or -1 for each facet: whether t_1 x t_2 in its middle points away from that of ``cells`` which it bounds.

    Corners are compared with corners: the middle of a curved facet may bulge beyond the middle of its own thin cell.
    """
    dim = mesh.points.shape[1]
    corners, cell_corners = facets[:, : 2 ** (dim - 1)], cells[:, : 2**dim]
    shared = _incidence(corners, len(mesh.points)) @ _incidence(cell_corners, len(mesh.points)).T
    cell = np.asarray(shared.argmax(axis=1)).ravel()
    x = np.zeros((len(mesh.points), 3))
    x[:, :dim] = mesh.points
    plus = np.ones(len(facets))
    _, normal, _ = surface_frames(x, in_order, plus, lattice, np.zeros((1, 2)))
    away = x[corners].mean(axis=1) - x[cell_corners[cell]].mean(axis=1)
    return np.where(np.einsum("fi,fi->f", normal[:, 0], away) > 0.0, 1.0, -1.0)


def _incidence(groups: NDArray[np.int64], n_points: int) -> csr_array:
    rows = np.repeat(np.arange(len(groups)), groups.shape[1])
    return csr_array((np.ones(groups.size), (rows, groups.ravel())), shape=(len(groups), n_points))
