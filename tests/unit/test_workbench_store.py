"""The store: an entry is whole or absent; damage is recognised; two runs at once leave one whole entry."""

from __future__ import annotations

import multiprocessing
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from workbench.execution.fingerprint import canonical_json, text_sha256
from workbench.execution.integrity import sealed, unsealed
from workbench.execution.store import MANIFEST, Store
from workbench.execution.store_folder import MARKER

KEY = text_sha256("a task")
RECORD = {"task": "t", "wall_s": 1.5, "dofs": 7}


def _put(store: Store, text: str = "result") -> None:
    folder = store.scratch()
    (folder / "a.txt").write_text(text, encoding="utf-8")
    (folder / "sub").mkdir()
    (folder / "sub" / "b.txt").write_text("more", encoding="utf-8")
    store.put(KEY, folder, RECORD)


def test_what_is_put_is_found_again(tmp_path: Path) -> None:
    store = Store(tmp_path)
    assert store.get(KEY) is None
    _put(store)
    entry = Store(tmp_path).get(KEY)
    assert entry is not None
    assert (entry.path / "a.txt").read_text(encoding="utf-8") == "result"
    assert (entry.wall_s, entry.dofs) == (1.5, 7)
    assert sorted(entry.manifest["files"]) == ["a.txt", "sub/b.txt"]
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        ("edit", "a.txt has been changed since it was stored"),
        ("truncate", "a.txt has 0 of 6 bytes"),
        ("append", "a.txt has grown"),
        ("remove file", "b.txt is missing"),
        ("remove manifest", "manifest.json is missing"),
        ("cut manifest", "manifest.json cannot be read"),
        ("odd manifest", "manifest.json cannot be read"),
        ("changed manifest", "manifest.json has been changed since it was stored"),
        ("foreign manifest", "manifest.json belongs to another result"),
    ],
)
def test_a_damaged_entry_is_told_not_trusted_and_replaced(tmp_path: Path, damage: str, told: str) -> None:
    store = Store(tmp_path)
    _put(store)
    folder = store.folder(KEY)
    manifest = folder / MANIFEST
    if damage == "edit":
        (folder / "a.txt").write_text("resulT", encoding="utf-8")
    elif damage == "truncate":
        (folder / "a.txt").write_text("", encoding="utf-8")
    elif damage == "append":
        (folder / "a.txt").write_text("results", encoding="utf-8")
    elif damage == "foreign manifest":
        content = unsealed(manifest.read_text(encoding="utf-8"))
        assert content is not None
        manifest.write_text(sealed(content | {"key": "0" * 64}), encoding="utf-8")
    elif damage == "changed manifest":
        manifest.write_text(manifest.read_text(encoding="utf-8").replace("1.5", "1.6"), encoding="utf-8")
    elif damage == "remove file":
        (folder / "sub" / "b.txt").unlink()
    elif damage == "remove manifest":
        manifest.unlink()
    elif damage == "cut manifest":
        manifest.write_bytes(manifest.read_bytes()[:40])
    else:
        manifest.write_text("[1, 2]", encoding="utf-8")
    assert store.get(KEY) is None
    assert store.fault(KEY) == told
    _put(store)
    assert store.get(KEY) is not None
    assert store.fault(KEY) == ""
    assert list((tmp_path / "tmp").iterdir()) == []


def test_a_folder_left_by_a_killed_run_is_no_entry_and_is_swept(tmp_path: Path) -> None:
    store = Store(tmp_path)
    process = multiprocessing.get_context("spawn").Process(target=_leave_scratch, args=(tmp_path,))
    process.start()
    process.join()
    assert len(list((tmp_path / "tmp").iterdir())) == 1
    mine = store.scratch()
    store.sweep()
    assert list((tmp_path / "tmp").iterdir()) == [mine]
    assert store.get(KEY) is None


def _leave_scratch(root: Path) -> None:
    (Store(root).scratch() / "half.txt").write_text("torn", encoding="utf-8")


def _put_often(root: Path, text: str) -> None:
    store = Store(root)
    for _ in range(30):
        _put(store, text)


def test_two_runs_at_once_leave_one_whole_entry(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=_put_often, args=(tmp_path, "result")) for _ in range(2)]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
    assert [p.exitcode for p in processes] == [0, 0]
    entry = Store(tmp_path).get(KEY)
    assert entry is not None
    assert (entry.path / "a.txt").read_text(encoding="utf-8") == "result"
    assert list((tmp_path / "tmp").iterdir()) == []


def test_a_file_in_the_way_is_one_clear_error(tmp_path: Path) -> None:
    (tmp_path / "store").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="--store"):
        Store(tmp_path / "store")


def test_canonical_json_does_not_depend_on_order_and_refuses_nan() -> None:
    assert canonical_json({"b": 1.0, "a": [0.1]}) == canonical_json({"a": [0.1], "b": 1.0})
    assert canonical_json({"a": 0.1}) != canonical_json({"a": float(np.nextafter(0.1, 1.0))})
    with pytest.raises(ValueError, match="JSON"):
        canonical_json({"a": float("nan")})


@pytest.mark.parametrize("name", ["tmp", "log"])
def test_a_file_in_a_folder_s_place_is_one_message(tmp_path: Path, name: str) -> None:
    (tmp_path / MARKER).touch()
    (tmp_path / name).write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match=rf"result store.*{name} cannot be a folder.*--store"):
        Store(tmp_path)
