"""A store is a folder of its own: others are refused untouched, foreign files in one stay, clocks may be wrong."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from contracts.errors import InputError
from contracts.machine import machine
from workbench.execution.fingerprint import text_sha256
from workbench.execution.integrity import MANIFEST
from workbench.execution.inventory import leftovers, results
from workbench.execution.live_runs import announce
from workbench.execution.pruning import Rule, prune
from workbench.execution.store import Store, discard
from workbench.execution.store_folder import MARKER, holds_a_store, make_store

KEY = text_sha256("a task")
DAY = 86400.0
FOREIGN = (
    "checkpoints/model.pt",
    f"checkpoints/{KEY}.pt",
    f"checkpoints/x{KEY}.npz",
    f"checkpoints/{KEY}.npz.bak",
    "checkpoints/old/model.npz",
    "tmp/mine/notes.txt",
    "tmp/host-1-zzzzzzzz/notes.txt",
    "tmp/notes-1-01234567",
    "log/server.log",
    "log/run-1.log/notes.txt",
    "runs/settings.json",
    "runs/host-1.json",
    "claims/notes.txt",
    "ab/notes.txt",
    f"ab/{KEY}/notes.txt",
    "notes.txt",
    "kept/notes.txt",
)


def _filled(root: Path) -> Store:
    store = Store(root)
    folder = store.scratch()
    (folder / "a.txt").write_text("result", encoding="utf-8")
    store.put(KEY, folder, {"task": "t", "wall_s": 1.0})
    return store


def _write(path: Path, text: str = "mine", days: float = 60.0) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    for one in (path, path.parent):
        os.utime(one, (time.time() - days * DAY,) * 2)


def _texts(root: Path) -> dict[str, str]:
    return {p.relative_to(root).as_posix(): p.read_text(encoding="utf-8") for p in root.rglob("*") if p.is_file()}


@pytest.mark.parametrize(
    "name", ["checkpoints/model.pt", "notes.txt", "tmp/a", "ab/notes.txt", ".hidden", "log/server.log", "src/main.c"]
)
def test_a_folder_of_something_else_is_refused_untouched(tmp_path: Path, name: str) -> None:
    for empty in ("tmp", "log", "checkpoints"):
        (tmp_path / empty).mkdir()
    _write(tmp_path / name)
    before = sorted(tmp_path.rglob("*"))
    assert not holds_a_store(tmp_path)
    with pytest.raises(InputError, match=rf"is not empty, and {name.partition('/')[0]} in it is not of a store; give"):
        Store(tmp_path)
    assert sorted(tmp_path.rglob("*")) == before


def test_new_empty_and_half_made_folders_become_stores(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "half" / "tmp").mkdir(parents=True)
    (tmp_path / "marked").mkdir()
    (tmp_path / "marked" / MARKER).touch()
    for name in ("new/deep", "empty", "half", "marked"):
        assert Store(tmp_path / name).writable
        assert (tmp_path / name / MARKER).is_file()
    assert not holds_a_store(tmp_path / "nowhere")


@pytest.mark.parametrize("foreign", [(), ("notes.txt", "checkpoints/model.pt")])
def test_a_store_of_an_earlier_version_is_recognised_and_marked(tmp_path: Path, foreign: tuple[str, ...]) -> None:
    store = _filled(tmp_path)
    announce(tmp_path, [KEY])
    (tmp_path / "claims").mkdir()
    (tmp_path / "claims" / KEY).touch()
    (tmp_path / "log" / "run-12.log").touch()
    (tmp_path / MARKER).unlink()
    for name in foreign:
        _write(tmp_path / name)
    assert holds_a_store(tmp_path)
    assert Store(tmp_path).get(KEY) is not None
    assert (tmp_path / MARKER).is_file()
    assert all((tmp_path / name).is_file() for name in foreign)
    assert store.fault(KEY) == ""


def test_foreign_files_in_a_store_stay(tmp_path: Path) -> None:
    """Sixty days old, in every folder: a run leaves them, and so does pruning everything; the store goes on working."""
    store = _filled(tmp_path)
    for name in FOREIGN:
        path = name.replace("ab/", f"{KEY[:2]}/")
        _write(tmp_path / path)
    store.sweep()
    store._forget(KEY)
    found = prune(store, Rule(larger_than=0.0), dry_run=True)
    assert [one.name for one in found.removed] == [KEY]
    prune(store, Rule(larger_than=0.0))
    texts = _texts(tmp_path)
    moved = f"{KEY[:2]}/{KEY}/notes.txt"
    for name in FOREIGN:
        path = name.replace("ab/", f"{KEY[:2]}/")
        assert path == moved or texts[path] == "mine", path
    (kept,) = [name for name in texts if name.startswith(f"kept/{KEY}")]
    assert texts[kept] == "mine"
    assert results(store) == []
    assert leftovers(store) == []
    _filled(tmp_path)
    assert store.get(KEY) is not None


def test_what_others_put_into_a_damaged_result_is_kept(tmp_path: Path) -> None:
    store = _filled(tmp_path)
    _write(store.folder(KEY) / "notes.txt")
    _write(store.folder(KEY) / "a.txt", "damaged")
    _filled(tmp_path)
    assert store.fault(KEY) == ""
    assert [text for name, text in _texts(tmp_path).items() if name.startswith("kept/")] == ["mine"]


@pytest.mark.parametrize("days", [-4000.0, -1.0, 0.0, 400.0, 20000.0])
def test_a_clock_that_was_changed_removes_nothing(tmp_path: Path, days: float) -> None:
    """Files from the future, or older than they can be: a run removes none of them, ages stay ages."""
    store = _filled(tmp_path)
    checkpoint, half = store.checkpoint("0" * 64), tmp_path / "checkpoints" / f".{'0' * 64}-host-1.npz"
    for path in (checkpoint, half):
        _write(path, "half", days)
    for path in (store.folder(KEY) / "a.txt", store.folder(KEY) / "manifest.json", store.folder(KEY)):
        os.utime(path, (time.time() - days * DAY,) * 2)
    again = Store(tmp_path)
    again.sweep()
    assert checkpoint.exists()
    assert half.exists()
    assert again.get(KEY) is not None
    if days < 0.0:
        prune(again, Rule(older_than=0.0, task="nothing"))
        prune(again, Rule(older_than=DAY))
        assert checkpoint.exists()
        assert again.get(KEY) is not None


def test_a_result_stored_by_a_clock_ahead_is_used_and_listed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ahead = time.time() + 5000 * DAY
    with monkeypatch.context() as patch:
        patch.setattr(time, "time", lambda: ahead)
        store = _filled(tmp_path)
    assert store.get(KEY) is not None
    (kept,) = results(store, check=True)
    assert kept.fault == ""
    assert kept.stored_at == ahead
    assert prune(store, Rule(older_than=0.0)).removed == ()


def test_a_killed_run_s_scratch_goes_whatever_the_clock_says(tmp_path: Path) -> None:
    store = _filled(tmp_path)
    dead = tmp_path / "tmp" / f"{machine()}-99999999-0123abcd"
    _write(dead / "half.txt", days=-4000.0)
    store.sweep()
    assert not dead.exists()


def test_names_alone_make_no_store(tmp_path: Path) -> None:
    """Other programs keep files under 64 hexadecimal digits, logs and temporary folders too."""
    blob = tmp_path / "registry" / KEY[:2] / KEY / "data"
    log = tmp_path / "project" / "log" / "run-999999.log"
    for path in (blob, log):
        path.parent.mkdir(parents=True)
        path.write_text("theirs", encoding="utf-8")
    (tmp_path / "project" / "tmp").mkdir()
    for root in (tmp_path / "registry", tmp_path / "project"):
        assert not holds_a_store(root)
        with pytest.raises(InputError, match="is no store of results"):
            make_store(root)
    assert blob.read_text(encoding="utf-8") == log.read_text(encoding="utf-8") == "theirs"


@pytest.mark.parametrize("damage", ["missing", "changed"])
def test_without_a_manifest_to_trust_what_may_be_another_s_is_kept(tmp_path: Path, damage: str) -> None:
    store = Store(tmp_path / "store")
    folder = store.scratch()
    (folder / "a.txt").write_text("ours", encoding="utf-8")
    entry = store.put(KEY, folder, {"task": "t", "wall_s": 1.0, "dofs": 1})
    (entry.path / "notes.txt").write_text("mine", encoding="utf-8")
    manifest = entry.path / "manifest.json"
    manifest.write_text(manifest.read_text(encoding="utf-8").replace("1.0", "1.1"), encoding="utf-8")
    if damage == "missing":
        manifest.unlink()
    discard(store.root, entry.path)
    assert [path.read_text(encoding="utf-8") for path in (tmp_path / "store" / "kept").rglob("notes.txt")] == ["mine"]


@pytest.mark.parametrize("kind", ["file", "link to nothing", "link to a folder"])
def test_what_stands_in_the_place_of_a_result_is_told_of_and_kept(tmp_path: Path, kind: str) -> None:
    store = _filled(tmp_path / "store")
    place = store.folder(KEY)
    shutil.rmtree(place)
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "notes.txt").write_text("mine", encoding="utf-8")
    if kind == "file":
        place.write_text("mine", encoding="utf-8")
    else:
        place.symlink_to(tmp_path / ("theirs" if kind == "link to a folder" else "nowhere"))
    fault = store.fault(KEY)
    assert fault == f"in the place of its folder lies something else, which moves to {store.root / 'kept'}"
    _filled(store.root)
    assert store.fault(KEY) == ""
    assert store.get(KEY) is not None
    (kept,) = (store.root / "kept").iterdir()
    assert kept.is_symlink() or kept.read_text(encoding="utf-8") == "mine"
    assert list((store.root / "tmp").iterdir()) == []
    assert (tmp_path / "theirs" / "notes.txt").read_text(encoding="utf-8") == "mine"


def test_an_entry_without_rights_is_a_fault_and_is_replaced(tmp_path: Path) -> None:
    """For a user without override rights; root's are taken off by a process of its own."""
    drop = ["setpriv", "--bounding-set", "-dac_override,-dac_read_search"] if os.geteuid() == 0 else []
    if drop and subprocess.run([*drop, "true"], check=False, capture_output=True).returncode:
        pytest.skip("root's rights cannot be taken off here")
    store = _filled(tmp_path)
    (store.folder(KEY) / "notes.txt").write_text("mine", encoding="utf-8")
    store.folder(KEY).chmod(0)
    code = (
        "import sys; from pathlib import Path; from tests.unit.test_workbench_store_folder import KEY, Store, _filled;"
        "store = Store(Path(sys.argv[1])); print(store.get(KEY), store.fault(KEY), sep='; ');"
        "_filled(store.root); print(store.fault(KEY))"
    )
    ended = subprocess.run([*drop, sys.executable, "-c", code, tmp_path], capture_output=True, text=True, check=False)
    assert ended.stderr == ""
    assert ended.stdout == f"None; {MANIFEST} cannot be read (Permission denied)\n\n"
    assert store.get(KEY) is not None
    (kept,) = (tmp_path / "kept").rglob("notes.txt")
    assert kept.read_text(encoding="utf-8") == "mine"
