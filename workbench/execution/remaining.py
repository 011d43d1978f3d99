"""How long a run will still take, from what has finished. Verified by tests/unit/test_workbench_remaining.py."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean

from workbench.execution.task import Task

__all__ = ["RemainingTime"]


class RemainingTime:
    """Estimates the remaining wall time of a graph.

    A task is expected to take as long as the finished ones of the same function took on average, or, where none has
    finished, its own cost times what finished tasks took per unit of cost. With the work W done so far (finished tasks
    and the fractions of running ones) in the time t, the work left takes ``t W_left / W``, and at the least what the
    longest single task left takes. This holds for any number of workers, which need not be known.

    Parameters
    ----------
    tasks : of the graph
    """

    def __init__(self, tasks: Sequence[Task]) -> None:
        self._tasks = {task.name: task for task in tasks}
        self._left = dict.fromkeys(self._tasks, 0.0)
        self._walls: dict[str, float] = {}
        self._start: float | None = None

    def started(self, name: str, now: float) -> None:
        """A task begins, or begins again; ``now`` is any clock [s]."""
        self._start = now if self._start is None else self._start
        self._left[name] = 0.0

    def progressed(self, name: str, fraction: float) -> None:
        """A running task is this far [-]."""
        self._left[name] = min(max(fraction, 0.0), 1.0)

    def finished(self, name: str, wall_s: float, *, reused: bool) -> None:
        """A task ended well after ``wall_s`` [s]; one found in the store costs nothing and teaches nothing."""
        self._left.pop(name, None)
        if not reused:
            self._walls[name] = wall_s

    def dropped(self, name: str) -> None:
        """A task failed: it is left no longer."""
        self._left.pop(name, None)

    def seconds(self, now: float) -> float | None:
        """Remaining time [s], None before anything has finished."""
        if not self._walls or self._start is None:
            return None
        per_cost = sum(self._walls.values()) / sum(self._tasks[name].cost for name in self._walls)
        expected = {name: self._expected(name, per_cost) for name in self._left}
        done = sum(self._walls.values()) + sum(expected[name] * part for name, part in self._left.items())
        each = [expected[name] * (1.0 - part) for name, part in self._left.items()]
        if not each or done <= 0.0:
            return 0.0 if not each else None
        return max((now - self._start) * sum(each) / done, max(each))

    def _expected(self, name: str, per_cost: float) -> float:
        """Expected wall time of a task [s]."""
        task = self._tasks[name]
        alike = [wall for other, wall in self._walls.items() if self._tasks[other].function == task.function]
        return fmean(alike) if alike else task.cost * per_cost
