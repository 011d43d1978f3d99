"""Elastic energy of a static problem, from the stored energy function itself: independent of residual and tangent."""

from __future__ import annotations

import numpy as np

from reference_fe import dolfinx_api as api
from reference_fe.cells.choice import form_laws
from reference_fe.dolfinx_api import ufl
from reference_fe.material.hyperelastic import stored_energy_density
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["StoredEnergy"]


class StoredEnergy:
    """Energy of the deformable cells at the problem's present displacement.

    It is summed at the Gauss points of the problem's own rule: the discrete equilibrium is stationary in this sum, so
    that work done and energy stored differ by no discretisation error. Work of plastic flow is counted apart.

    Verified by tests/verification/test_fe_energy.py and tests/verification/test_fe_laws_plastic.py.
    """

    def __init__(self, problem: StaticProblem) -> None:
        self._problem, domain = problem, problem.domain
        points, self._weights = api.gauss_rule(problem.discretisation.gauss_points)
        volume = domain.width * abs(ufl.JacobianDeterminant(domain.mesh))
        laws = form_laws({part: law for part, law in problem.laws.items() if part not in problem.general_laws})
        self._forms = list[tuple[list[str], PointEvaluation]]()
        for law in sorted(set(laws.values())):
            density = stored_energy_density(law, problem.u, problem.lame, problem.stretch)
            self._forms.append(([p for p in laws if laws[p] is law], PointEvaluation(density * volume, points)))

    def value(self) -> float:
        """Elastic energy of the meshed body [J]; a half width is not doubled."""
        total, domain, general = 0.0, self._problem.domain, self._problem.general
        for parts, at_points in self._forms:
            cells = domain.cells_of(parts)
            total += float(np.sum(at_points(domain.mesh, cells).reshape(-1, len(self._weights)) @ self._weights))
        if general is not None:
            total += general.stored_energy(self._problem.u.x.array)
        return float(domain.mesh.comm.allreduce(total))

    def plastic_dissipation(self) -> float:
        """Work of plastic flow up to the last accepted state [J], what hardening keeps of it included."""
        general = self._problem.general
        return float(api.COMM.allreduce(0.0 if general is None else general.plastic_dissipation()))
