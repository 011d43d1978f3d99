"""Pruning: what a rule chooses; what a living run uses stays; checkpoints, scratch and logs of ended runs go too."""

from __future__ import annotations

import multiprocessing
import os
import time
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from workbench.execution.fingerprint import text_sha256
from workbench.execution.inventory import Kept, leftovers, results
from workbench.execution.live_runs import announce, exclusive, keys_in_use
from workbench.execution.progress import duration_text
from workbench.execution.pruning import Rule, chosen, prune
from workbench.execution.store import Store

DAY = 86400.0
NOW = 1000.0 * DAY


def _kept(name: str, days: float, size: int = 10, task: str = "fe_phi000") -> Kept:
    return Kept(kind="result", name=name, path=Path(name), task=task, stored_at=NOW - days * DAY, size=size)


KEPT = (_kept("new", 1.0), _kept("old", 40.0), _kept("mesh", 50.0, 100, "mesh"), _kept("oldest", 60.0))


@pytest.mark.parametrize(
    ("rule", "expected"),
    [
        (Rule(older_than=30 * DAY), ["oldest", "mesh", "old"]),
        (Rule(task="fe_*"), ["oldest", "old", "new"]),
        (Rule(task="fe_*", older_than=30 * DAY), ["oldest", "old"]),
        (Rule(larger_than=125.0), ["oldest"]),
        (Rule(larger_than=20.0), ["oldest", "mesh"]),
        (Rule(larger_than=0.0), ["oldest", "mesh", "old", "new"]),
        (Rule(larger_than=130.0), []),
        (Rule(larger_than=0.0, older_than=45 * DAY), ["oldest", "mesh"]),
        (Rule(task="mesh", larger_than=125.0), ["mesh"]),
    ],
)
def test_a_rule_chooses_the_oldest_first(rule: Rule, expected: list[str]) -> None:
    assert [one.name for one in chosen(KEPT, rule, NOW)] == expected


def test_what_is_in_use_is_not_chosen_and_still_counts_for_the_size() -> None:
    assert [one.name for one in chosen(KEPT, Rule(larger_than=125.0), NOW, {"oldest"})] == ["mesh"]


def test_a_size_looks_past_names_that_are_out_of_reach() -> None:
    """Checkpoints and logs count for the size, and go by age alone, never by a task's name."""
    log = Kept(kind="log", name="run-1.log", path=Path("run-1.log"), stored_at=NOW - 90 * DAY, size=5)
    assert chosen([log], Rule(task="*"), NOW) == []
    assert chosen([log], Rule(older_than=DAY), NOW) == [log]


def _filled(root: Path) -> tuple[Store, list[str]]:
    store = Store(root, study="mine")
    keys = [text_sha256(name) for name in "abc"]
    for key, name in zip(keys, "abc", strict=True):
        folder = store.scratch()
        (folder / "sub").mkdir()
        (folder / "sub" / "x.txt").write_text(name * 10, encoding="utf-8")
        store.put(key, folder, {"task": name, "wall_s": 1.0})
    return store, keys


def test_results_are_listed_with_what_was_recorded(tmp_path: Path) -> None:
    store, keys = _filled(tmp_path)
    (store.folder(keys[1]) / "sub" / "x.txt").write_text("b", encoding="utf-8")
    (store.folder(keys[2]) / "manifest.json").write_text("{", encoding="utf-8")
    found = {one.name: one for one in results(store, check=True)}
    assert set(found) == set(keys)
    assert (found[keys[0]].task, found[keys[0]].study, found[keys[0]].fault) == ("a", "mine", "")
    assert found[keys[1]].fault == "x.txt has 1 of 10 bytes"
    assert found[keys[2]].fault == "manifest.json cannot be read"
    assert {one.fault for one in results(store)} == {"", "manifest.json cannot be read"}


def _use(root: Path, keys: list[str], pipe: Connection) -> None:
    announce(root, keys[:1])
    announce(root, keys[1:])
    pipe.send("announced")
    pipe.recv()


def test_pruning_leaves_what_a_living_run_uses_and_takes_it_when_the_run_ended(tmp_path: Path) -> None:
    """A real second process uses two of three results and a checkpoint; killed, it uses nothing."""
    store, keys = _filled(tmp_path)
    for key in (keys[0], keys[2]):
        store.checkpoint(key).write_bytes(b"half")
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_use, args=(tmp_path, keys[:2], theirs), daemon=True)
    process.start()
    assert ours.recv() == "announced"
    everything = Rule(larger_than=0.0)
    dry = prune(store, everything, dry_run=True)
    assert {one.name for one in dry.removed} == {keys[2]}
    assert len(results(store)) == 3
    found = prune(store, everything)
    assert found.in_use == 3
    assert {one.name for one in results(store)} == set(keys[:2])
    assert [one.name for one in leftovers(store)] == [keys[0]]
    process.kill()
    process.join()
    prune(store, everything)
    assert results(store) == []
    assert leftovers(store) == []
    assert list((tmp_path / "tmp").iterdir()) == []
    with exclusive(tmp_path):
        assert keys_in_use(tmp_path) == frozenset()


def test_scratch_and_logs_of_this_process_stay(tmp_path: Path) -> None:
    store = Store(tmp_path)
    mine = store.scratch()
    foreign = tmp_path / "tmp" / "elsewhere-1-00000000"
    foreign.mkdir()
    logs = [tmp_path / "log" / f"run-{pid}.log" for pid in (os.getpid(), 99999999)]
    for log in logs:
        log.write_text("text", encoding="utf-8")
    prune(store, Rule(older_than=0.0))
    assert (mine.exists(), foreign.exists()) == (True, True)
    assert [log.exists() for log in logs] == [True, False]
    os.utime(foreign, (time.time() - 8 * DAY,) * 2)
    prune(store, Rule(older_than=0.0))
    assert not foreign.exists()


@pytest.mark.parametrize(("seconds", "text"), [(0.2, "0 s"), (59.0, "59 s"), (7200.0, "2 h"), (3 * DAY, "3 d")])
def test_ages_have_units(seconds: float, text: str) -> None:
    assert duration_text(seconds) == text
