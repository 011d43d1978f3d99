"""Question: whether another code finds the same loads on our mesh.

Answered from a record (`workbench.questions.kept`) and the curves of this report; without a record it is not asked.
Verified by tests/unit/test_workbench_crosscheck.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.crosscheck.results import COMMAND, NAME, PeerCheck, peer_check, whole
from workbench.questions.kept import kept
from workbench.questions.model_curves import model_curves
from workbench.questions.question import Question
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most

__all__ = ["CROSSCHECK", "LIMIT"]

LIMIT = 0.01
"""Largest difference of a load that counts as agreement [-]."""


def _read(study: Study, folders: Mapping[str, Path]) -> PeerCheck:
    record = kept(study, NAME, whole)
    if record is None:
        raise InputError(f"record {NAME}", "none", "is needed", COMMAND)
    return peer_check(study, record, model_curves("fe", folders, around(study)).loaded)


def _checks(study: Study, results: PeerCheck) -> Sequence[Check]:
    return [_check(results, deflection) for deflection in results.deflections]


def _check(results: PeerCheck, deflection: float) -> Check:
    """Undecided where the record is about another wheel: its numbers say nothing of this one."""
    where = f"{1e3 * deflection:g} mm"
    claim = Claim(
        id=f"crosscheck.load_{where.replace(' ', '')}",
        title=f"FE against {results.record.found['peer']}, {where}: largest difference of the load at any orientation",
        quantity="difference",
        unit="-",
        role="finding",
        source=f"{results.record.found['peer']} on the same mesh, {results.record.date[:10]}; the limit is ours",
    )
    check = at_most(claim, partial(results.largest, deflection), LIMIT)
    if results.state != "stale":
        return check
    words = f"{check.tolerance}; the kept record is of another wheel, mesh or load case"
    return replace(check, tolerance=words, status="undecided")


CROSSCHECK = Question(
    name="crosscheck",
    title="Another code",
    group="Solvers",
    read=_read,
    checks=_checks,
    applies=lambda study: kept(study, NAME, whole) is not None,
)
