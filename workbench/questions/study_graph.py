"""From a study to the tasks that compute it. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Iterable

from workbench.execution.task import Task
from workbench.questions.fe.foresight import foreseen
from workbench.questions.registry import questions_of
from workbench.study.model import Study

__all__ = ["report_tasks"]


def report_tasks(study: Study) -> tuple[Task, ...]:
    """The tasks of every question of the report, each behind those it needs."""
    return foreseen(_in_order(task for question in questions_of(study) for task in question.tasks(study)))


def _in_order(tasks: Iterable[Task]) -> list[Task]:
    """The same tasks, each behind those it needs, else as they come; who runs them says it if one is nowhere."""
    waiting = {task.name: task for task in tasks}
    ordered: dict[str, Task] = {}

    def place(task: Task) -> None:
        if task.name not in ordered:
            for need in (waiting[name] for name in task.needs if name in waiting):
                place(need)
            ordered[task.name] = task

    for task in waiting.values():
        place(task)
    return list(ordered.values())
