"""The worker process: takes jobs from a pipe, runs one task at a time, reports back.

Imports nothing heavy itself; each task's module brings what it needs. Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import io
import os
import signal
import sys
import time
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from contracts.errors import WorkbenchError

__all__ = ["Done", "Failed", "Job", "Progressed", "serve"]

_PR_SET_PDEATHSIG = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """What a worker needs to run one task: the function, its inputs, folders to read and the folder to fill."""

    name: str
    function: str
    inputs: Mapping[str, Any]
    needs: Mapping[str, Path]
    folder: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class Progressed:
    """Fraction of the running task that is done [-]."""

    fraction: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Done:
    """The task ended well: its unknowns and wall time [s]."""

    dofs: int
    wall_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed:
    """The task raised: the message, and the traceback for the log if it was not one of our own errors."""

    message: str
    traceback: str = ""


def serve(pipe: Connection, log: Path) -> None:
    """Run jobs until the pipe closes. Ctrl-C is the parent's business; this process dies with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _die_with_parent()
    _redirect_output(log)
    with contextlib.suppress(EOFError, BrokenPipeError):
        while True:
            job: Job | None = pipe.recv()
            if job is None:
                return
            pipe.send(_run(job, pipe))


def _run(job: Job, pipe: Connection) -> Done | Failed:
    start = time.perf_counter()
    try:
        module, _, function = job.function.partition(":")
        call = getattr(importlib.import_module(module), function)
        dofs = call(job.inputs, job.needs, job.folder, lambda f: pipe.send(Progressed(fraction=float(f))))
    except WorkbenchError as error:
        return Failed(message=str(error))
    except Exception as error:
        text = traceback.format_exc()
        sys.stderr.write(f"--- {job.name}\n{text}\n")
        sys.stderr.flush()
        return Failed(message=f"unexpected {type(error).__name__}: {error}", traceback=text)
    return Done(dofs=int(dofs), wall_s=time.perf_counter() - start)


def _die_with_parent() -> None:
    """Ask Linux to kill this process when its parent dies, so that a killed run leaves no orphan computing."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


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
