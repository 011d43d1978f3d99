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
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, ClassVar

from contracts.errors import WorkbenchError

__all__ = ["Done", "Failed", "Job", "Lost", "Message", "Progressed", "run_job", "serve"]

_PR_SET_PDEATHSIG = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """What a worker needs to run one task.

    Attributes
    ----------
    name, function, inputs : as in `workbench.task.Task`
    needs : folder of each result to read
    folder : folder to fill
    checkpoint : file in which a resumable task keeps how far it came; None if the task keeps nothing
    """

    name: str
    function: str
    inputs: Mapping[str, Any]
    needs: Mapping[str, Path]
    folder: Path
    checkpoint: Path | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Progressed:
    """Fraction of the running task that is done [-]."""

    last: ClassVar[bool] = False
    fraction: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Done:
    """The task ended well: its unknowns and wall time [s]."""

    last: ClassVar[bool] = True
    dofs: int
    wall_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed:
    """The task raised: the message, and the traceback for the log if it was not one of our own errors."""

    last: ClassVar[bool] = True
    message: str
    traceback: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lost:
    """The worker died under the task: how, e.g. ``"signal 9 (SIGKILL)"``."""

    last: ClassVar[bool] = True
    how: str


type Message = Progressed | Done | Failed | Lost
"""News of a task; ``last`` where no more will follow."""


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
            pipe.send(run_job(job, lambda fraction: pipe.send(Progressed(fraction=float(fraction)))))


def run_job(job: Job, report: Callable[[float], None]) -> Done | Failed:
    """Run one task in this process; its errors become a message. ``report`` takes the fraction done."""
    start = time.perf_counter()
    try:
        module, _, function = job.function.partition(":")
        call = getattr(importlib.import_module(module), function)
        kept = {} if job.checkpoint is None else {"checkpoint": job.checkpoint}
        dofs = call(job.inputs, job.needs, job.folder, report, **kept)
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
