"""Ctrl-C at any time: exit status 2 and one message, or the run had already ended; the store works afterwards."""

from __future__ import annotations

import random
import signal
import subprocess
import time
from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import command, environment, run, small_study_text
from workbench.execution.integrity import examined


def _interrupted(arguments: list[str], after: float) -> tuple[int, str]:
    """Exit status and error stream of a command that gets SIGINT, as from a terminal, ``after`` seconds [s]."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job would hand down "ignore"
    try:
        process = subprocess.Popen(
            arguments, env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
            start_new_session=True,
        )  # fmt: skip
    finally:
        signal.signal(signal.SIGINT, before)
    time.sleep(after)
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=120)
    return process.returncode, message


def test_at_random_times_of_a_run(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    study.write_text(small_study_text(), encoding="utf-8")

    def arguments(name: str) -> tuple[str | Path, ...]:
        places = ("--out", tmp_path / name, "--store", tmp_path / f"{name}_store")
        return ("stiffness", study, "--model", "ancf", "--orientation", "0", *places)

    assert run(*arguments("compiled")).returncode == 0  # the first run may compile, and would be no measure
    start = time.monotonic()
    assert run(*arguments("whole")).returncode == 0
    whole = time.monotonic() - start
    source, stopped = random.Random(7), 0
    for k in range(6):
        # Python itself, before its first line of ours, dies of Ctrl-C as any program does: not before a tenth
        status, message = _interrupted(command(*arguments("again")), whole * (0.1 + 0.15 * k + 0.1 * source.random()))
        assert status in (0, 2), message
        if status == 2:
            stopped += 1
            assert message.startswith("workbench: error: interrupted; ")
            assert message.count("\n") == 1, message
        else:
            assert message == ""
    assert stopped >= 2
    ended = run(*arguments("again"))
    assert ended.returncode == 0, ended.stderr
    assert list((tmp_path / "again_store" / "tmp").iterdir()) == []
    for manifest in (tmp_path / "again_store").glob("??/*/manifest.json"):
        assert examined(manifest.parent, manifest.parent.name)[1] == ""
    one, two = (read_curve(tmp_path / name / "curves" / "ancf_phi000.csv") for name in ("whole", "again"))
    assert one.load == pytest.approx(two.load, rel=1e-9, abs=1e-12)


def test_in_the_middle_of_a_command_without_tasks(tmp_path: Path) -> None:
    """A motion of the rover that takes many seconds: Typer alone would end it with 130 and without a word."""
    start = time.monotonic()
    assert run("rover", "--list").returncode == 0
    begun = time.monotonic() - start + 1.5
    status, message = _interrupted(command("rover", "straight", "--tire", "ancf", "--out", tmp_path), begun)
    assert (status, message.count("\n")) == (2, 1), message
    assert message.startswith("workbench: error: interrupted; ")
    assert not (tmp_path / "series").exists()
