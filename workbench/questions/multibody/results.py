"""Multibody benchmarks: paths, errors, work.

Verified by tests/unit/test_workbench_multibody.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contracts.errors import InputError

if TYPE_CHECKING:
    pass
    from rover_dynamics.multibody.verification.work_precision import Problem

__all__ = ["MultibodyResults", "WorkRow", "problem_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkRow:
    """One motion: its problem, ``"explicit"`` or ``"implicit"``, error allowed in a step, and what `Work` holds."""

    problem: str
    method: str
    allowed: float
    error: float
    energy: float | None
    seconds: float
    steps: int
    evaluations: int

    @property
    def title(self) -> str:
        """Of the problem."""
        return problem_of(self.problem).title

    @property
    def unit(self) -> str:
        """Of the error; nothing where it is relative."""
        unit = problem_of(self.problem).unit
        return "" if unit == "-" else unit


@dataclass(frozen=True, slots=True, kw_only=True)
class MultibodyResults:
    """All motions, and the error that the equation of one angle has on A02 with 1e-4 a step [m]."""

    rows: tuple[WorkRow, ...]
    one_angle: float

    def of(self, problem: str, method: str, allowed: float) -> WorkRow:
        """One motion; InputError if it was not computed."""
        for row in self.rows:
            if (row.problem, row.method, row.allowed) == (problem, method, allowed):
                return row
        raise InputError("error allowed in a step", f"{allowed:g}", "was not computed", "look at the task's result")


def problem_of(name: str) -> Problem:
    from rover_dynamics.multibody.verification.work_precision import PROBLEMS

    return PROBLEMS[name]
