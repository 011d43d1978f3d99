"""The rover beside the same rover in another code, as ``make bench NAME=rover_exudyn`` kept it.

Both are on Table II's tires, whatever the study's. The tests compare the two anew each time they run
(`tests/verification/test_rover_exudyn.py`); the record is for the page.
Verified by tests/unit/test_workbench_rover_peer.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from contracts.records import Check
from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from workbench.execution.fingerprint import file_sha256
from workbench.execution.task import Task
from workbench.questions.kept import Kept, State, kept
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most, undecided

__all__ = ["COMMAND", "RECORD", "PeerRow", "RoverPeer", "peer_checks", "peer_tasks", "rover_peer", "rows_of"]

RECORD, COMMAND = "rover_exudyn", "make bench NAME=rover_exudyn"


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerRow:
    """One comparison where the two codes are furthest apart.

    Attributes
    ----------
    key, case, quantity, unit : what is compared, in short and in words
    ours, peer : values there [unit]
    difference, limit : largest difference, and the largest that counts as agreement [unit]
    """

    key: str
    case: str
    quantity: str
    unit: str
    ours: float
    peer: float
    difference: float
    limit: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RoverPeer:
    """A record, whether it is about the rover as it is now, and its rows."""

    record: Kept
    state: State
    rows: tuple[PeerRow, ...]


def peer_tasks() -> list[Task]:
    """What a record is about: the rover's file, and the sources its scenarios are driven by."""
    inputs = {"rover": file_sha256(EXOMARS_ROVER)}
    return [Task(name=RECORD, function="workbench.questions.rover.task:drive_rover", inputs=inputs)]


def rows_of(found: Mapping[str, Any]) -> tuple[PeerRow, ...]:
    """Of a record; raises for what it cannot hold."""
    rows = tuple(PeerRow(**row) for row in found["rows"])
    for row in rows:
        values = [getattr(row, one.name) for one in fields(row)]
        if not (all(isinstance(text, str) for text in values[:4]) and all(map(math.isfinite, values[4:]))):
            raise ValueError("a row has key, case, quantity and unit in words, and four finite numbers")
        if not row.key.strip():
            raise ValueError("a row has a key")
        if not (row.limit > 0.0 and row.difference >= 0.0):
            raise ValueError("a limit is above zero and a difference not below")
    if not (rows and isinstance(found["peer"], str) and len({row.key for row in rows}) == len(rows)):
        raise ValueError("there are rows, each with a key of its own, and the name of the other code")
    return rows


def rover_peer(study: Study) -> RoverPeer | None:
    """What is kept beside the study; raises InputError for a record that cannot be read."""
    record = kept(study, RECORD, rows_of)
    if record is None:
        return None
    return RoverPeer(record=record, state=record.state(peer_tasks()), rows=rows_of(record.found))


def peer_checks(peer: RoverPeer | None) -> Sequence[Check]:
    """One for each row; undecided where the record is of another rover's file."""
    if peer is None:
        return []
    checks = [_check(peer, row) for row in peer.rows]
    if peer.state != "stale":
        return checks
    return [undecided(check, "the kept record is of another rover file") for check in checks]


def _check(peer: RoverPeer, row: PeerRow) -> Check:
    name = peer.record.found["peer"]
    claim = Claim(
        id=f"rover.exudyn_{row.key}",
        title=f"Rover against {name}, {row.case}: largest difference of {row.quantity}",
        quantity="difference",
        unit=row.unit,
        role="finding",
        source=f"{name} on a model from the rover's file, {peer.record.date[:10]}; limits are what an earlier one met",
    )
    return at_most(claim, lambda: row.difference, row.limit)
