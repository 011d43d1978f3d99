"""Ctrl-C in the middle of a motion: exit status 2, one message, nothing half written."""

from __future__ import annotations

import signal
import subprocess
import time
from pathlib import Path

from tests.end_to_end.small_study import command, environment, run


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


def test_in_the_middle_of_a_command_without_tasks(tmp_path: Path) -> None:
    """A motion of the rover that takes many seconds: Typer alone would end it with 130 and without a word."""
    start = time.monotonic()
    assert run("rover", "--list").returncode == 0
    begun = time.monotonic() - start + 1.5
    status, message = _interrupted(command("rover", "straight", "--tire", "ancf", "--out", tmp_path), begun)
    assert (status, message.count("\n")) == (2, 1), message
    assert message.startswith("workbench: error: interrupted; ")
    assert not (tmp_path / "series").exists()
