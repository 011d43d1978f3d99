"""Elastic energy of a static problem, from the stored energy function itself: independent of residual and tangent."""

from __future__ import annotations

import numpy as np

from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import ufl
from reference_fe.material.hyperelastic import stored_energy_density
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["StoredEnergy"]


class StoredEnergy:
    """Energy of the deformable cells at the problem's present displacement.

    It is summed at the Gauss points of the problem's own rule: the discrete equilibrium is stationary in this sum, so
    that work done and energy stored differ by no discretisation error.

    Verified by tests/verification/test_fe_energy.py.
    """

    def __init__(self, problem: StaticProblem) -> None:
        domain, choice = problem.domain, problem.discretisation
        points, self._weights = api.gauss_rule(choice.gauss_points)
        density = stored_energy_density(choice.law, problem.u, problem.lame, problem.stretch)
        volume = domain.width * abs(ufl.JacobianDeterminant(domain.mesh))
        self._at_points = PointEvaluation(density * volume, points)
        self._mesh, self._cells = domain.mesh, domain.cells_of(problem.materials)

    def value(self) -> float:
        """Energy of the meshed body [J]; a half width is not doubled."""
        values = self._at_points(self._mesh, self._cells).reshape(len(self._cells), -1)
        return float(self._mesh.comm.allreduce(float(np.sum(values @ self._weights))))
