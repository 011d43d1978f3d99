"""A job: one task as a worker gets it, the messages it sends back, and how it is run.

Imports nothing heavy itself; each task's module brings what it needs. Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

import importlib
import sys
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from contracts.errors import WorkbenchError
from contracts.memory import free_memory, limited_address_space

__all__ = ["Done", "Failed", "Job", "Lost", "Message", "Progressed", "run_job"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """What a worker needs to run one task.

    Attributes
    ----------
    name, function, inputs : as in `workbench.execution.task.Task`
    needs : folder of each result to read
    folder : folder to fill
    checkpoint : file in which a resumable task keeps how far it came; None if the task keeps nothing
    origin : hashes of sources and versions of libraries, as in `workbench.execution.task.Task.origin`
    ranks : MPI processes that run it together
    """

    name: str
    function: str
    inputs: Mapping[str, Any]
    needs: Mapping[str, Path]
    folder: Path
    origin: Mapping[str, Mapping[str, str]]
    checkpoint: Path | None = None
    ranks: int = 1


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


_PETSC_OUT_OF_MEMORY = 55
_SHORT = 1e8
"""Free memory [byte] below which an unexpected error is put down to it."""
_LESS_MEMORY = "choose larger elements, or run fewer tasks at once (--workers 1)"

type Message = Progressed | Done | Failed | Lost
"""News of a task; ``last`` where no more will follow."""


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
        free = free_memory()
        if isinstance(error, MemoryError) or getattr(error, "ierr", 0) == _PETSC_OUT_OF_MEMORY:
            return Failed(message=f"out of memory: it got no more, and {free}; {_LESS_MEMORY}")
        if free.bytes < _SHORT:  # whatever failed, such as a library that could not be loaded, failed for that
            return Failed(message=f"out of memory: {free}; {_LESS_MEMORY} ({type(error).__name__}: {error})")
        limit = limited_address_space()
        told = f"; its address space is limited to {limit} (ulimit -v): is it out of memory?" if limit else ""
        return Failed(message=f"unexpected {type(error).__name__}: {error}{told}", traceback=text)
    return Done(dofs=int(dofs), wall_s=time.perf_counter() - start)
