"""A full disk and a folder that cannot be written: one message, exit status 2, nothing torn."""

from __future__ import annotations

import os
import resource
import shlex
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment, run, small_study_text

CURVE = "deflection_m,load_N\n0,0\n0.01,80\n0.02,165\n"


@pytest.fixture
def curve(tmp_path: Path) -> Path:
    (tmp_path / "c.csv").write_text(CURVE, encoding="utf-8")
    return tmp_path / "c.csv"


def _refused(ended: subprocess.CompletedProcess[str], *texts: str) -> None:
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stdout + ended.stderr
    assert ended.stderr.startswith("workbench: error: ")
    for text in texts:
        assert text in ended.stderr


def _on(options: str, folder: Path, arguments: list[str], before: str = "") -> subprocess.CompletedProcess[str]:
    """Run a command with a file system of its own at ``folder``, which no other process sees."""
    folder.mkdir()
    script = (
        f'set -e; mount -t tmpfs -o size=200k none "$1"; {before} mount -o remount,{options} "$1"; shift; exec "$@"'
    )
    if os.geteuid() != 0 or subprocess.run(["unshare", "-m", "true"], check=False, capture_output=True).returncode:
        if os.environ.get("CI") == "true":
            pytest.fail("mounting needs root and mount namespaces")
        pytest.skip("mounting a small file system needs root and mount namespaces")
    whole = ["unshare", "-m", "bash", "-c", script, "bash", str(folder), *arguments]
    return subprocess.run(whole, env=environment(), capture_output=True, text=True, check=False)


def test_a_full_disk_under_the_output(curve: Path, tmp_path: Path) -> None:
    """The page is too long for what a file may have here: the first that does not fit ends it, and none is left."""
    out = tmp_path / "out"
    arguments = command("compare", curve, curve, "--out", out)

    def small_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))

    ended = subprocess.run(
        arguments, env=environment(), capture_output=True, text=True, check=False, preexec_fn=small_files
    )
    _refused(ended, "File too large")
    assert list(out.iterdir()) == []


def test_a_full_disk_under_the_store(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    study.write_text(small_study_text(), encoding="utf-8")
    store = tmp_path / "store"
    arguments = command("stiffness", study, "--model", "brush", "--out", tmp_path / "o", "--store", store)
    fill = 'touch "$1/.workbench-store"; head -c 300000 /dev/zero > "$1/filler" 2>/dev/null || true;'
    _refused(_on("rw", store, arguments, before=fill), "No space left on device")
    assert not (tmp_path / "o").exists()


@pytest.mark.parametrize("place", ["--out", "--store"])
def test_a_folder_that_cannot_be_written(tmp_path: Path, place: str) -> None:
    study = tmp_path / "study.toml"
    study.write_text(small_study_text(), encoding="utf-8")
    folders = {"--out": tmp_path / "o", "--store": tmp_path / "s"}
    options = [part for name, folder in folders.items() for part in (name, str(folder))]
    ended = _on("ro", folders[place], command("stiffness", study, "--model", "brush", *options))
    _refused(ended, str(folders[place]))
    assert ended.stdout == ""


def test_standard_output_on_a_full_disk_and_a_reader_that_leaves(curve: Path) -> None:
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(
            command("compare", curve, curve), env=environment(), stdout=full, stderr=subprocess.PIPE, text=True,
            check=False,
        )  # fmt: skip
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stderr
    assert "No space left on device" in ended.stderr


def test_paths_with_blanks_and_letters_of_other_alphabets(tmp_path: Path) -> None:
    folder = tmp_path / "mes courbes – 曲线"
    folder.mkdir()
    (folder / "é 1.csv").write_text(CURVE, encoding="utf-8")
    ended = run("compare", "é 1.csv", "é 1.csv", "--out", "sortie 1", folder=folder)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert (folder / "sortie 1" / "compare.html").exists()


def _small_disk(folder: Path, size: str, arguments: list[str], **more: str) -> subprocess.CompletedProcess[str]:
    """Run a command with a small file system of its own at a folder."""
    if os.geteuid() != 0 or subprocess.run(["unshare", "-m", "true"], check=False, capture_output=True).returncode:
        if os.environ.get("CI") == "true":
            pytest.fail("mounting needs root and mount namespaces")
        pytest.skip("mounting a small file system needs root and mount namespaces")
    folder.mkdir(exist_ok=True)
    script = 'set -e; mount -t tmpfs -o size="$2" none "$1"; shift 2; exec "$@"'
    whole = ["unshare", "-m", "bash", "-c", script, "bash", str(folder), size, *arguments]
    return subprocess.run(whole, env=environment() | more, capture_output=True, text=True, check=False)


@pytest.mark.long
def test_each_full_disk_is_named(tmp_path: Path) -> None:
    """The store's, while a worker writes its result or the log; the output's; never said to be a want of memory."""
    study = ROOT / "studies" / "first.toml"
    small, roomy = tmp_path / "small", tmp_path / "roomy"
    on_store = command("mesh", study, "--out", roomy / "out", "--store", small / "store")
    ended = _small_disk(small, "100k", on_store)
    _refused(ended, f"the disk mounted at {small}, which holds the result store {small / 'store'}", "of 102 kB free")
    assert "memory" not in ended.stderr
    assert "its output is in" not in ended.stderr
    on_out = command("mesh", study, "--out", small / "out", "--store", roomy / "store")
    ended = _small_disk(small, "100k", on_out)
    _refused(ended, f"the disk mounted at {small}, which holds the output folder {small / 'out'}", "--out")
    again = run(*on_out[3:])
    assert (again.returncode, again.stderr) == (0, "")
    assert "0 tasks computed" in again.stdout  # everything was kept


@pytest.mark.long
def test_full_temporary_files_and_caches(tmp_path: Path) -> None:
    """A C compiler that can write neither its temporary files nor what it makes: the disk is named, or not needed."""
    study = tmp_path / "study.toml"
    study.write_text(small_study_text(), encoding="utf-8")
    small = tmp_path / "small"
    for name, told in (("TMPDIR", "temporary files"), ("XDG_CACHE_HOME", "cache")):
        cache = {"XDG_CACHE_HOME": str(tmp_path / f"cache of {name}")} | {name: str(small)}
        places = ("--out", tmp_path / "out", "--store", tmp_path / f"store of {name}")
        ended = _small_disk(small, "4k", command("stiffness", study, *places), **cache)
        _refused(ended, f"which holds the {told} {small}", f"set {name} to another folder")
        assert len(list((tmp_path / f"store of {name}").glob("??/*"))) == 1  # the mesh


def test_a_new_study_is_whole_or_not_there(tmp_path: Path) -> None:
    """On a full disk, and where files may not be long: the message fits the command, and nothing bars another try."""
    small = tmp_path / "small"
    new = command("new", small / "s.toml", "--from", "exomars")
    ended = _small_disk(small, "4k", ["sh", "-c", '"$@"; status=$?; ls -A "$0"; exit $status', str(small), *new])
    _refused(ended, f"No space left on device: the disk mounted at {small}, which holds the study file")
    assert ended.stdout == ""
    limit = f"ulimit -f 1; exec {shlex.join(new)}"
    too_long = subprocess.run(["bash", "-c", limit], env=environment(), capture_output=True, text=True, check=False)
    _refused(too_long, f"File too large: {small / 's.toml'}: a file may not be longer than 1 kB (ulimit -f)")
    for words in ("--out", "finished results", "/dev/shm"):
        assert words not in ended.stderr + too_long.stderr
    assert list(small.iterdir()) == []


@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_standard_output_is_named(unbuffered: str) -> None:
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(
            command("rover", "--list"), env=environment() | {"PYTHONUNBUFFERED": unbuffered}, stdout=full,
            stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
    expected = "workbench: error: standard output: No space left on device; check path and space\n"
    assert (ended.returncode, ended.stderr) == (2, expected)


@pytest.mark.parametrize("arguments", [("new", "s.toml"), ("results",), ("rover", "static")])
def test_a_working_folder_that_was_removed(arguments: tuple[str, ...], tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    line = f"rmdir {shlex.quote(str(gone))}; exec {shlex.join(command(*arguments))}"
    ended = subprocess.run(
        ["bash", "-c", line], cwd=gone, env=environment(), capture_output=True, text=True, check=False
    )
    _refused(ended, "the working folder is gone")
