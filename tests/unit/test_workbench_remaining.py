"""The estimate of the remaining time: right for equal tasks on any number of workers, learns from what has finished."""

from __future__ import annotations

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
    """Short tasks (cost 1) took 2 s; the long one (cost 10) has not run: 20 s, never shared between workers."""
    short, long = _tasks(4), _tasks(1, "m:g", 10.0)
    remaining = RemainingTime([*short, *long])
    for i, task in enumerate(short):
        remaining.started(task.name, 0.5 * i)
        remaining.finished(task.name, 2.0, reused=False)
    assert seconds(remaining, 2.0) == pytest.approx(20.0)


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
