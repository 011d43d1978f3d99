"""Whether a run's tasks fit into memory, judged before the first one starts.

Verified by tests/unit/test_workbench_memory.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from contracts.errors import MemoryLimitError
from contracts.memory import MemoryBound, free_memory, shown_size, total_memory
from workbench.execution.task import Task

__all__ = ["SURE", "memory_warning"]

SURE = 0.9
"""Part of the expected memory that a task takes at the least: below, a refusal could be wrong."""

_HINT = "choose a larger element_size or axial_size, a smaller factor, or a machine with more memory"


def memory_warning(
    tasks: Sequence[Task], workers: int, free: MemoryBound | None = None, total: MemoryBound | None = None
) -> str:
    """What to tell the user of the memory that the run will take; empty if it fits.

    Parameters
    ----------
    tasks : those still to be computed
    workers : how many run at once
    free, total : what each of them may take now, and one at the very most; read from the system if left out

    Raises
    ------
    MemoryLimitError
        If a task needs more than a process can ever have here.
    """
    largest = sorted((task for task in tasks if task.memory > 0.0), key=lambda task: -task.memory)[: max(workers, 1)]
    if not largest:
        return ""
    first, total = largest[0], total or total_memory()
    if SURE * first.memory > total.bytes:
        raise MemoryLimitError(f"{_need(first)}, and {total}", _HINT)
    count = len(largest)
    together, free = sum(task.memory for task in largest), free or free_memory(processes=count)
    if together <= count * free.bytes and first.memory <= total.bytes:
        return ""
    if count == 1:
        return f"{_need(first)}, and {free}: it may run out of memory; {_HINT}"
    return (
        f"{_need(first)}, {count} tasks at once about {shown_size(together)}, and "
        f"{shown_size(count * free.bytes)} are available {free.source}: they may run out of memory; use --workers 1, "
        f"or {_HINT}"
    )


def _need(task: Task) -> str:
    unknowns = f" for its {task.unknowns} unknowns" if task.unknowns else ""
    return f"task {task.name} needs about {shown_size(task.memory)}{unknowns}"
