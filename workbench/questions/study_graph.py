"""From a study to the tasks that compute it. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from workbench.execution.task import Task
from workbench.questions.ancf.question import ancf_curve_tasks
from workbench.questions.ancf_wheel.graph import ancf_wheel_curve_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import fe_curve_tasks
from workbench.questions.models.graph import brush_task
from workbench.questions.registry import questions_of
from workbench.questions.section.graph import section_tasks
from workbench.questions.wheel.graph import MESH, MESH_WHOLE, wheel_meshes
from workbench.study.model import Study

__all__ = ["MODELS", "mesh_tasks", "report_tasks", "stiffness_tasks"]

MODELS = ("fe", "section", "ancf_wheel", "ancf", "brush")


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


def mesh_tasks(study: Study, with_files: bool = False) -> tuple[Task, ...]:
    """Both meshes of the wheel, and if asked for their files."""
    meshes = wheel_meshes(study)
    if not with_files:
        return foreseen(meshes)
    files = Task(
        name="mesh_files",
        function="workbench.questions.wheel.mesh_files:write_files",
        inputs={"wheel": study.model_dump(mode="json", include={"name", "wheel", "materials"})},
        needs=(MESH, MESH_WHOLE),
    )
    return foreseen((*meshes, files))


def stiffness_tasks(study: Study, model: str, orientations_deg: Sequence[float]) -> tuple[Task, ...]:
    """Curves of one of the `MODELS`; no orientation means those of the study."""
    if model == "fe":
        return foreseen((wheel_meshes(study)[0], *fe_curve_tasks(study, orientations_deg)))
    if model == "section":
        return foreseen(section_tasks(study, orientations_deg))
    if model == "ancf_wheel":
        return tuple(ancf_wheel_curve_tasks(study, orientations_deg))
    if model == "ancf":
        return tuple(ancf_curve_tasks(study, orientations_deg))
    return (brush_task(study),)
