"""Runs a task graph in local processes and keeps every finished result in the store.

Verified by tests/unit/test_workbench_runner.py and tests/end_to_end/test_resume.py.
"""

from __future__ import annotations

import multiprocessing
import os
import shutil
import signal
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Protocol

from workbench.errors import InterruptedRunError, RunError
from workbench.store import Entry, Store
from workbench.task import Task, task_keys
from workbench.worker import Done, Failed, Job, Progressed, serve

__all__ = ["Listener", "run_tasks"]

_SINGLE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class Listener(Protocol):
    """Hears what happens to tasks; the command line shows it."""

    def started(self, name: str) -> None:
        """The task began to run."""

    def progressed(self, name: str, fraction: float) -> None:
        """The task is this far, 0 to 1."""

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """The result is in the store, computed now or found there."""


@dataclass(slots=True, kw_only=True)
class _Slot:
    """One worker process and the task it runs, if any."""

    process: BaseProcess
    pipe: Connection
    task: Task | None = None
    folder: Path | None = None


def run_tasks(tasks: Sequence[Task], store: Store, listener: Listener, workers: int = 2) -> dict[str, Entry]:
    """Run every task that the store does not hold yet; at most ``workers`` at once.

    Parameters
    ----------
    tasks : graph in an order where each task follows those it needs
    store : where results are found and kept
    listener : told of every start, progress and end
    workers : number of local processes

    Returns
    -------
    entries : result of each task by name

    Raises
    ------
    RunError
        If a task fails, a worker dies or the user interrupts; what had finished stays in the store.
    """
    store.sweep()
    keys = task_keys(tuple(tasks))
    entries: dict[str, Entry] = {}
    for task in tasks:
        entry = store.get(keys[task.name])
        if entry is not None:
            entries[task.name] = entry
            listener.finished(task.name, entry, reused=True)
    waiting = sorted((t for t in tasks if t.name not in entries), key=lambda t: -t.cost)
    if waiting:
        _Pool(store, keys, listener, min(workers, len(waiting))).run(waiting, entries)
    return entries


@contextmanager
def _worker_surroundings() -> Iterator[None]:
    """What a worker inherits at its start: one thread in BLAS, and deafness to Ctrl-C, which its parent hears."""
    before = {name: os.environ.get(name) for name in _SINGLE_THREAD}
    os.environ.update(_SINGLE_THREAD)
    in_main = threading.current_thread() is threading.main_thread()
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN) if in_main else None
    try:
        yield
    finally:
        if in_main:
            signal.signal(signal.SIGINT, handler)
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


class _Pool:
    """The worker processes of one run."""

    def __init__(self, store: Store, keys: Mapping[str, str], listener: Listener, workers: int) -> None:
        self.store, self.keys, self.listener = store, keys, listener
        self.log = store.root / "log" / f"run-{os.getpid()}.log"
        self.slots = [self._start() for _ in range(workers)]

    def _start(self) -> _Slot:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=serve, args=(theirs, self.log), daemon=True)
        with _worker_surroundings():
            process.start()
        theirs.close()
        return _Slot(process=process, pipe=ours)

    def run(self, waiting: list[Task], entries: dict[str, Entry]) -> None:
        """Dispatch until nothing waits and nothing runs; always ends the processes."""
        try:
            while waiting or any(slot.task for slot in self.slots):
                self._dispatch(waiting, entries)
                busy = {slot.pipe: slot for slot in self.slots if slot.task}
                for pipe in wait(list(busy)):
                    assert isinstance(pipe, Connection)
                    self._hear(busy[pipe], entries)
        except KeyboardInterrupt:
            raise InterruptedRunError("interrupted; finished results are kept, start again to go on") from None
        finally:
            self._stop()

    def _dispatch(self, waiting: list[Task], entries: Mapping[str, Entry]) -> None:
        for slot in self.slots:
            ready = next((t for t in waiting if all(n in entries for n in t.needs)), None)
            if slot.task is not None or ready is None:
                continue
            waiting.remove(ready)
            slot.task, slot.folder = ready, self.store.scratch()
            needs = {name: entries[name].path for name in ready.needs}
            job = Job(name=ready.name, function=ready.function, inputs=ready.inputs, needs=needs, folder=slot.folder)
            try:
                slot.pipe.send(job)
            except OSError:
                raise RunError(self._died(slot, ready)) from None
            self.listener.started(ready.name)

    def _hear(self, slot: _Slot, entries: dict[str, Entry]) -> None:
        """Take one message from a busy worker."""
        task, folder = slot.task, slot.folder
        assert task is not None
        assert folder is not None
        try:
            message = slot.pipe.recv()
        except (EOFError, OSError):
            raise RunError(self._died(slot, task)) from None
        if isinstance(message, Progressed):
            self.listener.progressed(task.name, message.fraction)
        elif isinstance(message, Failed):
            where = f"; the traceback is in {self.log}" if message.traceback else ""
            raise RunError(f"task {task.name} failed: {message.message}{where}")
        elif isinstance(message, Done):
            record = {"task": task.name, "inputs": task.inputs, "wall_s": message.wall_s, "dofs": message.dofs}
            record["needs"] = {name: self.keys[name] for name in task.needs}
            entry = self.store.put(self.keys[task.name], folder, record)
            entries[task.name] = entry
            slot.task = slot.folder = None
            self.listener.finished(task.name, entry, reused=False)

    def _died(self, slot: _Slot, task: Task) -> str:
        slot.process.join(5.0)
        code = slot.process.exitcode
        how = f"exit status {code}"
        if code is not None and code < 0:
            how = f"signal {-code} ({signal.Signals(-code).name})"
        return (
            f"the worker of task {task.name} ended with {how}; finished results are kept, start again to go on "
            f"(out of memory? use --workers 1); its output is in {self.log}"
        )

    def _stop(self) -> None:
        """End every worker; drop what unfinished tasks had written."""
        for slot in self.slots:
            slot.pipe.close()
            if slot.task is not None:
                slot.process.kill()
        for slot in self.slots:
            slot.process.join(10.0)
            if slot.folder is not None:
                shutil.rmtree(slot.folder, ignore_errors=True)
