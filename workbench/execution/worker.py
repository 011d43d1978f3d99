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
    """Send what solvers print to a log file, so that the user's terminal shows our messages only."""
    log.parent.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    sys.stdout.flush()
    sys.stderr.flush()
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.close(descriptor)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # what was printed before a crash must reach the log
