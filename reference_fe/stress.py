"""Cauchy von Mises stress from a solved static problem."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.hyperelastic import von_mises_cauchy
from reference_fe.static_problem import StaticProblem

__all__ = ["StressRecovery"]


class StressRecovery:
    """Von Mises stress at the nodes of each deformable cell, where thin strips carry their largest fibre stress.

    Verified by tests/verification/test_fe_patch.py (uniaxial stress) and tests/verification/test_fe_ring.py.
    """

    def __init__(self, problem: StaticProblem) -> None:
        self.problem = problem
        domain = problem.domain
        self._cells = domain.cells_of(problem.materials)
        expression = von_mises_cauchy(problem.discretisation.law, problem.u, problem.lame)
        self._at_nodes = api.PointEvaluation(expression, api.lagrange_points(domain.tagged.order))
        self._rows = {part: np.searchsorted(self._cells, domain.cells_of([part])) for part in problem.materials}

    def cell_nodes(self) -> NDArray[np.float64]:
        """Von Mises stress at the nodes of each deformable cell, (n_cells, 8 or 27) [Pa], not averaged."""
        values = self._at_nodes(self.problem.domain.mesh, self._cells)
        return values.reshape(len(self._cells), -1)

    def largest_by_part(self) -> dict[str, float]:
        """Largest von Mises stress of each deformable part [Pa]."""
        values = self.cell_nodes()
        return {part: float(values[rows].max()) for part, rows in self._rows.items() if len(rows)}

    def nodal_von_mises(self) -> NDArray[np.float64]:
        """Stress averaged over the cells at each node of the tagged mesh, (n_points,) [Pa]; 0 on rigid parts."""
        mesh = self.problem.domain.mesh
        nodes = mesh.geometry.input_global_indices[api.cell_nodes(mesh)[self._cells]].ravel()
        count = np.bincount(nodes, minlength=len(self.problem.domain.tagged.points))
        total = np.bincount(nodes, weights=self.cell_nodes().ravel(), minlength=len(count))
        return np.asarray(total / np.maximum(count, 1))
