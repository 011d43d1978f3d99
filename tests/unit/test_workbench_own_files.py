"""A user's folder: only files that a manifest lists and that are still ours go; all else is kept, and told of."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from contracts.errors import InputError
from contracts.machine import machine
from tests.unit.dying_process import publish
from workbench.execution.fingerprint import text_sha256
from workbench.execution.integrity import sealed
from workbench.report.own_files import FILES, read_own
from workbench.report.placing import copy_files, new_files, put_files

LIKE_OURS = (
    "curves/fe_abaqus_2024.csv",
    "curves/ancf_mine.csv",
    "fields/fe_paraview_state.vtu",
    "series/my_brush.csv",
    "motions/own_ancf.npz",
)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _texts(out: Path) -> dict[str, str]:
    """Every file but the manifest."""
    found = sorted(p for p in out.rglob("*") if p.is_file() and p.name != FILES)
    return {p.relative_to(out).as_posix(): p.read_text(encoding="utf-8") for p in found}


@pytest.mark.parametrize("name", LIKE_OURS)
def test_a_user_s_file_with_a_name_like_ours_stays(tmp_path: Path, name: str) -> None:
    folder = name.partition("/")[0]
    publish(tmp_path, {f"{folder}/one": "1", "page": "1"})
    _write(tmp_path / name, "mine")
    assert publish(tmp_path, {f"{folder}/two": "2", "page": "2"}) == []
    assert _texts(tmp_path) == {name: "mine", f"{folder}/two": "2", "page": "2"}


def test_what_was_edited_since_is_renamed_and_told(tmp_path: Path) -> None:
    """One that a new file replaces, one that is no longer part of the results; again; a name that is taken is left."""
    publish(tmp_path, {"c/a.csv": "1", "c/b.csv": "1", "page": "1"})
    for name in "ab":
        _write(tmp_path / "c" / f"{name}.csv", f"edited {name}")
    _write(tmp_path / "c" / "b.edited-1.csv", "taken")
    told = publish(tmp_path, {"c/a.csv": "2", "page": "2"})
    assert sorted(told) == [
        f"{tmp_path}/c/a.csv had been edited; kept as a.edited-1.csv",
        f"{tmp_path}/c/b.csv had been edited; kept as b.edited-2.csv",
    ]
    kept = {"c/a.edited-1.csv": "edited a", "c/b.edited-1.csv": "taken", "c/b.edited-2.csv": "edited b"}
    assert _texts(tmp_path) == {"c/a.csv": "2", "page": "2"} | kept
    _write(tmp_path / "c" / "a.csv", "again")
    assert publish(tmp_path, {"c/a.csv": "2", "page": "2"})[0].endswith("kept as a.edited-2.csv")
    assert _texts(tmp_path) == {"c/a.csv": "2", "page": "2", "c/a.edited-2.csv": "again"} | kept


def test_a_foreign_file_in_the_way_is_moved_unless_it_is_the_same(tmp_path: Path) -> None:
    _write(tmp_path / "kept-1", "a file")
    publish(tmp_path, {"page": "1"})
    _write(tmp_path / "c" / "a.csv", "mine")
    _write(tmp_path / "c" / "b.csv", "2")
    (told,) = publish(tmp_path, {"c/a.csv": "2", "c/b.csv": "2", "page": "2"})
    assert told.endswith(f"kept in {tmp_path}/kept-2: c/a.csv")
    assert _texts(tmp_path) == {
        "kept-1": "a file",
        "kept-2/c/a.csv": "mine",
        **dict.fromkeys(("c/a.csv", "c/b.csv", "page"), "2"),
    }


def test_a_folder_of_an_earlier_version_loses_nothing(tmp_path: Path) -> None:
    """Without a manifest nothing is ours: what would be overwritten goes to one folder, told in one sentence."""
    names = [f"c/{i}.csv" for i in range(9)]
    for name in (*names, "c/old.csv"):
        _write(tmp_path / name, f"earlier {name}")
    (told,) = publish(tmp_path, dict.fromkeys(names, "new"))
    assert told.endswith(f"kept in {tmp_path}/kept-1: c/0.csv, c/1.csv, c/2.csv, c/3.csv, c/4.csv and 4 more")
    found = _texts(tmp_path)
    assert {found[f"kept-1/{name}"] for name in names} == {f"earlier {name}" for name in names}
    assert found["c/old.csv"] == "earlier c/old.csv"
    assert publish(tmp_path, dict.fromkeys(names, "newer")) == []


def test_every_damaged_bit_of_the_manifest_is_noticed(tmp_path: Path) -> None:
    publish(tmp_path, {"c/a.csv": "1", "page": "1"})
    whole = (tmp_path / FILES).read_bytes()
    for i in range(8 * len(whole)):
        damaged = bytearray(whole)
        damaged[i // 8] ^= 1 << (i % 8)
        (tmp_path / FILES).write_bytes(damaged)
        assert read_own(tmp_path) is None, f"bit {i}"
    for cut in range(len(whole)):
        (tmp_path / FILES).write_bytes(whole[:cut])
        assert read_own(tmp_path) is None
    (tmp_path / FILES).write_bytes(whole)
    assert read_own(tmp_path) is not None


def test_with_a_damaged_manifest_nothing_is_removed_and_it_is_said(tmp_path: Path) -> None:
    publish(tmp_path, {"c/a.csv": "1", "page": "1"})
    _write(tmp_path / FILES, "{}")
    told = publish(tmp_path, {"c/b.csv": "2", "page": "2"})
    assert told[0] == f"{tmp_path}/{FILES} is damaged, so nothing was removed from {tmp_path}"
    assert _texts(tmp_path) == {"c/a.csv": "1", "c/b.csv": "2", "page": "2", "kept-1/page": "1"}
    assert (tmp_path / "kept-1" / FILES).read_text(encoding="utf-8") == "{}"


@pytest.mark.parametrize("name", ["../outside.csv", "/etc/hostname", "c/../../outside.csv", ""])
def test_a_manifest_that_reaches_out_of_the_folder_is_none(tmp_path: Path, name: str) -> None:
    files = {name: {"sha256": [text_sha256("mine")], "by": "test"}}
    _write(tmp_path / "out" / FILES, sealed({"schema": 1, "files": files}))
    _write(tmp_path / "outside.csv", "mine")
    publish(tmp_path / "out", {"page": "1"})
    assert (tmp_path / "outside.csv").read_text(encoding="utf-8") == "mine"


def test_links_and_pipes_in_the_way_are_moved_not_followed(tmp_path: Path) -> None:
    _write(tmp_path / "elsewhere.csv", "mine")
    out = tmp_path / "out"
    publish(out, {"a": "1", "b": "1", "page": "1"})
    for name in "ab":
        (out / name).unlink()
    (out / "a").symlink_to(tmp_path / "elsewhere.csv")
    os.mkfifo(out / "b")
    told = publish(out, {"a": "2", "b": "2", "page": "2"})
    assert len(told) == 2
    assert (out / "a.edited-1").is_symlink()
    assert (out / "b.edited-1").is_fifo()
    assert (tmp_path / "elsewhere.csv").read_text(encoding="utf-8") == "mine"
    assert (out / "a").read_text(encoding="utf-8") == (out / "b").read_text(encoding="utf-8") == "2"


def test_what_another_command_wrote_stays(tmp_path: Path) -> None:
    publish(tmp_path, {"c/report.csv": "1"})
    put_files(tmp_path, {"c/other.csv": b"1"}, "other")
    publish(tmp_path, {"c/next.csv": "2"})
    assert sorted(_texts(tmp_path)) == ["c/next.csv", "c/other.csv"]
    copy_files(tmp_path / "c", ["next.csv"], tmp_path, "third")
    assert sorted(_texts(tmp_path)) == ["c/next.csv", "c/other.csv", "next.csv"]


def test_what_a_killed_run_left_goes_and_what_only_looks_like_it_stays(tmp_path: Path) -> None:
    publish(tmp_path, {"page": "1"})
    host = machine()
    for name in (".new-1", f".workbench-new-{host}-99999999-0123abcd", ".workbench-new-mine"):
        _write(tmp_path / name / "notes.txt", "mine")
    planned = tmp_path / f".workbench-new-{host}-99999998-0123abcd"
    _write(planned / ".workbench-plan.json", sealed({"names": ["c/a.csv", "../page"]}))
    _write(planned / "c" / "a.csv", "half")
    empty = tmp_path / f".workbench-new-{host}-99999997-0123abcd"
    empty.mkdir()
    publish(tmp_path, {"page": "2"})
    assert len([text for text in _texts(tmp_path).values() if text == "mine"]) == 3
    assert not planned.exists()
    assert not empty.exists()
    assert (tmp_path / "page").read_text(encoding="utf-8") == "2"


def test_an_error_while_filling_leaves_all_as_it_was(tmp_path: Path) -> None:
    publish(tmp_path, {"c/a.csv": "1", "page": "1"})
    before = sorted(p.name for p in tmp_path.rglob("*"))
    with pytest.raises(FileNotFoundError), new_files(tmp_path, "test", ["c/a.csv", "page"], whole_set=True) as new:
        (new.folder / "c" / "a.csv").write_text("2", encoding="utf-8")  # and no page
    assert sorted(p.name for p in tmp_path.rglob("*")) == before
    assert _texts(tmp_path) == {"c/a.csv": "1", "page": "1"}


def test_a_run_killed_at_any_file_operation_loses_nothing(tmp_path: Path) -> None:
    """In each state that a kill can leave both texts of the user's are there, and the next run puts all in order."""
    process = [sys.executable, "-m", "tests.unit.dying_process", str(tmp_path), "publish"]
    ended = subprocess.run(process, capture_output=True, text=True, check=True)
    cases = int(ended.stdout)
    assert cases > 30
    for number in range(1, cases + 1):
        out = tmp_path / str(number)
        for _ in range(2):
            texts = list(_texts(out).values())
            assert "user's" in texts, f"killed at operation {number}"
            assert "also user's" in texts, f"killed at operation {number}"
            publish(out, {"c/edited.csv": "2", "c/new.csv": "2", "page.html": "2"})
        found = _texts(out)
        assert {found[name] for name in ("c/edited.csv", "c/new.csv", "page.html")} == {"2"}
        assert "c/stale.csv" not in found
        assert [p.name for p in out.iterdir() if p.name.startswith(".workbench-new")] == []


def _publish_often(out: Path, text: str) -> None:
    for _ in range(20):
        publish(out, {f"c/{text}.csv": text, "page": text})


def test_two_runs_at_once_leave_one_whole_set(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=_publish_often, args=(tmp_path, text)) for text in "xy"]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
    assert [process.exitcode for process in processes] == [0, 0]
    last = (tmp_path / "page").read_text(encoding="utf-8")
    assert _texts(tmp_path) == {f"c/{last}.csv": last, "page": last}


def test_a_folder_on_another_disk_is_refused_before_anything_moves(tmp_path: Path) -> None:
    memory = Path("/dev/shm")
    if not memory.is_dir() or memory.stat().st_dev == tmp_path.stat().st_dev:
        pytest.skip("needs two file systems")
    put_files(tmp_path, {"a.csv": b"first"}, "report")
    with tempfile.TemporaryDirectory(dir=memory) as other:
        (tmp_path / "curves").symlink_to(other)
        with pytest.raises(InputError, match=r"curves: lies on another disk than .*choose another folder"):
            put_files(tmp_path, {"a.csv": b"second", "curves/b.csv": b"b"}, "report")
    assert (tmp_path / "a.csv").read_bytes() == b"first"
    assert list(tmp_path.glob(".workbench-new-*")) == []
