"""What the control parameter changes: loads, supports, and the place of an obstacle; whether the way there counts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe.contact.soil_ground import SoilContact
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["control_rate", "depends_on_the_way"]

type Array = NDArray[np.float64]


def control_rate(problem: StaticProblem, control: float, body_residual: Array) -> tuple[Array, Array]:
    """Derivatives by the control parameter at held displacement: of the residual, and of the supports' displacement.

    Loads and supports are linear in it, so that a unit step is exact. An obstacle that rises along r is a body that
    moves along -r: its force f has df/dcontrol = K_f r with K_f = -df/du, and what parts of the body do to each other
    does not change by a translation.

    Parameters
    ----------
    problem : its surface terms were last evaluated at the present displacement
    control : its control parameter
    body_residual : (n_own_dofs,) residual without the surface terms there [N]

    Returns
    -------
    force, displacement : (n_own_dofs,) each [N and m per unit of the control parameter]

    Raises
    ------
    InputError
        For an obstacle that does not only rise.

    Verified by tests/verification/test_fe_arc_length.py.
    """
    own = problem.own_dofs
    force, displacement = -body_residual, -_prescribed(problem)[:own]
    if problem.surfaces.terms:
        force -= _lift(problem)
    problem.set_control(control + 1.0)
    force += problem.body_residual()
    displacement += _prescribed(problem)[:own]
    problem.set_control(control)
    return force, displacement


def depends_on_the_way(problem: StaticProblem) -> bool:
    """Whether equilibria depend on how they are reached: material with a memory, friction, multipliers of contact.

    And soil, whose level parts are put right between solves, which the tangent does not know.

    Verified by tests/verification/test_fe_arc_length.py, tests/verification/test_fe_limit_point.py and
    tests/verification/test_fe_soil.py.
    """
    contact = problem.contact
    mended = isinstance(contact, SoilContact) or (contact is not None and contact.closes_gaps)
    return bool(problem.histories.remembered) or not problem.surfaces.symmetric or mended


def _prescribed(problem: StaticProblem) -> Array:
    """Displacement with that of the supports at the control parameter, zero elsewhere, (n_dofs,) [m]."""
    values: Array = np.zeros_like(problem.u.x.array)
    for bc in problem.bcs:
        bc.set(values)
    return values


def _lift(problem: StaticProblem) -> Array:
    """Derivative of the contact forces by the obstacle's rise, (n_own_dofs,) [N/m]."""
    contact = problem.contact
    if contact is None:
        return np.zeros(problem.own_dofs)
    if contact.travel is not None:
        raise InputError("travel of the hub", "", "is not followed along a path", "leave the travel away")
    rise = np.tile(contact.axes()[2], problem.own_dofs // problem.domain.dim)
    return problem.surfaces.product(problem.surfaces.stiffness(), rise)
