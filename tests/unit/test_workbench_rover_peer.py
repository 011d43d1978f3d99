"""The rover in another code: what a record holds, what a stale one decides, what the page says."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from benchmarks.peer_codes.rover_cases import CASES
from contracts.errors import InputError
from workbench.questions.kept import keep
from workbench.questions.rover.peer import COMMAND, RECORD, RoverPeer, peer_checks, peer_tasks, rover_peer
from workbench.questions.rover.question import ROVER
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

ROW = {"key": "level_loads", "case": "at rest on level ground, wheels free", "quantity": "wheel load", "unit": "N"}
ROW |= {"ours": 198.0, "peer": 198.0005, "difference": 5e-4, "limit": 1e-3}
FOUND = {
    "peer": "Peer 1",
    "rows": [ROW, {**ROW, "key": "drop_place", "unit": "m", "difference": 1e-5, "limit": 4.5e-6}],
}


@pytest.fixture
def study(tmp_path: Path) -> Study:
    path = tmp_path / "own.toml"
    path.write_text(built_in_study().read_text(encoding="utf-8"), encoding="utf-8")
    return read_study(path)


def kept_peer(study: Study, found: dict[str, Any]) -> RoverPeer:
    keep(study, RECORD, COMMAND, peer_tasks(), 60.0, found)
    peer = rover_peer(study)
    assert peer is not None
    return peer


def test_without_a_record_there_is_no_check(study: Study) -> None:
    assert rover_peer(study) is None
    assert peer_checks(None) == []


def test_each_row_is_a_finding_and_one_beyond_its_limit_fails(study: Study) -> None:
    peer = kept_peer(study, FOUND)
    assert peer.state == "current"
    first, second = peer_checks(peer)
    assert (first.id, first.role, first.status, first.value) == ("rover.exudyn_level_loads", "finding", "pass", 5e-4)
    assert (second.id, second.role, second.status) == ("rover.exudyn_drop_place", "finding", "fail")
    assert "at rest on level ground, wheels free" in first.claim


def test_a_record_of_another_rover_file_decides_nothing_and_one_of_older_sources_does(study: Study) -> None:
    peer = kept_peer(study, FOUND)
    assert {check.status for check in peer_checks(replace(peer, state="stale"))} == {"undecided"}
    assert [check.status for check in peer_checks(replace(peer, state="older sources"))] == ["pass", "fail"]


@pytest.mark.parametrize(
    "rows",
    [
        [],
        [{**ROW, "limit": 0.0}],
        [{**ROW, "ours": "198"}],
        [{**ROW, "more": 1}],
        [ROW, ROW],
        [{"key": "a"}],
        [{**ROW, "key": " "}],
    ],
)
def test_what_no_run_writes_is_refused(study: Study, rows: list[dict[str, Any]]) -> None:
    with pytest.raises(InputError, match="kept record"):
        kept_peer(study, {"peer": "Peer 1", "rows": rows})
    with pytest.raises(InputError, match="kept record"):
        ROVER.applies(study)  # before anything is computed


def test_the_record_of_the_built_in_study_is_whole() -> None:
    """A row for each comparison that the tests make, within its limit as it was kept."""
    peer = rover_peer(read_study(built_in_study()))
    assert peer is not None
    limits = {f"{name}_{what}": limit for name, case in CASES.items() for what, limit in case.limits.items()}
    assert {row.key: row.limit for row in peer.rows} == limits
    assert all(row.difference < row.limit for row in peer.rows)
    assert json.dumps(peer.record.found["peer"]).startswith('"EXUDYN 1.')
