"""Records of the report: one check, one timing. Verified by tests/unit/test_workbench_statements.py."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from contracts.errors import InputError

__all__ = ["Check", "Role", "Status", "Timing"]

Status = Literal["pass", "fail", "undecided", "error"]
Role = Literal["gate", "finding"]
_HINT = "words of checks stand in workbench/questions/*/statements.toml"


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
    status : ``"pass"``, ``"fail"``, ``"undecided"`` (what is not known reaches across the limit, or the run ended
        before it) or ``"error"`` (could not be evaluated); the last two never count as passed
    role : ``"gate"`` (must hold) or ``"finding"`` (what the comparison found)
    source : where the reference comes from: thesis or paper, with its figure, equation or section where there is one
    claim : what holds if the check passes, one sentence
    why : why the tolerance is what it is
    theory : section of docs/theory.md that derives it, e.g. ``"2.7"``; empty where there is none
    tests : test files that verify the rule or the model behind it, relative to the repository

    Raises
    ------
    InputError
        If one of the words a reader needs is missing, or the claim is no sentence.
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
    claim: str
    why: str
    theory: str = ""
    tests: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("id", "title", "tolerance", "source", "claim", "why"):
            if not getattr(self, name).strip():
                raise InputError(f"check {self.id}", f"no {name}", "must have one", _HINT)
        if not (self.claim[0].isupper() or self.claim[0].isdigit()) or not self.claim.endswith("."):
            raise InputError(f"claim of check {self.id}", self.claim, "must be a sentence", _HINT)


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
