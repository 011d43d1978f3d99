"""A job: one task as a worker gets it, the messages it sends back, and how it is run.

Imports nothing heavy itself; each task's module brings what it needs. Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

import errno
import importlib
import os
import resource
import sys
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from contracts.errors import WorkbenchError
from contracts.memory import free_memory, limited_address_space, shown_size
from workbench.execution.disk import STORE, disk_full, no_room, where_full
from workbench.execution.memory import limit_text, out_of_memory

__all__ = ["Done", "Failed", "Job", "Lost", "Message", "Progressed", "ended_by_full_disk", "run_job"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """What a worker needs to run one task.

    Attributes
    ----------
    name, function, inputs : as in `workbench.execution.task.Task`
    needs : folder of each result to read; file of each of the task's files
    folder : folder to fill
    checkpoint : file in which a resumable task keeps how far it came; None if the task keeps nothing
    origin : hashes of sources and versions of libraries, as in `workbench.execution.task.Task.origin`
    ranks : MPI processes that run it together
    store : result store that ``folder`` is in, to name where its disk is full; None if it is elsewhere
    """

    name: str
    function: str
    inputs: Mapping[str, Any]
    needs: Mapping[str, Path]
    folder: Path
    origin: Mapping[str, Mapping[str, str]]
    checkpoint: Path | None = None
    ranks: int = 1
    store: Path | None = None

    @property
    def places(self) -> Mapping[str, Path]:
        """What the job writes to, beside temporary files."""
        return {} if self.store is None else {STORE: self.store}


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
    """The task raised: the message, whether its traceback is in the log, and whether a disk is full."""

    last: ClassVar[bool] = True
    message: str
    logged: bool = False
    disk_full: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Lost:
    """The worker died under the task, or had no memory for it.

    Attributes
    ----------
    how : it ended, e.g. ``"signal 9 (SIGKILL)"``
    memory : memory ran out
    times : how often it died before this was told
    """

    last: ClassVar[bool] = True
    how: str
    memory: bool = False
    times: int = 1


_SHORT = 1e8
"""Free memory [byte] below which an unexpected error is put down to it, such as a library that cannot be loaded."""

type Message = Progressed | Done | Failed | Lost
"""News of a task; ``last`` where no more will follow."""


def ended_by_full_disk(error: OSError, places: Mapping[str, Path]) -> Failed:
    """What becomes of a task where a disk is full, ``places`` as in `disk_full`; any other error is raised again."""
    if text := disk_full(error, places):
        return Failed(message=text, disk_full=True)
    raise error


def run_job(job: Job, report: Callable[[float], None]) -> Done | Failed | Lost:
    """Run one task in this process; its errors become a message. ``report`` takes the fraction done."""
    start = time.perf_counter()
    try:
        module, _, function = job.function.partition(":")
        call = getattr(importlib.import_module(module), function)
        kept = {} if job.checkpoint is None else {"checkpoint": job.checkpoint}
        dofs = call(job.inputs, job.needs, job.folder, report, **kept)
        if no_room(job.folder):  # libraries that write in C do not always tell
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(job.folder))
    except WorkbenchError as error:
        return _without_room(job, error) or Failed(message=str(error))
    except Exception as error:
        return _without_room(job, error) or _unforeseen(job, error)
    return Done(dofs=int(dofs), wall_s=time.perf_counter() - start)


def _without_room(job: Job, error: Exception) -> Failed | Lost | None:
    """What is said of an error that came of a full disk or of memory that ran out; None of any other."""
    if text := disk_full(error, job.places):
        return Failed(message=text, disk_full=True)
    if not isinstance(error, WorkbenchError) and (out_of_memory(error) or free_memory().bytes < _SHORT):
        held = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        said = f" ({type(error).__name__}: {error})" if str(error) else ""
        return Lost(how=f"no memory left{said}: it held {shown_size(held)}, of {limit_text()}", memory=True)
    return None


def _unforeseen(job: Job, error: Exception) -> Failed:
    """An error nobody foresaw: its traceback goes to the log; a disk without room may be behind it and is named."""
    limit, room = limited_address_space(), where_full(job.places)
    told = f"; its address space is limited to {limit} (ulimit -v): is it out of memory?" if limit else ""
    text = f"unexpected {type(error).__name__}: {error}{told}"
    sys.stderr.write(f"--- {job.name}\n{traceback.format_exc()}\n")
    sys.stderr.flush()
    return Failed(message=f"{text}; {room}") if room else Failed(message=text, logged=True)
