"""Balance of the whole body: forces and moments of supports and obstacles.

Verified by tests/unit/test_fe_balance.py, tests/unit/test_fe_supports.py and tests/verification/test_fe_wheel.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.contact.obstacle import moment_of
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["support_forces", "support_moment"]


def support_forces(problem: StaticProblem, residual: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Force on the body of every support that has a name, (dim,) [N] each.

    An unknown that supports of several names hold counts for each of them; `StaticProblem.reaction` counts it once.

    Parameters
    ----------
    problem : in the state of the residual
    residual : (n_own_dofs,) [N], such as that of a `NewtonOutcome`
    """
    dim, found = problem.domain.dim, dict[str, NDArray[np.float64]]()
    names = sorted({one.name for one in problem.prescribed if one.name})
    for name in names:
        rows = np.unique(np.concatenate([one.dofs for one in problem.prescribed if one.name == name]))
        rows = rows[rows < problem.own_dofs]
        own = np.array([residual[rows[rows % dim == axis]].sum() for axis in range(dim)])
        found[name] = np.asarray(problem.domain.mesh.comm.allreduce(own))
    return found


def support_moment(problem: StaticProblem, residual: NDArray[np.float64]) -> NDArray[np.float64]:
    """Moment of the support forces about the origin at the deformed nodes, (3,) [N m]; (1,) in the plane.

    The forces are the residual at supported unknowns. A rigid rotation of the deformed body is in the test space, so
    that in equilibrium this and the obstacles' moment add up to zero, contact between parts included.

    Parameters
    ----------
    problem : in the state of the residual; its elements have nodal values (Lagrange)
    residual : (n_own_dofs,) [N]
    """
    dim, rows = problem.domain.dim, problem.own_supported
    force = np.zeros(problem.own_dofs)
    force[rows] = residual[rows]
    u = problem.u.x.array[: problem.own_dofs].reshape(-1, dim)
    x = problem.V.tabulate_dof_coordinates()[: len(u), :dim] + u
    own = moment_of(x, force.reshape(-1, dim)).sum(axis=0)
    return np.atleast_1d(np.asarray(problem.domain.mesh.comm.allreduce(own)))
