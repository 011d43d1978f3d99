"""Ctrl-C at any time: exit status 2, one message and no traceback, nothing half written, a store that works.

When it comes is counted in audit events of the command's own process (imports, opened files, renames), by a hook that
its start installs (``sitecustomize``): each moment of a run can be hit on purpose, however busy the machine is. What
precedes our first line, Python's own start, ends as Python does.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import command, environment, run, small_study_text
from workbench.execution.integrity import examined

HOOK = """
import atexit, os, signal, sys
_seen, _at, _log = 0, int(os.environ["INTERRUPT_AT"]), os.environ["EVENT_LOG"]
def _hear(event, arguments):
    global _seen
    _seen += 1
    if event == "os.rename" and not _at:
        with open(_log, "a") as log:
            log.write(f"{_seen}\\n")
    if _seen == _at:
        os.kill(os.getpid(), signal.SIGINT)
if os.path.basename(sys.orig_argv[-1]) == "store":  # not the workers, who leave Ctrl-C to their parent
    sys.addaudithook(_hear)
"""


def _started(arguments: list[str], known: dict[str, str]) -> subprocess.Popen[str]:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job would hand down "ignore"
    try:
        return subprocess.Popen(
            arguments, env=known, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True
        )
    finally:
        signal.signal(signal.SIGINT, before)


def _interrupted(folder: Path, at: int) -> tuple[int, str]:
    """Exit status and error stream of a command that gets SIGINT with its ``at``-th event, or with none if 0."""
    known = environment() | {"INTERRUPT_AT": str(at), "EVENT_LOG": str(folder / "renames")}
    known["PYTHONPYCACHEPREFIX"] = str(folder / "bytecode")  # the same whatever else runs
    known["PYTHONPATH"] = f"{folder}{os.pathsep}{known['PYTHONPATH']}"
    places = ("--out", folder / f"out{at}", "--store", folder / "store")
    process = _started(command("stiffness", folder / "study.toml", "--model", "brush", *places), known)
    _, message = process.communicate()
    return process.returncode, message


@pytest.mark.long
def test_at_any_moment_of_a_run(tmp_path: Path) -> None:
    """While libraries are loaded, in the store's one rename and in the last ones, which put the curves in place."""
    (tmp_path / "sitecustomize.py").write_text(HOOK, encoding="utf-8")
    (tmp_path / "study.toml").write_text(small_study_text(), encoding="utf-8")
    for _ in range(2):  # the first run makes the store and fills the caches of Python and numba, which counts as events
        for entry in (*(tmp_path / "store").glob("??"), *tmp_path.glob("out0")):
            shutil.rmtree(entry)
        (tmp_path / "renames").unlink(missing_ok=True)
        assert _interrupted(tmp_path, 0) == (0, "")
    renames = [int(line) for line in (tmp_path / "renames").read_text(encoding="utf-8").split()]
    source = random.Random(7)
    for at in (*(round(renames[0] * (0.02 + 0.45 * (k + source.random()))) for k in range(2)), renames[0], renames[-1]):
        for entry in (tmp_path / "store").glob("??"):
            shutil.rmtree(entry)
        status, message = _interrupted(tmp_path, at)
        assert (status, message.count("\n")) == (2, 1), f"event {at} of {renames}: {message}"
        assert message.startswith("workbench: error: interrupted; "), f"event {at}"
        entries = list((tmp_path / "store").glob("??/*"))
        assert len(entries) == 1 or at < renames[-1]
        assert all(examined(entry, entry.name)[1] == "" for entry in entries)
    places = ("--out", tmp_path / "again", "--store", tmp_path / "store")
    ended = run("stiffness", tmp_path / "study.toml", "--model", "brush", *places)
    assert (ended.returncode, ended.stdout.count("reused")) == (0, 2), ended.stderr
    assert list((tmp_path / "store" / "tmp").iterdir()) == []
    one, two = (read_curve(tmp_path / name / "curves" / "brush_average.csv") for name in ("out0", "again"))
    assert (one.load == two.load).all()


def test_in_the_middle_of_a_command_without_tasks(tmp_path: Path) -> None:
    """A motion of the rover that takes many seconds: Typer alone would end it without a word."""
    start = time.monotonic()
    assert run("rover", "--list").returncode == 0
    begun = time.monotonic() - start + 1.5
    process = _started(command("rover", "straight", "--tire", "ancf", "--out", tmp_path), environment())
    time.sleep(begun)
    process.send_signal(signal.SIGINT)
    _, message = process.communicate()
    assert (process.returncode, message.count("\n")) == (2, 1), message
    assert message.startswith("workbench: error: interrupted; ")
    assert not (tmp_path / "series").exists()
