"""Runs a task graph on workers and keeps every finished result in the store.

Verified by tests/unit/test_workbench_runner.py and tests/end_to_end/test_resume.py.
"""

from __future__ import annotations

import os
import shutil
import time
from collections import Counter, deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from workbench.execution.claims import Claims
from workbench.execution.disk import STORE, naming_the_disk
from workbench.execution.errors import DiskFullError, InterruptedRunError, RunError
from workbench.execution.jobs import Done, Failed, Job, Lost, Message, Progressed, ended_by_full_disk
from workbench.execution.listening import Listener, Workers
from workbench.execution.live_runs import announce
from workbench.execution.load_checks import require_loadable
from workbench.execution.local_workers import LocalWorkers
from workbench.execution.memory import memory_warning
from workbench.execution.ranks import mpiexec
from workbench.execution.store import Entry, Store
from workbench.execution.task import Task, bare_name, chain_costs, task_keys

__all__ = ["RESTARTS", "Computing", "Ended", "run_all", "run_tasks"]

_LOOK_EVERY = 0.2
"""Time between looks at what another run computes [s]."""
RESTARTS = 2
"""How often a task is started again after its worker died under it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Computing:
    """Who computes.

    Attributes
    ----------
    workers : local processes, one task each
    ranks : MPI processes for each task that can be shared between them; results differ by round-off only
    scheduler : address of a Dask scheduler, e.g. ``"tcp://host:8786"``, whose workers compute instead
    """

    workers: int = 2
    ranks: int = 1
    scheduler: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Ended:
    """What a run leaves: results by task name, and by task name why there is none."""

    entries: dict[str, Entry]
    failures: dict[str, str]


def run_tasks(
    tasks: Sequence[Task], store: Store, listener: Listener, computing: Computing | None = None
) -> dict[str, Entry]:
    """Run every task that the store does not hold yet; as `run_all`, but a failure is an error at the end.

    Returns
    -------
    entries : result of each task by name

    Raises
    ------
    RunError
        If a task fails, its workers die again and again, or the user interrupts; what had finished stays in the store.
    """
    ended = run_all(tasks, store, listener, computing)
    if ended.failures:
        raise RunError("; ".join(_told_once(ended.failures)))
    return ended.entries


def _told_once(failures: Mapping[str, str]) -> list[str]:
    """Messages of failed tasks by name; what several say alike is told once, of all of them."""
    alike: dict[str, list[str]] = {}
    for name, told in failures.items():
        alike.setdefault(told.removeprefix(f"task {name} "), []).append(name)
    return [
        failures[names[0]] if len(names) == 1 else f"tasks {', '.join(names)} {told}" for told, names in alike.items()
    ]


def run_all(tasks: Sequence[Task], store: Store, listener: Listener, computing: Computing | None = None) -> Ended:
    """Run every task that the store does not hold yet, to the end of all that can be computed.

    A worker that dies costs no more than what its task did since its last checkpoint: the task starts again, twice at
    most. A task that fails stops those that need it, and no other. A stored result that is damaged is told of and
    computed again. What another run on the same store computes at this moment is waited for.

    Parameters
    ----------
    tasks : graph in an order where each task follows those it needs
    store : where results are found and kept
    listener : told of every start, progress and end
    computing : who computes; two local processes if left out

    Raises
    ------
    RunError
        If nobody can compute, a library cannot be loaded, or the user interrupts; what had finished stays in the store.
    InputError
        If something is to be computed and the store cannot be written.
    MemoryLimitError
        If a task needs more memory than a process can have here; nothing was started.
    """
    keys = task_keys(tuple(tasks))
    if store.writable:
        with naming_the_disk(STORE, store.root):
            store.sweep()
            announce(store.root, keys.values())
    entries: dict[str, Entry] = {}
    for task in tasks:
        entry = store.get(keys[task.name])
        if entry is not None:
            entries[task.name] = entry
            listener.finished(task.name, entry, reused=True)
        elif fault := store.fault(keys[task.name]):
            listener.damaged(task.name, fault)
    chains = chain_costs(tasks)
    waiting = sorted((t for t in tasks if t.name not in entries), key=lambda t: -chains[t.name])
    if not waiting:
        return Ended(entries=entries, failures={})
    if not store.writable:
        rule = f"cannot be written, and {len(waiting)} of {len(tasks)} results are not in it"
        raise InputError("result store", store.root, rule, "choose another with --store")
    log = store.root / "log" / f"run-{os.getpid()}.log"
    computing = computing or Computing()
    if computing.scheduler is None:
        require_loadable(waiting)
        if warning := memory_warning(waiting, computing.workers):
            listener.warned(warning)
    with naming_the_disk(STORE, store.root):
        run = _Run(store, keys, listener, _workers(computing, len(waiting), log), computing.ranks)
        run.run(waiting, entries)
    return Ended(entries=entries, failures=run.failures)


def _workers(computing: Computing, tasks: int, log: Path) -> Workers:
    if computing.ranks > 1:
        mpiexec()
    if computing.scheduler is not None:
        from workbench.execution.dask_workers import DaskWorkers

        return DaskWorkers(computing.scheduler, log)
    return LocalWorkers(min(computing.workers, tasks), log)


def _others_first(ready: Iterable[Task], busy: set[frozenset[str]]) -> list[Task]:
    """Those first whose compilers no running task has: two that begin at once would each compile the same."""
    return sorted(ready, key=lambda task: bool(task.compilers) and task.compilers in busy)


class _Run:
    """One run: which task may start, what became of it."""

    def __init__(self, store: Store, keys: Mapping[str, str], listener: Listener, workers: Workers, ranks: int) -> None:
        self.store, self.keys, self.listener, self.workers, self.ranks = store, keys, listener, workers, ranks
        self.running: dict[str, tuple[Task, Path]] = {}
        self.claims, self.told = Claims(store.root), set[str]()
        self.restarts: Counter[str] = Counter()
        self.alone: set[str] = set()
        self.failures: dict[str, str] = {}
        self.disk_full = ""

    def run(self, waiting: list[Task], entries: dict[str, Entry]) -> None:
        """Dispatch until nothing can start and nothing runs; always ends the workers."""
        try:
            while self._dispatch(waiting, entries):
                for name, message in self.workers.wait() if self.running else ():
                    self._hear(name, message, waiting, entries)
            if self.disk_full:
                raise DiskFullError(self.disk_full)
        except KeyboardInterrupt:
            raise InterruptedRunError("interrupted; finished results are kept, start again to go on") from None
        finally:
            self.workers.stop()
            self.claims.give_back_all()
            for _, folder in self.running.values():
                shutil.rmtree(folder, ignore_errors=True)

    def _dispatch(self, waiting: list[Task], entries: dict[str, Entry]) -> bool:
        """Start what can start; whether there is anything to wait for, here or in another run."""
        elsewhere, found = list[str](), False
        busy = {task.compilers for task, _ in self.running.values()}
        ready = deque(_others_first(self._ready(waiting, entries), busy))
        while ready and self.workers.free:
            task = ready.popleft()
            key = self.keys[task.name]
            if not self.claims.take(key):
                elsewhere.append(task.name)
                continue
            waiting.remove(task)
            entry = self.store.get(key)
            if entry is None:
                self._start(task, entries)
                if task.compilers not in busy:
                    busy.add(task.compilers)
                    ready = deque(_others_first(ready, busy))
                continue
            self.claims.give_back(key)
            entries[task.name], found = entry, True
            self.listener.finished(task.name, entry, reused=True)
        if elsewhere and not (found or self.running):
            for name in set(elsewhere) - self.told:
                self.told.add(name)
                self.listener.elsewhere(name)
            time.sleep(_LOOK_EVERY)
        return bool(elsewhere or found or self.running)

    def _ready(self, waiting: Sequence[Task], entries: Mapping[str, Entry]) -> list[Task]:
        """Tasks that may start now; one for which memory ran out gets all of it, and on a full disk none begins."""
        ready = [task for task in waiting if all(name in entries for name in task.needs)]
        lonely = [task for task in ready if task.name in self.alone]
        if self.disk_full or not self.alone.isdisjoint(self.running) or (lonely and self.running):
            return []
        return lonely[:1] or ready

    def _start(self, task: Task, entries: Mapping[str, Entry]) -> None:
        folder = self.store.scratch()
        self.running[task.name] = task, folder
        job = Job(
            name=task.name,
            function=task.function,
            inputs=task.inputs,
            needs={bare_name(name): entries[name].path for name in task.needs} | dict(task.files),
            folder=folder,
            origin=task.origin(),
            checkpoint=self.store.checkpoint(self.keys[task.name]) if task.resumable else None,
            ranks=self.ranks if task.shared else 1,
            store=self.store.root,
        )
        self.workers.start(job)
        self.listener.started(task.name)

    def _hear(self, name: str, message: Message, waiting: list[Task], entries: dict[str, Entry]) -> None:
        """Take one message about a running task."""
        if isinstance(message, Progressed):
            self.listener.progressed(name, message.fraction)
            return
        task, folder = self.running.pop(name)
        end = self._keep(task, folder, message, entries) if isinstance(message, Done) else message
        self.claims.give_back(self.keys[name])
        if end is None:
            self.listener.finished(name, entries[name], reused=False)
            return
        shutil.rmtree(folder, ignore_errors=True)
        if isinstance(end, Lost) and self._again(name, end):
            waiting.insert(0, task)
            self.listener.restarted(name, end.how if end.memory else f"its worker ended with {end.how}")
            return
        self.failures[name] = self._failure(name, end)
        self.listener.failed(name, self.failures[name])

    def _keep(self, task: Task, folder: Path, done: Done, entries: dict[str, Entry]) -> Failed | None:
        """Put a finished task's result into the store; what is to be said where its disk is full."""
        record: dict[str, Any] = {"task": bare_name(task.name), "function": task.function, "inputs": task.inputs}
        record |= {"wall_s": done.wall_s, "dofs": done.dofs, "origin": task.origin()}
        record["needs"] = {bare_name(needed): self.keys[needed] for needed in task.needs}
        try:
            entries[task.name] = self.store.put(self.keys[task.name], folder, record)
        except OSError as error:
            return ended_by_full_disk(error, {STORE: self.store.root})
        return None

    def _again(self, name: str, message: Lost) -> bool:
        """Whether a task that lost its worker is to start again: after a want of memory once, and then alone."""
        self.restarts[name] += message.times
        if message.memory:
            first = name not in self.alone
            self.alone.add(name)
            return first
        return self.restarts[name] <= RESTARTS

    def _failure(self, name: str, message: Failed | Lost) -> str:
        if isinstance(message, Failed) and message.disk_full:
            self.disk_full = self.disk_full or message.message
        if isinstance(message, Failed):
            where = f"; the traceback is in {self.workers.log}" if message.logged else ""
            return f"task {name} failed: {message.message}{where}"
        if message.memory:
            return (
                f"task {name} failed twice, the second time alone: {message.how}; finished results are kept, start "
                "again with more memory, or ask for less: a coarser mesh"
            )
        return (
            f"the worker of task {name} ended with {message.how}, {self.restarts[name]} times; finished results are "
            f"kept, start again to go on; its output is in {self.workers.log}"
        )
