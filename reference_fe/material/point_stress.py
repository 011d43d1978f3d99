"""Cauchy stress at fixed points of every cell of a static problem, whatever the law of its part.

Verified by tests/verification/test_fe_patch.py and tests/verification/test_fe_laws_plastic.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.cells import general_kernels
from reference_fe.cells.choice import form_laws
from reference_fe.cells.general_cells import PointSet
from reference_fe.material.hyperelastic import cauchy_stress
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["PointStress", "von_mises"]

Array = NDArray[np.float64]


class PointStress:
    """Stress at reference points of this process' cells.

    UFL gives it where forms or the loops of St. Venant-Kirchhoff material assemble; elsewhere the points are material
    points of their own: a part that yields has its history at each, committed with the problem's increments, so that
    stress there obeys the yield condition too. The pressure is the cell's.

    Parameters
    ----------
    problem : before its first increment, if a part yields
    points : (m, dim) of the reference cell
    """

    def __init__(self, problem: StaticProblem, points: Array) -> None:
        self._problem = problem
        self._mesh = problem.domain.mesh
        general = problem.general
        others = {} if general is None else problem.general_laws
        fields = (problem.u, problem.lame, problem.stretch, problem.transverse_strain)
        laws = form_laws({part: law for part, law in problem.laws.items() if part not in others})
        self._forms = [
            (
                problem.domain.cells_of([p for p in laws if laws[p] is law]),
                PointEvaluation(cauchy_stress(law, *fields), points),
            )
            for law in sorted(set(laws.values()))
        ]
        self._count = len(points)
        self._points = None
        if general is not None:
            weights = np.zeros(len(points))
            self._points = PointSet(problem.domain, problem.V, problem.materials, others, points, weights)
            problem.histories.follow(self._points)

    def __call__(self) -> Array:
        """Stress of the step to the present displacement, (n_own_cells, m, 3, 3) [Pa].

        Zero in rigid parts.
        """
        own = self._mesh.topology.index_map(self._mesh.topology.dim).size_local
        values = np.zeros((own, self._count, 3, 3))
        for cells, evaluation in self._forms:
            values[cells] = evaluation(self._mesh, cells)
        if self._points is not None:
            values[self._points.cells] = self._general_stress(self._points)
        return values

    def _general_stress(self, points: PointSet) -> Array:
        assert self._problem.general is not None
        u = self._problem.u.x.array
        pressure = self._problem.general.pressure(u)[0]
        return general_kernels.cauchy_stress(u, points.tables, pressure, points.past)

    def plastic_strain(self) -> Array:
        """Committed equivalent plastic strain, (n_own_cells, m) [-]; zero where nothing yields."""
        own = self._mesh.topology.index_map(self._mesh.topology.dim).size_local
        values = np.zeros((own, self._count))
        if self._points is not None:
            values[self._points.cells] = self._points.past[:, :, 6]
        return values


def von_mises(stress: Array) -> Array:
    """Von Mises equivalent of tensors (..., 3, 3) [Pa]."""
    deviator = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
    return np.asarray(np.sqrt(1.5 * np.einsum("...ij,...ij->...", deviator, deviator)))
