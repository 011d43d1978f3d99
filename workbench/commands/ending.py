"""The end of a command: one line on stderr, whatever went wrong, and an exit status even if nobody can be told.

Verified by tests/end_to_end/test_closed_streams.py and tests/end_to_end/test_disk.py.
"""

from __future__ import annotations

import contextlib
import os
import sys
from itertools import pairwise
from pathlib import Path
from typing import TextIO

from contracts.text import for_terminal
from workbench.commands.options import DEFAULT_STORE

__all__ = ["complain", "flushed", "full_disk", "of_bearable_length"]

_LONGEST_MESSAGE = 1600


def flushed(status: int) -> int:
    """The exit status, or 2 if what was printed could not be written: a full disk behind a redirected output."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:  # the reader, such as head, has seen enough
        _drop(sys.stdout)
    except OSError as error:
        _drop(sys.stdout)
        return status if status == 2 else complain(f"standard output: {error.strerror}; check path and space")
    return status


def _drop(stream: TextIO) -> None:
    """Send what is left to nowhere, so that the interpreter's end does not complain again."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def full_disk(error: OSError, arguments: list[str]) -> str:
    """Which disk is full, of those the command writes to by its arguments; ``""`` if the error is another."""
    from workbench.execution.disk import OUT, STORE, disk_full

    found = {OUT: Path("build"), STORE: Path(os.environ.get("WORKBENCH_STORE") or DEFAULT_STORE)}
    for name, following in pairwise([*arguments, ""]):
        option, _, joined = name.partition("=")
        if option in ("--out", "--store") and (joined or following):
            found[OUT if option == "--out" else STORE] = Path(joined or following)
    return disk_full(error, found)


def of_bearable_length(message: str) -> str:
    """The message in one line for the terminal; the middle of a very long one is left out."""
    line = for_terminal(" ".join(message.split()))
    if len(line) > _LONGEST_MESSAGE:
        line = f"{line[: _LONGEST_MESSAGE // 2]} [...] {line[-_LONGEST_MESSAGE // 2 :]}"
    return line


def complain(message: str) -> int:
    """Say it in one line, whatever a file made a message hold."""
    try:
        Path.cwd()
    except OSError:  # the cause of much else
        message = f"the working folder is gone, change into one that exists: {message}"
    try:
        sys.stderr.write(f"workbench: error: {of_bearable_length(message)}\n")
        sys.stderr.flush()
    except OSError:  # nobody can be told
        _drop(sys.stderr)
    return 2
