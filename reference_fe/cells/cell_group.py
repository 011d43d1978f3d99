"""What cells of one kind add to a problem, and the tables every kind needs."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.cells import reference_cell
from reference_fe.cells.block_matrix import BlockRows, Places
from reference_fe.problem.domain import Domain

__all__ = ["CellGroup", "cell_dofs", "gradients_at", "inverse_jacobians", "reference_gradients"]


class CellGroup(Protocol):
    """Cells whose residual and tangent come from one kind of compiled loop.

    Attributes
    ----------
    nodes : (n_cells, n_nodes) nodes of the displacement space, local numbers
    """

    nodes: NDArray[np.int32]

    def add_force(self, u: NDArray[np.float64], out: NDArray[np.float64]) -> None:
        """Add int S(E(u)) : DE(u)[v] dV to ``out`` [N]; both (n_dofs,), neighbours' nodes included."""

    def store_stress(self, u: NDArray[np.float64], du: NDArray[np.float64]) -> None:
        """Store S(E(u)) + CC : DE(u)[du] at the Gauss points."""

    def add_tangent(self, u: NDArray[np.float64], rows: BlockRows, places: Places, values: NDArray[np.float64]) -> None:
        """Add the tangent at u with the stored stress [N/m] to a matrix; see `kernels.add_tangent`."""


def cell_dofs(nodes: NDArray[np.int32]) -> NDArray[np.int32]:
    """Unknowns of the cells' nodes, (n_cells, n_nodes, 3)."""
    return np.ascontiguousarray(3 * nodes[:, :, None] + np.arange(3), dtype=np.int32)


def reference_gradients(V: api.Expr, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Gradients of the shape functions in the reference cell (n_points, 3, n_nodes) [-], points (n_points, 3) of it."""
    shape = V.element.basix_element.tabulate(1, points)[1:, :, :, 0]
    return np.ascontiguousarray(shape.transpose(1, 0, 2))


def inverse_jacobians(
    domain: Domain, cells: NDArray[np.int32], points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Inverse of the derivative of each cell's map (n_cells, n_points, 3, 3), xi first [1/m], and |det| of it [m^3].

    points : (n_points, 3) of the reference cell
    """
    geometry = reference_cell.lagrange_gradients(domain.tagged.order, points)
    positions = domain.mesh.geometry.x[api.cell_nodes(domain.mesh)[cells]]
    jacobian = np.einsum("cni,kqn->cqik", positions, geometry)
    return np.linalg.inv(jacobian), np.abs(np.linalg.det(jacobian))


def gradients_at(
    domain: Domain, V: api.Expr, cells: NDArray[np.int32], points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gradients of the shape functions (n_cells, n_points, 3, n_nodes) [1/m] and |det of the cell's map| [m^3].

    points : (n_points, 3) of the reference cell
    """
    inverse, volume = inverse_jacobians(domain, cells, points)
    gradients = np.einsum("cqkj,qkn->cqjn", inverse, reference_gradients(V, points))
    return np.ascontiguousarray(gradients), volume
