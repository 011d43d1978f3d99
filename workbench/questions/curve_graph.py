"""Tasks of a study's meshes and curves. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Sequence

from workbench.execution.task import Task
from workbench.questions.ancf.question import ancf_curve_tasks
from workbench.questions.ancf_wheel.graph import ancf_wheel_curve_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import fe_curve_tasks
from workbench.questions.models.graph import brush_task
from workbench.questions.section.graph import section_tasks
from workbench.questions.wheel.graph import MESH, MESH_WHOLE, own_mesh_tasks, wheel_meshes
from workbench.study.model import Study
from workbench.study.own_mesh import own_mesh

__all__ = ["MODELS", "mesh_tasks", "stiffness_tasks"]

MODELS = ("fe", "section", "ancf_wheel", "ancf", "brush")


def mesh_tasks(study: Study, with_files: bool = False) -> tuple[Task, ...]:
    """Both meshes of the wheel, and if asked for their files."""
    if own_mesh(study) is not None:
        return foreseen(own_mesh_tasks(study, with_files=with_files))
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
