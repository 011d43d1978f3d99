"""Cauchy stress from a solved static problem: von Mises and principal."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contracts.material_laws import J2Plasticity
from reference_fe import dolfinx_api as api
from reference_fe.cells import reference_cell
from reference_fe.material.point_stress import PointStress, von_mises
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.solver import process_sums

__all__ = ["StressRecovery"]


class StressRecovery:
    """Cauchy stress on the surfaces of strips, where bending is largest, at their Gauss stations.

    Along a cell's first axis (the curved one) the strain is good at the Gauss points only: between them it carries the
    parasitic membrane part that the reduced rule ignores (Stolarski & Belytschko 1983). So stress is evaluated at the
    Gauss points of this axis, at the node positions of the two others (faces included), and extrapolated to the nodes
    along it.

    Make it with the problem: where a part yields, the stations have a history of their own.
    Verified by tests/verification/test_fe_patch.py (uniaxial stress) and tests/verification/test_fe_ring.py (bending).
    """

    def __init__(self, problem: StaticProblem) -> None:
        self.problem = problem
        domain = problem.domain
        self._cells = domain.cells_of(problem.materials)
        points, self._to_nodes = _stations(domain.tagged.order, domain.dim, problem.discretisation.gauss_points[0])
        self._at_stations = PointStress(problem, points)
        self._rows = {part: np.searchsorted(self._cells, domain.cells_of([part])) for part in problem.materials}

    def cell_stations(self) -> NDArray[np.float64]:
        """Von Mises stress at the stations of each deformable cell, (n_cells, n_stations) [Pa]."""
        return von_mises(self._at_stations()[self._cells])

    def largest_by_part(self) -> dict[str, float]:
        """Largest von Mises stress of each deformable part at the stations [Pa]."""
        return self._largest(self.cell_stations(), self._rows)

    def largest_plastic_strain(self) -> dict[str, float]:
        """Largest equivalent plastic strain at the stations of each part that can yield [-], last accepted state."""
        laws = self.problem.laws
        rows = {part: at for part, at in self._rows.items() if isinstance(laws[part], J2Plasticity)}
        return self._largest(self._at_stations.plastic_strain()[self._cells], rows)

    @staticmethod
    def _largest(values: NDArray[np.float64], parts: Mapping[str, NDArray[np.int64]]) -> dict[str, float]:
        largest = np.array([values[rows].max(initial=0.0) for rows in parts.values()])
        return dict(zip(parts, process_sums.largest_of_all(largest).tolist(), strict=True))

    def nodal_von_mises(self) -> NDArray[np.float64]:
        """Stress extrapolated to and averaged at each node of the tagged mesh, (n_points,) [Pa]; 0 on rigid parts."""
        return self._averaged(np.maximum(self.cell_stations() @ self._to_nodes.T, 0.0))

    def nodal_principal_stress(self) -> NDArray[np.float64]:
        """Principal values, descending, of the tensor extrapolated to and averaged at each node, (n_points, 3) [Pa].

        0 on rigid parts. Averaged over all cells of a node, as `nodal_von_mises` is.
        """
        stations = self._at_stations()[self._cells]
        averaged = np.zeros((len(self.problem.domain.tagged.points), 3, 3))
        for i, j in zip(*np.tril_indices(3), strict=True):  # all that eigvalsh looks at
            averaged[:, i, j] = self._averaged(stations[:, :, i, j] @ self._to_nodes.T)
        return np.linalg.eigvalsh(averaged)[:, ::-1]

    def _averaged(self, at_nodes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Mean at each node of the tagged mesh (n_points,) of values at the nodes of deformable cells (n_cells, k)."""
        mesh = self.problem.domain.mesh
        nodes = mesh.geometry.input_global_indices[api.cell_nodes(mesh)[self._cells]].ravel()
        count = np.bincount(nodes, minlength=len(self.problem.domain.tagged.points))
        total = np.bincount(nodes, weights=at_nodes.ravel(), minlength=len(count))
        comm = mesh.comm
        return np.asarray(comm.allreduce(total) / np.maximum(comm.allreduce(count), 1))


def _stations(order: int, dim: int, gauss_points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stress stations (n, dim) in the reference cell and the extrapolation from them to its nodes, (n_nodes, n)."""
    nodes = reference_cell.lagrange_points(order, dim)
    along = np.unique(api.gauss_rule((gauss_points,))[0][:, 0])
    across = np.unique(np.round(nodes[:, 1:], 12), axis=0)
    stations = np.array([[x, *yz] for yz in across for x in along])
    to_nodes = np.zeros((len(nodes), len(stations)))
    for row, node in enumerate(nodes):
        first = int(np.argmin(np.linalg.norm(across - node[1:], axis=1))) * len(along)
        for k, x in enumerate(along):
            others = np.delete(along, k)
            to_nodes[row, first + k] = np.prod((node[0] - others) / (x - others))
    return stations, to_nodes
