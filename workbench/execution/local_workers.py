"""Worker processes on this machine, one task at a time each.

Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from types import ModuleType

from contracts.memory import shown_size
from workbench.execution.disk import where_full
from workbench.execution.interrupts import put_off
from workbench.execution.jobs import Failed, Job, Lost, Message
from workbench.execution.memory import KillCount, limit_text, out_of_memory
from workbench.execution.worker import serve

__all__ = ["LocalWorkers"]

_SINGLE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

_LONGEST_PRINT = 1_000_000
"""Of a log no more than this is looked through [bytes]."""


@dataclass(slots=True, kw_only=True)
class _Slot:
    """One worker process and the job it runs, if any."""

    process: BaseProcess
    pipe: Connection
    job: Job | None = None
    log_size: int = 0
    """Of the log when the job began [bytes]."""


class LocalWorkers:
    """The worker processes of one run; a worker that dies is replaced by a new one.

    Parameters
    ----------
    count : processes at once
    log : file that takes what tasks and solvers print
    """

    def __init__(self, count: int, log: Path) -> None:
        self.log, self._killed = log, KillCount()
        self._slots = [self._spawn() for _ in range(count)]

    @property
    def free(self) -> int:
        """Number of workers without a job."""
        return sum(slot.job is None for slot in self._slots)

    def start(self, job: Job) -> None:
        """Hand a job to a free worker."""
        slot = next(slot for slot in self._slots if slot.job is None)
        slot.job, slot.log_size = job, self.log.stat().st_size if self.log.exists() else 0
        with suppress(OSError):  # a worker that died while idle is reported by the next `wait`
            slot.pipe.send(job)

    def wait(self) -> Sequence[tuple[str, Message]]:
        """Block until busy workers have something to say: task name and message."""
        busy = {slot.pipe: i for i, slot in enumerate(self._slots) if slot.job is not None}
        return [self._hear(busy[pipe]) for pipe in wait(list(busy)) if isinstance(pipe, Connection)]

    def stop(self) -> None:
        """End every worker, a busy one by force."""
        for slot in self._slots:
            slot.pipe.close()
            if slot.job is not None:
                slot.process.kill()
        for slot in self._slots:
            slot.process.join(10.0)

    def _spawn(self) -> _Slot:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=serve, args=(theirs, self.log), daemon=True)
        with _worker_surroundings():
            process.start()
        theirs.close()
        return _Slot(process=process, pipe=ours)

    def _hear(self, number: int) -> tuple[str, Message]:
        slot = self._slots[number]
        assert slot.job is not None
        name = slot.job.name
        try:
            message: Message = slot.pipe.recv()
            ended = isinstance(message, Lost)  # it had no memory left: a new process has more
        except (EOFError, OSError):
            slot.process.join(5.0)
            message, ended = self._end(slot, slot.job), True
        if ended:
            slot.pipe.close()
            slot.process.kill()
            self._slots[number] = self._spawn()
        elif message.last:
            slot.job = None
        return name, message

    def _end(self, slot: _Slot, job: Job) -> Message:
        """What a worker that is dead died of."""
        code = slot.process.exitcode
        number = -code if code is not None and code < 0 else 0
        if number == signal.SIGKILL and self._killed.one_more():
            return Lost(how=f"the kernel killed it because memory ran out: {_held()}", memory=True)
        if number == signal.SIGABRT and out_of_memory(self._printed_since(slot.log_size)):
            return Lost(how=f"no memory left: {_held()}", memory=True)
        if room := where_full(job.places):
            return Failed(message=room, disk_full=True)
        if number == 0:
            return Lost(how=f"exit status {code}")
        how = f"signal {number} ({signal.Signals(number).name})"
        if number == signal.SIGKILL:
            how += " from outside, not for want of memory" if self._killed.known else " from outside"
        return Lost(how=how)

    def _printed_since(self, start: int) -> str:
        """What workers printed after the log had this size [bytes]."""
        with suppress(OSError), self.log.open("rb") as stream:
            stream.seek(start)
            return stream.read(_LONGEST_PRINT).decode("utf-8", "replace")
        return ""


def _held() -> str:
    """The memory of the largest worker that died so far, and what there is."""
    return f"it held {shown_size(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)}, of {limit_text()}"


@contextmanager
def _worker_surroundings() -> Iterator[None]:
    """What a worker inherits at its start: one thread in BLAS, deafness to Ctrl-C, which its parent hears, no program.

    Without the last, a worker would run the script of whoever calls us from Python once more.
    """
    program = sys.modules["__main__"]
    before = {name: os.environ.get(name) for name in _SINGLE_THREAD}
    ensure_running()  # its first start would undo the next line
    with put_off():
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
        os.environ.update(_SINGLE_THREAD)
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            yield
        finally:
            sys.modules["__main__"] = program
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            for name, value in before.items():
                if value is None:
                    del os.environ[name]
                else:
                    os.environ[name] = value
