"""Tasks of the planar section model. Verified by tests/unit/test_workbench_section.py."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.fe.graph import curve_deflections, fe_inputs, without_fields
from workbench.questions.wheel.graph import wheel_inputs
from workbench.study.laws import other_law
from workbench.study.model import Study
from workbench.study.orientation import degrees, orientation_name
from workbench.study.own_mesh import sized_mesh, without_wheel

__all__ = ["section_task", "section_tasks", "without_planar_model"]


def without_planar_model(study: Study) -> InputError | None:
    """Why a study's wheel has no planar model here; None if it has one."""
    if study.fe.turned:
        return InputError(
            "fe.camber or yaw", "not 0", "turns the ground out of the section plane", "use the solid model alone"
        )
    if (reason := without_wheel(study, "the section model")) is not None:
        return reason
    if study.parametric.sidewall_springs is not None:
        rule = "bend out of the plane of a section model"
        return InputError("wheel.sidewall_springs", "given", rule, "use the solid model alone")
    if (other := other_law(study)) is not None:
        return InputError(*other, "has no planar form", "use st_venant_kirchhoff, or the solid model alone")
    return None


def section_tasks(study: Study, orientations_deg: Sequence[float] = ()) -> list[Task]:
    """One task an orientation, ``section_phi015``; no orientation means those of the study's FE runs.

    Raises
    ------
    InputError
        If the wheel has no planar model.
    """
    if (reason := without_planar_model(study)) is not None:
        raise reason
    wanted = orientations_deg or [degrees(o) for o in study.fe.orientations]
    points = curve_deflections(study)
    return [section_task(study, orientation_name("section", o), o, points) for o in wanted]


def section_task(study: Study, name: str, orientation_deg: float, deflections: Sequence[float]) -> Task:
    """The planar model at one orientation, meshed as finely along the strips as the study's solid mesh."""
    mesh = sized_mesh(study)
    options: dict[str, Any] = {
        "element_size": mesh.element_size,
        "thickness_elements": mesh.thickness_elements,
        "order": mesh.order,
        "refinement": dict(mesh.refinement),
        "factor": mesh.factor,
    }
    inputs = without_fields(fe_inputs(study, orientation_deg, deflections)) | {
        "wheel": wheel_inputs(study),
        "options": options,
        "rigid_parts": ["outer_hub"],
    }
    return Task(name=name, function="workbench.questions.section.task:solve_orientation", inputs=inputs, cost=8.0)
