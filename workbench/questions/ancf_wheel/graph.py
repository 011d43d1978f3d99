"""Tasks of the ANCF wheel. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from workbench.execution.task import Task
from workbench.questions.fe.graph import INNER_STIFFNESS, curve_deflections
from workbench.questions.wheel.graph import wheel_inputs
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees, orientation_name

__all__ = ["ancf_wheel_tasks", "every_second"]


def every_second(deflections: Sequence[float]) -> list[float]:
    """Every second of the solid curves' points, the last one among them."""
    return list(deflections[::-1][::2][::-1])


def ancf_wheel_tasks(study: Study) -> list[Task]:
    """One task an orientation of the FE runs, ``ancf_wheel_phi015``; the shapes where the solid keeps its points."""
    section = stated(study.ancf_wheel, "ancf_wheel")
    shared = {
        "wheel": wheel_inputs(study),
        "options": {
            "element_size": section.element_size,
            "axial_size": section.axial_size,
            "half_width": study.mesh.half_width,
        },
        "deflections": every_second(curve_deflections(study)),
        "max_load": study.fe.max_load,
        "keep_points": study.fe.keep_points,
        "contact_stiffness": study.fe.contact_stiffness,
        "inner_contact_stiffness": INNER_STIFFNESS if study.fe.inner_contact else 0.0,
    }
    function = "workbench.questions.ancf_wheel.task:solve_orientation"
    curves = [
        Task(
            name=orientation_name("ancf_wheel", o),
            function=function,
            inputs={**shared, "orientation_deg": o},
            cost=25.0,
        )
        for o in map(degrees, study.fe.orientations)
    ]
    return [*curves, _shape_task(study, shared)] if study.fe.keep_points else curves


def _shape_task(study: Study, shared: Mapping[str, Any]) -> Task:
    names = [
        (degrees(o), orientation_name("ancf_wheel", degrees(o)), orientation_name("fe", degrees(o)))
        for o in study.fe.orientations
    ]
    return Task(
        name="ancf_wheel_shape",
        function="workbench.questions.ancf_wheel.shape_task:compare_shapes",
        inputs={"wheel": shared["wheel"], "options": shared["options"], "mesh": "mesh", "pairs": names},
        needs=("mesh", *(name for row in names for name in row[1:])),
        cost=15.0,
    )
