"""Records of the report: one check, one timing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Check", "Role", "Status", "Timing"]

Status = Literal["pass", "fail", "error"]
Role = Literal["gate", "finding"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One line of the verdict.

    Attributes
    ----------
    id : stable identifier, e.g. ``"fe.initial_tangent"``
    title : what is checked, one sentence
    quantity, unit : name of the number and its unit (SI, or ``"-"``)
    value : the number found; None if it could not be computed
    reference : number, or [low, high], it is held against
    tolerance : how far it may lie off, in words with its number, e.g. ``"3 %"``
    status : ``"pass"``, ``"fail"`` or ``"error"`` (could not be evaluated)
    role : ``"gate"`` (must hold) or ``"finding"`` (what the comparison found)
    source : where the reference comes from
    """

    id: str
    title: str
    quantity: str
    unit: str
    value: float | None
    reference: float | tuple[float, float] | None
    tolerance: str
    status: Status
    role: Role
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """Wall time of one task.

    Attributes
    ----------
    task : task name
    wall_s : wall time of the computation that made the stored result [s]
    dofs : number of unknowns, 0 where it has no meaning
    """

    task: str
    wall_s: float
    dofs: int
