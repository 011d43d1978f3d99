"""Nothing of the user's is lost, as a user sees it.

Their files in ``--out`` and under ``--store``, a store that is damaged, one that cannot be written, two runs at once.
"""

from __future__ import annotations

import json
import os
import subprocess
import time
from pathlib import Path

import pytest

from tests.end_to_end.small_study import command, environment, run, small_study_text

OLD = 60 * 86400.0
BRUSH = ("stiffness", "study.toml", "--model", "brush", "--out", "out", "--store", "store")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a study."""
    (tmp_path / "study.toml").write_text(small_study_text(), encoding="utf-8")
    return tmp_path


def _write(path: Path, text: str = "mine") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    os.utime(path, (time.time() - OLD,) * 2)
    return path


def _refused(ended: subprocess.CompletedProcess[str], *texts: str) -> None:
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stdout + ended.stderr
    for text in texts:
        assert text in ended.stderr


def test_files_of_the_user_s_in_the_output_folder_stay(folder: Path) -> None:
    assert run(*BRUSH, folder=folder).returncode == 0
    mine = [_write(folder / "out" / "curves" / f"{name}.csv") for name in ("fe_abaqus_2024", "ancf_mine", "brush_x")]
    average = folder / "out" / "curves" / "brush_average.csv"
    ours = average.read_text(encoding="utf-8")
    again = run(*BRUSH, folder=folder)
    assert (again.returncode, again.stderr, "kept" in again.stdout) == (0, "", False)
    average.write_text("edited", encoding="utf-8")
    edited = run(*BRUSH, folder=folder)
    assert "out/curves/brush_average.csv had been edited; kept as brush_average.edited-1.csv" in edited.stdout
    assert [path.read_text(encoding="utf-8") for path in mine] == ["mine"] * 3
    assert average.with_name("brush_average.edited-1.csv").read_text(encoding="utf-8") == "edited"
    assert average.read_text(encoding="utf-8") == ours


def test_a_file_of_the_user_s_in_our_file_s_place_is_kept(folder: Path) -> None:
    _write(folder / "out" / "curves" / "brush_average.csv")
    ended = run(*BRUSH, folder=folder)
    assert ended.returncode == 0
    assert "kept in out/kept-1: curves/brush_average.csv" in ended.stdout
    assert (folder / "out" / "kept-1" / "curves" / "brush_average.csv").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("name", ["checkpoints/model.pt", "main.c"])
def test_a_folder_of_something_else_is_no_store(folder: Path, name: str) -> None:
    mine = _write(folder / "store" / name)
    _refused(run(*BRUSH, folder=folder), "result store = store: is no store of results", name.partition("/")[0])
    _refused(run("results", "--store", "store", folder=folder), "result store = store: is no store of results")
    assert mine.read_text(encoding="utf-8") == "mine"
    found = sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())
    assert found == [mine.relative_to(folder).as_posix(), "study.toml"]


@pytest.mark.parametrize(("name", "value"), [("wall_s", None), ("files", [1])])
def test_a_damaged_manifest_is_told_and_the_result_computed_again(folder: Path, name: str, value: object) -> None:
    """A value of another kind, a key that is gone: commands that look go on, the next run computes."""
    assert run(*BRUSH, folder=folder).returncode == 0
    (manifest,) = (folder / "store").glob("??/*/manifest.json")
    content = json.loads(manifest.read_text(encoding="utf-8"))
    del content[name]
    manifest.write_text(json.dumps(content | ({} if value is None else {name: value})), encoding="utf-8")
    for looking in (
        ("results",),
        ("results", "show", manifest.parent.name),
        ("results", "prune", "--older-than", "1 d"),
    ):
        ended = run(*looking, "--store", "store", folder=folder)
        assert (ended.returncode, ended.stderr) == (0, ""), looking
    assert run("results", "--check", "--store", "store", folder=folder).returncode == 1
    again = run(*BRUSH, folder=folder)
    assert again.returncode == 0
    assert "brush: its stored result is damaged (manifest.json " in again.stdout
    assert run("results", "--check", "--store", "store", folder=folder).returncode == 0


def _read_only(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder whose ``store`` cannot be written, root or not: a mount no other process sees."""
    if os.geteuid() != 0 or subprocess.run(["unshare", "-m", "true"], check=False, capture_output=True).returncode:
        if os.environ.get("CI") == "true":
            pytest.fail("mounting needs root and mount namespaces")
        pytest.skip("mounting a folder read-only needs root and mount namespaces")
    script = 'set -e; mount --bind store store; mount -o remount,bind,ro store; exec "$@"'
    whole = ["unshare", "-m", "bash", "-c", script, "bash", *command(*arguments)]
    return subprocess.run(whole, cwd=folder, env=environment(), capture_output=True, text=True, check=False)


@pytest.mark.long
def test_a_store_that_cannot_be_written_is_read(folder: Path) -> None:
    """What is in it is used; what is not, is asked for with another store; nothing can be removed from it."""
    assert run(*BRUSH, folder=folder).returncode == 0
    for marker in (True, False):
        if not marker:
            (folder / "store" / ".workbench-store").unlink()  # as an earlier version left it
        used = _read_only(folder, *BRUSH)
        assert (used.returncode, used.stderr) == (0, "")
        assert "0 tasks computed, 1 reused" in used.stdout
        assert "1 result" in _read_only(folder, "results", "--check", "--store", "store").stdout
        dry = _read_only(folder, "results", "prune", "--larger-than", "0 B", "--dry-run", "--store", "store")
        assert (dry.returncode, "would remove brush" in dry.stdout) == (0, True)
        _refused(_read_only(folder, "results", "prune", "--task", "*", "--store", "store"), "store: cannot be written")
    ancf = [word if word != "brush" else "ancf" for word in BRUSH]
    _refused(_read_only(folder, *ancf), "store: cannot be written, and", "results are not in it; choose another")


@pytest.mark.long
def test_two_whole_reports_at_once_on_one_store_and_one_folder(
    workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    """Started together from nothing: both succeed, each result is computed once, the folder holds one whole report."""
    assert first_report.returncode == 0
    arguments = command("report", workspace / "study.toml", "--out", "out", "--store", "store", "--workers", "1")
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    runs = [subprocess.Popen(arguments, cwd=tmp_path, env=environment(), text=True, **pipes) for _ in range(2)]
    said = [process.communicate() for process in runs]
    assert [process.returncode for process in runs] == [0, 0], said
    assert [error for _, error in said] == ["", ""]
    computed = [line.split()[1] for text, _ in said for line in text.splitlines() if ": computed in" in line]
    assert len(computed) == len(set(computed))
    assert len(computed) == first_report.stdout.count(": computed in")
    for path in (workspace / "report" / "curves").iterdir():
        assert (tmp_path / "out" / "curves" / path.name).read_bytes() == path.read_bytes(), path.name
    assert json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["status"] == "pass"
    assert run("results", "--check", "--store", "store", folder=tmp_path).returncode == 0
    assert list((tmp_path / "store" / "tmp").iterdir()) == []
    assert not [path for path in (tmp_path / "out").iterdir() if path.name.startswith((".workbench-new", "kept"))]
