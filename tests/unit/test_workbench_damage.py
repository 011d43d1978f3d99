"""Damage of any bit of a store is noticed, or harmless; none ends in anything but a word on it."""

from __future__ import annotations

import json
import multiprocessing
import os
import shutil
import subprocess
import sys
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.kept_arrays import kept_fault, read_kept, write_kept
from workbench.commands.results import run_list, run_prune, run_show
from workbench.execution.claims import Claims
from workbench.execution.fingerprint import text_sha256
from workbench.execution.integrity import MANIFEST, examined, sealed, unsealed
from workbench.execution.inventory import results
from workbench.execution.live_runs import announce, exclusive, keys_in_use
from workbench.execution.pruning import Rule, prune
from workbench.execution.store import Store

KEY = text_sha256("a task")


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """A store with one entry of two files."""
    store = Store(tmp_path / "store", study="mine")
    folder = store.scratch()
    (folder / "a.txt").write_text("result", encoding="utf-8")
    (folder / "sub").mkdir()
    (folder / "sub" / "b.bin").write_bytes(bytes(range(64)))
    record = {"task": "t", "function": "m:f", "inputs": {"load": 0.1, "é": [1e-300, True, None]}, "dofs": 7}
    store.put(KEY, folder, record | {"needs": {}, "origin": {"sources": {}}, "wall_s": 1.5})
    return store


def _flipped(whole: bytes) -> list[bytes]:
    """Each bit turned over, one at a time; each beginning."""
    found = []
    for bit in range(8 * len(whole)):
        damaged = bytearray(whole)
        damaged[bit // 8] ^= 1 << (bit % 8)
        found.append(bytes(damaged))
    return [*found, *(whole[:cut] for cut in range(len(whole)))]


def test_every_bit_of_an_entry_is_noticed(store: Store) -> None:
    for name in (MANIFEST, "a.txt", "sub/b.bin"):
        path = store.folder(KEY) / name
        whole = path.read_bytes()
        for damaged in _flipped(whole):
            path.write_bytes(damaged)
            assert store.get(KEY) is None, (name, damaged)
            assert store.fault(KEY).startswith(path.name)
        path.write_bytes(whole)
        assert store.get(KEY) is not None


@pytest.mark.parametrize("name", ["stored_at", "wall_s", "files", "sizes", "key", "schema", "task", "dofs", "needs"])
@pytest.mark.parametrize("value", ["nonsense", None, [1], {"a": 1}, -1.0, 1e300, True, "gone", "renamed"])
@pytest.mark.parametrize("earlier", [True, False])
def test_a_value_that_cannot_be_is_a_fault_and_no_more(
    store: Store, capsys: pytest.CaptureFixture[str], name: str, value: Any, earlier: bool
) -> None:
    """Whoever wrote it, with a right checksum or, as earlier versions, none: commands that look go on."""
    path = store.folder(KEY) / MANIFEST
    content = unsealed(path.read_text(encoding="utf-8"))
    assert content is not None
    content |= {"schema": 1} if earlier else {}
    kept = content.pop(name)
    content |= {} if value == "gone" else {f"{name}x": kept} if value == "renamed" else {name: value}
    path.write_text(json.dumps(content) if earlier else sealed(content), encoding="utf-8")
    fault = examined(store.folder(KEY), KEY)[1]
    harmless = name in ("task", "sizes", "dofs", "needs") and value in ("gone", "renamed", "nonsense")
    harmless = harmless or (name == "needs" and value == {}) or (name == "sizes" and value == {"a": 1})
    assert fault or harmless
    run_list(store.root, check=True)
    run_list(store.root, check=False)
    run_show(store.root, KEY[:12])
    run_prune(store.root, "1 d", None, None, dry_run=True)
    assert capsys.readouterr().out


def test_nested_brackets_without_end_are_a_fault(store: Store) -> None:
    (store.folder(KEY) / MANIFEST).write_text('{"a":' + "[" * 100000, encoding="utf-8")
    assert store.fault(KEY) == "manifest.json cannot be read"
    assert [one.fault for one in results(store)] == ["manifest.json cannot be read"]


def test_an_entry_of_an_earlier_version_is_whole(store: Store) -> None:
    path = store.folder(KEY) / MANIFEST
    content = unsealed(path.read_text(encoding="utf-8"))
    assert content is not None
    path.write_text(json.dumps(content | {"schema": 1}, indent=1), encoding="utf-8")
    assert store.fault(KEY) == ""
    assert store.get(KEY) is not None


def test_every_bit_of_a_checkpoint_is_noticed(tmp_path: Path) -> None:
    store = Store(tmp_path)
    path = store.checkpoint(KEY)
    write_kept(path, {"key": np.array("k"), "x": np.array([0.1, -3.0])})
    whole = path.read_bytes()
    assert (store.fault(KEY), kept_fault(path)) == ("", "")
    for damaged in _flipped(whole):
        path.write_bytes(damaged)
        assert read_kept(path) is None
    assert store.fault(KEY) == "the checkpoint has been changed since it was written"
    path.write_bytes(whole)
    found = read_kept(path)
    assert found is not None
    assert found["x"].tolist() == [0.1, -3.0]
    path.unlink()
    path.mkdir()
    assert read_kept(path) is None
    assert store.fault(KEY) == "the checkpoint cannot be read (Is a directory)"


def _live(root: Path, pipe: Connection) -> None:
    announce(root, [KEY])
    pipe.send("announced")
    pipe.recv()


def test_damage_of_what_a_living_run_uses_stops_pruning(store: Store) -> None:
    """One flipped digit of a key would free what is in use: whatever is damaged there, nothing is removed."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_live, args=(store.root, theirs), daemon=True)
    process.start()
    assert ours.recv() == "announced"
    (path,) = (store.root / "runs").iterdir()
    whole = path.read_bytes()
    for damaged in _flipped(whole):
        path.write_bytes(damaged)
        with exclusive(store.root), pytest.raises(InputError, match="cannot be read; try again"):
            keys_in_use(store.root)
    with pytest.raises(InputError, match="cannot be read; try again"):
        prune(store, Rule(larger_than=0.0))
    assert store.get(KEY) is not None
    path.write_bytes(whole)
    assert prune(store, Rule(larger_than=0.0)).in_use == 1
    process.kill()
    process.join()


def test_a_store_killed_at_any_file_operation_is_whole_or_empty(tmp_path: Path) -> None:
    process = [sys.executable, "-m", "tests.unit.dying_process", str(tmp_path), "store"]
    ended = subprocess.run(process, capture_output=True, text=True, check=True)
    cases = int(ended.stdout)
    assert cases > 8
    key, states = "ab" * 32, set()
    for number in range(1, cases + 1):
        store = Store(tmp_path / str(number))
        store.sweep()
        assert store.fault(key) == "", f"killed at operation {number}"
        entry = store.get(key)
        states.add(entry is not None)
        assert entry is None or (entry.path / "a.txt").read_text(encoding="utf-8") == "result"
        assert list((store.root / "tmp").iterdir()) == []
    assert states == {True, False}


def test_other_bytes_of_a_store_do_not_matter(store: Store) -> None:
    """The marker, the lock and claims count by their names alone, logs are for people."""
    for name in (".workbench-store", "lock", f"claims/{KEY}", "log/run-99999999.log"):
        (store.root / name).parent.mkdir(exist_ok=True)
        (store.root / name).write_bytes(b"\xff\x00nonsense")
    again = Store(store.root)
    again.sweep()
    announce(again.root, [KEY])
    assert again.get(KEY) is not None
    shutil.rmtree(store.root / "claims")


@pytest.mark.timeout(20)
def test_pipes_in_the_places_of_files_are_not_waited_at(store: Store) -> None:
    for path in (store.folder(KEY) / "a.txt", store.root / "lock", store.root / "claims" / KEY):
        path.unlink(missing_ok=True)
        path.parent.mkdir(exist_ok=True)
        os.mkfifo(path)
    assert store.fault(KEY) == "a.txt is no file"
    announce(store.root, [KEY])
    claims = Claims(store.root)
    assert claims.take(KEY)
    claims.give_back(KEY)
    (store.folder(KEY) / MANIFEST).unlink()
    os.mkfifo(store.folder(KEY) / MANIFEST)
    assert store.fault(KEY) == f"{MANIFEST} is missing"


def test_a_manifest_of_gigabytes_is_not_read(store: Store) -> None:
    with (store.folder(KEY) / MANIFEST).open("r+b") as stream:
        stream.truncate(10**12)
    assert store.fault(KEY) == f"{MANIFEST} cannot be read"
