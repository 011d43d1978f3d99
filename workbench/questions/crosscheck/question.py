"""Question: whether another code finds the same loads on our mesh.

Answered from a record (`workbench.questions.kept`) and the curves of this report; without a record it is not asked.
Verified by tests/unit/test_workbench_crosscheck.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.crosscheck.results import COMMAND, NAME, PeerCheck, peer_check, whole
from workbench.questions.kept import OF_ANOTHER, kept
from workbench.questions.model_curves import model_curves
from workbench.questions.question import Question
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most, undecided

__all__ = ["CROSSCHECK", "LIMIT"]

OF_OLDER = "both sides of the kept record are by older sources"
LIMIT = 0.01
"""Largest difference of a force that counts as agreement [-]."""


def _read(study: Study, folders: Mapping[str, Path]) -> PeerCheck:
    record = kept(study, NAME, whole)
    if record is None:
        raise InputError(f"record {NAME}", "none", "is needed", COMMAND)
    return peer_check(study, record, model_curves("fe", folders, around(study)).loaded)


def _checks(study: Study, results: PeerCheck) -> Sequence[Check]:
    peer, found = results.record.found["peer"], []
    for deflection in results.deflections:
        where, largest = f"{1e3 * deflection:g} mm", partial(results.largest, deflection)
        title = f"FE against {peer}, {where}: largest difference of the load at any orientation"
        found.append(_check(results, f"load_{where.replace(' ', '')}", title, largest))
    title = f"FE against {peer}, hub moved forwards with friction: largest difference of the stiffness"
    along = _check(results, "fore_aft", title, results.largest_travelled)
    return [*found, undecided(along, OF_OLDER) if results.state == "older sources" else along]


def _check(results: PeerCheck, name: str, title: str, measure: Callable[[], float]) -> Check:
    """Undecided where the record is about another wheel: its numbers say nothing of this one."""
    claim = Claim(
        id=f"crosscheck.{name}",
        title=title,
        quantity="difference",
        unit="-",
        role="finding",
        source=f"{results.record.found['peer']} on the same mesh, {results.record.date[:10]}; the limit is ours",
    )
    check = at_most(claim, measure, LIMIT)
    return check if results.state != "stale" else undecided(check, OF_ANOTHER)


CROSSCHECK = Question(
    name="crosscheck",
    title="Another code",
    group="Solvers",
    read=_read,
    checks=_checks,
    applies=lambda study: kept(study, NAME, whole) is not None,
)
