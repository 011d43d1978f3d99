"""A body at its temperature before anything touches it: free of stress where its parts expand alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from contracts.errors import ConvergenceError
from contracts.materials import Material
from reference_fe.dolfinx_api import Function
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver

__all__ = ["dilate", "solve_thermal_state"]


def dilate(u: Function, stretch: float) -> None:
    """Set u = (stretch - 1) X [m] for a stretch [-], the free expansion about the origin."""
    u.interpolate(lambda X: (stretch - 1.0) * X[: u.function_space.mesh.geometry.dim])


def solve_thermal_state(
    domain: Domain,
    materials: Mapping[str, Material],
    supports: Sequence[Support],
    discretisation: Discretisation,
    settings: NewtonSettings,
    transverse_constraint: Mapping[str, float] | None = None,
) -> StaticProblem:
    """Solve for the displacement of a supported body whose parts have expanded, without loads or contact.

    Starts from the free expansion of the part with most cells, which is the answer if all expand alike. Residuals are
    held against the force that would keep the body from expanding. ``transverse_constraint`` [-] is `StaticProblem`'s.

    Returns
    -------
    problem : in its thermal state, ``problem.u`` [m] counted from the shape at 20 C

    Raises
    ------
    ConvergenceError
        If Newton's iteration fails.

    Verified by tests/verification/test_fe_thermal.py.
    """
    problem = StaticProblem(
        domain, materials, supports, discretisation=discretisation, transverse_constraint=transverse_constraint
    )
    held_back = float(np.sqrt(domain.mesh.comm.allreduce(float(np.sum(problem.residual() ** 2)))))
    tagged = domain.tagged
    largest = max(materials, key=lambda part: int(np.count_nonzero(tagged.cell_tags == tagged.parts[part])))
    dilate(problem.u, materials[largest].thermal_stretch)
    outcome = NewtonSolver(problem, settings, inner_force=held_back).solve()
    if not outcome.converged:
        last = outcome.residuals[-1]
        message = f"the thermal state does not converge: last relative residual {last:.1e}; try a finer mesh"
        raise ConvergenceError(message, ())
    return problem
