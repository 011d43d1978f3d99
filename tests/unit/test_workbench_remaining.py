"""The estimate of the remaining time: right for equal tasks on any number of workers, learns from what has finished."""

from __future__ import annotations

import csv
import heapq
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from workbench.execution.remaining import RemainingTime
from workbench.execution.task import Task


def _tasks(count: int, function: str = "m:f", cost: float = 1.0) -> list[Task]:
    return [Task(name=f"{function}{i}", function=function, inputs={}, cost=cost) for i in range(count)]


def seconds(remaining: RemainingTime, now: float) -> float:
    left = remaining.left(now)
    assert left is not None
    return left.seconds


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_equal_tasks_on_any_number_of_workers(workers: int) -> None:
    """20 tasks of 6 s each, 10 of them done: the other half takes as long again."""
    tasks = _tasks(20)
    remaining = RemainingTime(tasks)
    for i in range(10):
        remaining.started(tasks[i].name, 6.0 * (i // workers))
        remaining.finished(tasks[i].name, 6.0, reused=False)
    spent = 6.0 * 10 / workers
    assert seconds(remaining, spent) == pytest.approx(max(spent, 6.0))


def test_nothing_is_said_before_anything_has_finished() -> None:
    tasks = _tasks(3)
    remaining = RemainingTime(tasks)
    assert remaining.left(5.0) is None
    remaining.started(tasks[0].name, 0.0)
    remaining.progressed(tasks[0].name, 0.5, 5.0)
    assert remaining.left(5.0) is None


def test_a_result_from_the_store_costs_and_teaches_nothing() -> None:
    tasks = _tasks(3)
    remaining = RemainingTime(tasks)
    remaining.finished(tasks[0].name, 1000.0, reused=True)
    assert remaining.left(0.0) is None
    remaining.started(tasks[1].name, 0.0)
    remaining.finished(tasks[1].name, 4.0, reused=False)
    assert seconds(remaining, 4.0) == pytest.approx(4.0)


def test_running_tasks_count_as_far_as_they_came() -> None:
    """One of two is done in 10 s, the other is at 75 % after 17.5 s: 2.5 s are left."""
    tasks = _tasks(2)
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 10.0, reused=False)
    remaining.started(tasks[1].name, 10.0)
    remaining.progressed(tasks[1].name, 0.75, 17.5)
    assert seconds(remaining, 17.5) == pytest.approx(2.5)


def test_kinds_are_told_apart_by_function_and_unknown_ones_by_cost() -> None:
    """Short tasks (cost 1) took 2 s; the long one (cost 10) has not run: its cost is believed, and a little more."""
    short, long = _tasks(4), _tasks(1, "m:g", 10.0)
    remaining = RemainingTime([*short, *long])
    for i, task in enumerate(short):
        remaining.started(task.name, 0.5 * i)
        remaining.finished(task.name, 2.0, reused=False)
    assert seconds(remaining, 2.0) == pytest.approx(10.0 * (60.0 + 8.0) / (60.0 + 4.0))


def test_failed_tasks_are_left_no_longer_and_the_end_is_zero() -> None:
    tasks = _tasks(3)
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 3.0, reused=False)
    remaining.dropped(tasks[1].name)
    assert seconds(remaining, 3.0) == pytest.approx(3.0)
    remaining.dropped(tasks[2].name)
    assert seconds(remaining, 3.0) == 0.0


def test_a_task_that_starts_again_begins_at_nothing() -> None:
    tasks = _tasks(2)
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 10.0, reused=False)
    remaining.started(tasks[1].name, 10.0)
    remaining.progressed(tasks[1].name, 0.9, 18.9)
    remaining.started(tasks[1].name, 19.0)
    assert seconds(remaining, 19.0) == pytest.approx(19.0)


def test_many_tasks_that_took_longer_are_believed_of_other_kinds() -> None:
    """An hour of work at three times its cost: what has not run is expected to take nearly three times its own."""
    done, other = _tasks(60, "m:f", 20.0), _tasks(1, "m:g", 100.0)
    remaining = RemainingTime([*done, *other])
    for i, task in enumerate(done):
        remaining.started(task.name, 60.0 * i)
        remaining.finished(task.name, 60.0, reused=False)
    assert seconds(remaining, 3600.0) == pytest.approx(300.0, rel=0.05)


def test_nothing_is_said_before_a_twentieth_of_the_work_is_done() -> None:
    tasks = [*_tasks(1, "mesh", 3.0), *_tasks(9, "solve", 30.0)]
    remaining = RemainingTime(tasks)
    remaining.started("mesh0", 0.0)
    remaining.finished("mesh0", 4.9, reused=False)
    assert remaining.left(4.9) is None
    remaining.started("solve0", 4.9)
    assert remaining.left(25.0) is not None


def _recorded() -> list[tuple[Task, float]]:
    """Tasks of the built-in study's report from an empty store, in the order in which they finished, and times [s]."""
    with (Path(__file__).parents[1] / "data" / "recorded_report.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [
        (Task(name=row["name"], function=row["function"], inputs={}, cost=float(row["cost_s"])), float(row["wall_s"]))
        for row in rows
    ]


def _told(run: list[tuple[Task, float]], workers: int) -> list[tuple[float, float]]:
    """(share of the time gone, what was said over what was left) whenever a task finished and something was said."""
    remaining, free, events = RemainingTime([task for task, _ in run]), [0.0] * workers, []
    for task, wall in run:
        start = heapq.heappop(free)
        events += [(start, 1, task.name, wall), (start + wall, 0, task.name, wall)]
        heapq.heappush(free, start + wall)
    found, end = [], max(now for now, *_ in events)
    for now, begins, name, wall in sorted(events):
        if begins:
            remaining.started(name, now)
            continue
        remaining.finished(name, wall, reused=False)
        left = remaining.left(now)
        if left is not None and now < end:
            found.append((now / end, left.seconds / (end - now)))
    return found


@pytest.mark.parametrize("workers", [2, 1])
def test_what_is_said_of_a_recorded_run_is_honest(workers: int) -> None:
    """Within a factor of two for nine tenths of the time, on two workers, as it ran, and on one.

    What was said before finished tasks of other functions were weighed began at 33 minutes, of 13.
    """
    told = _told(_recorded(), workers)
    assert 0.03 < told[0][0] < 0.12
    factors = np.array([factor for share, factor in told if share < 0.9])
    assert len(factors) > 100
    assert factors.min() > 0.5
    assert factors.max() < 2.0


def test_a_recorded_run_without_foretold_costs_is_misjudged() -> None:
    """Negative control: were all tasks alike, what is said would be off by more than that."""
    alike = [(replace(task, cost=1.0), wall) for task, wall in _recorded()]
    factors = [factor for share, factor in _told(alike, 2) if share < 0.9]
    assert max(factors) > 2.0 or min(factors) < 0.5


def _after_a_mesh(cost: float) -> RemainingTime:
    """A mesh of cost 5 took 5 s; what is solved on it, of this cost, began then."""
    tasks = [*_tasks(1, "mesh", 5.0), *_tasks(1, "solve", cost)]
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 5.0, reused=False)
    remaining.started(tasks[1].name, 5.0)
    return remaining


def test_a_silent_task_is_never_said_to_be_all_but_done() -> None:
    """Expected to take 60 s, silent for an hour: as time goes by, what is left shrinks, then grows, and says so."""
    remaining = _after_a_mesh(60.0)
    found = [remaining.left(5.0 + t) for t in (0.0, 30.0, 59.0, 120.0, 600.0, 3600.0)]
    assert [left.seconds for left in found if left] == pytest.approx([60.0, 30.0, 1.0, 60.0, 540.0, 3540.0])
    assert [left.at_least for left in found if left] == [False, False, False, True, True, True]


def test_a_running_task_goes_on_at_its_own_pace() -> None:
    """Expected to take 60 s, at 10 % after 100 s: 900 s are left, and 800 s when another 100 s have gone silently."""
    remaining = _after_a_mesh(60.0)
    remaining.progressed("solve0", 0.1, 105.0)
    assert seconds(remaining, 105.0) == pytest.approx(900.0)
    assert seconds(remaining, 205.0) == pytest.approx(800.0)
    late = remaining.left(1405.0)
    assert late is not None
    assert late.at_least


def test_tasks_of_one_function_differ_by_their_cost() -> None:
    """A mesh twice as fine costs eight times as much: the 10 s of the coarse one's solve say 80 s for it."""
    tasks = [*_tasks(1, "solve", 10.0), Task(name="fine", function="solve", inputs={}, cost=80.0)]
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 10.0, reused=False)
    assert seconds(remaining, 10.0) == pytest.approx(80.0)
