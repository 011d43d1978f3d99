"""The estimate of the remaining time: right for equal tasks on any number of workers, learns from what has finished."""

from __future__ import annotations

import pytest

from workbench.execution.remaining import RemainingTime
from workbench.execution.task import Task


def _tasks(count: int, function: str = "m:f", cost: float = 1.0) -> list[Task]:
    return [Task(name=f"{function}{i}", function=function, inputs={}, cost=cost) for i in range(count)]


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_equal_tasks_on_any_number_of_workers(workers: int) -> None:
    """20 tasks of 6 s each, 10 of them done: the other half takes as long again."""
    tasks = _tasks(20)
    remaining = RemainingTime(tasks)
    for i in range(10):
        remaining.started(tasks[i].name, 6.0 * (i // workers))
        remaining.finished(tasks[i].name, 6.0, reused=False)
    spent = 6.0 * 10 / workers
    assert remaining.seconds(spent) == pytest.approx(max(spent, 6.0))


def test_nothing_is_said_before_anything_has_finished() -> None:
    tasks = _tasks(3)
    remaining = RemainingTime(tasks)
    assert remaining.seconds(5.0) is None
    remaining.started(tasks[0].name, 0.0)
    remaining.progressed(tasks[0].name, 0.5)
    assert remaining.seconds(5.0) is None


def test_a_result_from_the_store_costs_and_teaches_nothing() -> None:
    tasks = _tasks(3)
    remaining = RemainingTime(tasks)
    remaining.finished(tasks[0].name, 1000.0, reused=True)
    assert remaining.seconds(0.0) is None
    remaining.started(tasks[1].name, 0.0)
    remaining.finished(tasks[1].name, 4.0, reused=False)
    assert remaining.seconds(4.0) == pytest.approx(4.0)


def test_running_tasks_count_as_far_as_they_came() -> None:
    """One of two is done in 10 s, the other is at 75 % after 17.5 s: 2.5 s are left."""
    tasks = _tasks(2)
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 10.0, reused=False)
    remaining.started(tasks[1].name, 10.0)
    remaining.progressed(tasks[1].name, 0.75)
    assert remaining.seconds(17.5) == pytest.approx(2.5)


def test_kinds_are_told_apart_by_function_and_unknown_ones_by_cost() -> None:
    """Short tasks (cost 1) took 2 s; the long one (cost 10) has not run: 20 s, never shared between workers."""
    short, long = _tasks(4), _tasks(1, "m:g", 10.0)
    remaining = RemainingTime([*short, *long])
    for i, task in enumerate(short):
        remaining.started(task.name, 0.5 * i)
        remaining.finished(task.name, 2.0, reused=False)
    assert remaining.seconds(2.0) == pytest.approx(20.0)


def test_failed_tasks_are_left_no_longer_and_the_end_is_zero() -> None:
    tasks = _tasks(3)
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 3.0, reused=False)
    remaining.dropped(tasks[1].name)
    assert remaining.seconds(3.0) == pytest.approx(3.0)
    remaining.dropped(tasks[2].name)
    assert remaining.seconds(3.0) == 0.0


def test_a_task_that_starts_again_begins_at_nothing() -> None:
    tasks = _tasks(2)
    remaining = RemainingTime(tasks)
    remaining.started(tasks[0].name, 0.0)
    remaining.finished(tasks[0].name, 10.0, reused=False)
    remaining.started(tasks[1].name, 10.0)
    remaining.progressed(tasks[1].name, 0.9)
    remaining.started(tasks[1].name, 19.0)
    assert remaining.seconds(19.0) == pytest.approx(19.0)
