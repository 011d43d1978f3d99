"""Standard streams that are closed or full: the exit status still tells, and nothing ends in a traceback."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.end_to_end.small_study import command, environment, small_study_text
from workbench.execution.worker import _redirect_output


@pytest.mark.parametrize(
    ("arguments", "streams", "status"),
    [
        (("--help",), ">&-", 0),
        (("compare", "a.csv", "b.csv"), "2>&-", 2),
        (("compare", "a.csv", "b.csv"), "2>/dev/full", 2),
    ],
)
def test_closed_or_full(arguments: tuple[str, ...], streams: str, status: int, tmp_path: Path) -> None:
    line = f"{shlex.join(map(str, command(*arguments)))} {streams}"
    ended = subprocess.run(["/bin/sh", "-c", line], cwd=tmp_path, env=environment(), capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (status, "")


CLOSED = [" ".join(some) for n in (1, 2, 3) for some in itertools.combinations(("<&-", ">&-", "2>&-"), n)]
SHORT = ("2>&-", "<&- >&- 2>&-")
"""Those of every run; the long one has them all."""


@pytest.mark.parametrize("streams", [pytest.param(s, marks=() if s in SHORT else pytest.mark.long) for s in CLOSED])
def test_a_command_that_computes(streams: str, tmp_path: Path) -> None:
    """Workers start, and no file that is opened later takes the place of a stream: what is written holds no message."""
    (tmp_path / "s.toml").write_text(small_study_text(), encoding="utf-8")
    arguments = command("stiffness", "s.toml", "--model", "brush", "--out", "out", "--store", "store")
    line = f"{shlex.join(arguments)} {streams}"
    ended = subprocess.run(["/bin/sh", "-c", line], cwd=tmp_path, env=environment(), capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ("tasks computed" in ended.stdout) == (">&-" not in streams.replace("2>&-", ""))
    (curve,) = (tmp_path / "out" / "curves").glob("*.csv")
    assert "computed" not in curve.read_text(encoding="utf-8")


def _worker_without_streams(log: Path) -> None:
    for number in (0, 1, 2):
        os.close(number)
    sys.stdin = sys.stdout = sys.stderr = None  # type: ignore[assignment]
    _redirect_output(log)
    print("printed")
    os.write(2, b"written\n")


def test_a_worker_that_has_no_streams(tmp_path: Path) -> None:
    """However it was started: what it prints is in its log."""
    process = multiprocessing.get_context("fork").Process(target=_worker_without_streams, args=(tmp_path / "log",))
    process.start()
    process.join(60.0)
    assert process.exitcode == 0
    assert (tmp_path / "log").read_text(encoding="utf-8") == "printed\nwritten\n"


@pytest.mark.parametrize(
    "width", ["0", *(pytest.param(w, marks=pytest.mark.long) for w in ("-3", "wide", "²", "9" * 12))]
)
@pytest.mark.parametrize("name", ["COLUMNS", "TERMINAL_WIDTH"])
def test_a_width_that_no_terminal_has(name: str, width: str, tmp_path: Path) -> None:
    """An unknown width, as for Python's own `shutil.get_terminal_size`: everything is shown."""
    settings = environment() | {name: width}
    for arguments, words in ((("rover", "--list"), "static"), (("--help",), "Usage")):
        ended = subprocess.run(command(*arguments), cwd=tmp_path, env=settings, capture_output=True, text=True)
        assert (ended.returncode, ended.stderr) == (0, "")
        assert words in ended.stdout
