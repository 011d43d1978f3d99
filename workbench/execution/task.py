"""A task: one function call whose result is stored under the hash of everything it depends on.

Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from workbench.execution.fingerprint import canonical_json, library_versions, text_sha256
from workbench.execution.reach import reached, reached_libraries

__all__ = ["Progress", "Task", "TaskFunction", "bare_name", "chain_costs", "needed_for", "task_keys"]

_COMPILERS = frozenset({"fenics-ffcx", "numba"})
"""Distributions that compile while a task runs, and keep what they made for the next process."""

type Progress = Callable[[float], None]
"""Called by a task with the fraction done, 0 to 1."""

type TaskFunction = Callable[[Mapping[str, Any], Mapping[str, Path], Path, Progress], int]
"""``(inputs, folders of the tasks it needs, folder to fill, progress) -> number of unknowns``.

That of a resumable task takes ``checkpoint`` too, the path of a file: it goes on from what it finds there.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """One node of the task graph.

    Attributes
    ----------
    name : unique in the graph, e.g. ``"fe_phi015"``; in a graph of several studies ``"p3/fe_phi015"``, where what
        stands before the slash tells them apart and is no part of the key
    function : ``"module:function"``, a TaskFunction, imported in the worker only
    inputs : JSON values only
    needs : names of the tasks whose results it reads
    cost : expected wall time [s]; no part of the key
    memory : expected largest memory of its process [byte], 0 for little; no part of the key
    unknowns : expected number of unknowns, 0 where it is not known beforehand; no part of the key
    resumable : the function takes a ``checkpoint``
    shared : several MPI processes may run it together
    files : name among what it needs -> file of the user's that it reads; no part of the key, which has its content's
        hash among the inputs
    """

    name: str
    function: str
    inputs: Mapping[str, Any]
    needs: tuple[str, ...] = ()
    cost: float = 1.0
    memory: float = 0.0
    unknowns: int = 0
    resumable: bool = False
    shared: bool = False
    files: Mapping[str, Path] = field(default_factory=dict)

    def key(self, needed_keys: Mapping[str, str]) -> str:
        """SHA-256 of function, inputs, the sources and libraries it can reach, and the keys of what it needs."""
        return text_sha256(
            canonical_json(
                {
                    "function": self.function,
                    "inputs": self.inputs,
                    "needs": {bare_name(name): needed_keys[name] for name in self.needs},
                    **self.origin(),
                }
            )
        )

    @property
    def compilers(self) -> frozenset[str]:
        """What compiles in its process: tasks of the same set share most of what is compiled."""
        return _COMPILERS.intersection(reached_libraries(self.function.partition(":")[0]))

    def origin(self) -> dict[str, Mapping[str, str]]:
        """Hash of each source and version of each library that the function can reach."""
        module = self.function.partition(":")[0]
        return {"sources": reached(module), "libraries": library_versions(reached_libraries(module))}


def bare_name(name: str) -> str:
    """Name of a task in a graph of its own: ``"fe_phi015"`` for ``"p3/fe_phi015"``."""
    return name.rpartition("/")[2]


def needed_for(name: str, tasks: Sequence[Task]) -> tuple[Task, ...]:
    """The task of this name and all it needs, in their order."""
    by_name, wanted = {task.name: task for task in tasks}, {name}
    for task in reversed(tasks):  # each stands behind those it needs
        if task.name in wanted:
            wanted |= set(by_name[task.name].needs)
    return tuple(task for task in tasks if task.name in wanted)


def task_keys(tasks: tuple[Task, ...]) -> dict[str, str]:
    """Key of every task; tasks must come after those they need."""
    keys: dict[str, str] = {}
    for task in tasks:
        keys[task.name] = task.key(keys)
    return keys


def chain_costs(tasks: Sequence[Task]) -> dict[str, float]:
    """Cost of each task with the longest chain of those that need it [s]: who has most before it starts first."""
    chains: dict[str, float] = {}
    ahead: dict[str, float] = {}
    for task in reversed(tasks):
        chains[task.name] = task.cost + ahead.get(task.name, 0.0)
        for name in task.needs:
            ahead[name] = max(ahead.get(name, 0.0), chains[task.name])
    return chains
