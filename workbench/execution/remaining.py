"""How long a run will still take, from what has finished and what runs. Verified by
tests/unit/test_workbench_remaining.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from workbench.execution.task import Task

__all__ = ["Left", "RemainingTime"]

_TELLING = 0.02
"""Fraction from which on a running task's own pace says more than its expected cost."""

_EVIDENCE = 0.05
"""Share of all work that must be done before anything is said of the rest."""
_BELIEVED = 60.0
"""Work [s] that counts as done in the time that was foretold, against what finished tasks of other functions took."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Left:
    """Remaining wall time [s], and whether it may be any longer: a task already takes longer than it should."""

    seconds: float
    at_least: bool = False


@dataclass(slots=True, kw_only=True)
class _Running:
    """When a task began, how far it last said it was and when it said so [s, -, s]."""

    start: float
    fraction: float = 0.0
    told: float = 0.0


class RemainingTime:
    """Estimates the remaining wall time of a graph.

    A task is expected to take its own cost times what finished tasks of the same function took per unit of cost. Where
    none has finished, its cost is believed, corrected by what all finished ones took: as if tasks of one minute had
    taken just that besides, so that a single short task, which may have compiled first, says little of the rest. A
    running task that says how far it is, is expected to go on at its own pace. With the wall times W spent so far
    (finished and running tasks) in the time t, the work left takes ``t W_left / W``, and at the least what the longest
    single task left takes. This holds for any number of workers, which need not be known. Nothing is said before a
    twentieth of all work is done. A task that has run longer than expected is expected to take at least as long again
    as it is late: what is left is then a bound from below.

    Parameters
    ----------
    tasks : of the graph
    """

    def __init__(self, tasks: Sequence[Task]) -> None:
        self._tasks = {task.name: task for task in tasks}
        self._left = dict.fromkeys(self._tasks)
        self._running: dict[str, _Running] = {}
        self._walls: dict[str, float] = {}
        self._start: float | None = None

    def started(self, name: str, now: float) -> None:
        """A task begins, or begins again; ``now`` is any clock [s]."""
        self._start = now if self._start is None else self._start
        self._running[name] = _Running(start=now)

    def progressed(self, name: str, fraction: float, now: float) -> None:
        """A running task is this far [-]."""
        running = self._running[name]
        running.fraction, running.told = min(max(fraction, 0.0), 1.0), now

    def finished(self, name: str, wall_s: float, *, reused: bool) -> None:
        """A task ended well after ``wall_s`` [s]; one found in the store costs nothing and teaches nothing."""
        self.dropped(name)
        if not reused:
            self._walls[name] = wall_s

    def dropped(self, name: str) -> None:
        """A task failed: it is left no longer."""
        self._left.pop(name, None)
        self._running.pop(name, None)

    def left(self, now: float) -> Left | None:
        """Remaining time, None before enough has finished."""
        walls, running, names = dict(self._walls), dict(self._running), list(self._left)
        if not walls or self._start is None:
            return None
        each, late = list[float](), False
        for name in names:
            seconds = self._expected(name, walls)
            if name in running:
                seconds, is_late = _rest(running[name], seconds, now)
                late |= is_late
            each.append(seconds)
        spent = sum(walls.values()) + sum(now - one.start for one in running.values())
        if not each or spent <= 0.0:
            return Left(seconds=0.0) if not each else None
        if spent < _EVIDENCE * (spent + sum(each)):
            return None
        return Left(seconds=max((now - self._start) * sum(each) / spent, *each), at_least=late)

    def _expected(self, name: str, walls: dict[str, float]) -> float:
        """Expected wall time of a task [s]."""
        task = self._tasks[name]
        alike = [other for other in walls if self._tasks[other].function == task.function]
        known, believed = (alike, 0.0) if alike else (list(walls), _BELIEVED)
        took, cost = sum(walls[other] for other in known), sum(self._tasks[other].cost for other in known)
        return task.cost * (believed + took) / (believed + cost)


def _rest(running: _Running, expected: float, now: float) -> tuple[float, bool]:
    """Time that a running task still takes [s], and whether it is late."""
    spent = now - running.start
    if running.fraction >= _TELLING:
        expected = (running.told - running.start) / running.fraction
    return (expected - spent, False) if spent <= expected else (spent - expected, True)
