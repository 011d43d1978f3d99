"""The worker process: takes jobs from a pipe, runs one at a time, reports back.

Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

import contextlib
import functools
import io
import os
import signal
import sys
from multiprocessing.connection import Connection
from pathlib import Path

from workbench.execution.jobs import Job, Progressed, run_job
from workbench.execution.ranks import die_with_parent, run_on_ranks
from workbench.execution.standard_streams import open_closed_streams

__all__ = ["serve"]


def serve(pipe: Connection, log: Path) -> None:
    """Run jobs until the pipe closes. Ctrl-C is the parent's business; this process dies with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    _redirect_output(log)
    with contextlib.suppress(EOFError, BrokenPipeError):
        while True:
            job: Job | None = pipe.recv()
            if job is None:
                return
            report = functools.partial(_report, pipe)
            pipe.send(run_job(job, report) if job.ranks == 1 else run_on_ranks(job, report))


def _report(pipe: Connection, fraction: float) -> None:
    pipe.send(Progressed(fraction=float(fraction)))


def _redirect_output(log: Path) -> None:
    """Send what solvers print to a log file, so that the user's terminal shows our messages only.

    Where no log can be written, what is printed is lost and nothing else: a full disk fails no task by that.
    """
    open_closed_streams()  # else the log would be one of them
    sys.stdout.flush()
    sys.stderr.flush()
    try:
        log.parent.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    except OSError:
        descriptor = os.open(os.devnull, os.O_WRONLY)
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.close(descriptor)
    sys.stdout, sys.stderr = (_Log(number) for number in (1, 2))


class _Log(io.TextIOWrapper):
    """A stream that drops what cannot be written; a line is written at once, so that a crash finds it in the log."""

    def __init__(self, descriptor: int) -> None:
        super().__init__(io.FileIO(descriptor, "w", closefd=False), "utf-8", "backslashreplace", write_through=True)

    def write(self, text: str) -> int:
        """Write or drop the text."""
        with contextlib.suppress(OSError):
            super().write(text)
        return len(text)

    def flush(self) -> None:
        """Nothing is held back."""
        with contextlib.suppress(OSError):
            super().flush()
