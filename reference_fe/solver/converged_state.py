"""What a driver of increments gives at each equilibrium."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference_fe.problem.static_problem import ProblemState
from reference_fe.solver.newton import NewtonOutcome

__all__ = ["ConvergedState"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvergedState:
    """One converged increment.

    Attributes
    ----------
    control : control parameter reached [m for a raised plane, - for a load factor]
    wanted : whether it is one of the targets asked for, not only a cut-back stop on the way
    start : the state that its increment began with
    outcome : Newton history and residual
    contact_force : force of the plane on the body [N]
    reaction : sum of the support forces on the body [N]
    """

    control: float
    wanted: bool
    start: ProblemState
    outcome: NewtonOutcome
    contact_force: NDArray[np.float64]
    reaction: NDArray[np.float64]
