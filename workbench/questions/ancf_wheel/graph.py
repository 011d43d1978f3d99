"""Tasks of the ANCF wheel. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.fe.graph import INNER_STIFFNESS, curve_deflections
from workbench.questions.wheel.graph import wheel_inputs
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees, orientation_name
from workbench.study.own_mesh import sized_mesh
from workbench.study.sections import AncfWheelSection

__all__ = ["ancf_wheel_curve_tasks", "ancf_wheel_tasks", "every_second", "require_ancf_wheel"]


_SPACING = {True: 1.5e-3, False: 0.5e-3}
"""Of points that may touch the ground, whether it is flat [m]: half of it moves the load on a 20 mm rock by 0.03 %."""


def every_second(deflections: Sequence[float]) -> list[float]:
    """Every second of the solid curves' points, the last one among them."""
    return list(deflections[::-1][::2][::-1])


def ancf_wheel_tasks(study: Study) -> list[Task]:
    """One task an orientation of the FE runs, ``ancf_wheel_phi015``; the shapes where the solid keeps its points.

    And has nodes half way through its strips, as linear cells in odd number have not.
    """
    section = stated(study.ancf_wheel, "ancf_wheel")
    curves = _curve_tasks(study, section, [degrees(o) for o in study.fe.orientations])
    mesh = sized_mesh(study)
    middle = mesh.order == 2 or mesh.thickness_elements % 2 == 0
    return [*curves, _shape_task(study, curves[0].inputs)] if study.fe.keep_points and middle else curves


def ancf_wheel_curve_tasks(study: Study, orientations_deg: Sequence[float] = ()) -> list[Task]:
    """A curve at each orientation [deg]; none means those of the FE runs. Without the section its defaults hold.

    Raises
    ------
    InputError
        If the study has what the model has not.
    """
    require_ancf_wheel(study)
    asked = orientations_deg or [degrees(o) for o in study.fe.orientations]
    return _curve_tasks(study, study.ancf_wheel or AncfWheelSection(), asked)


def require_ancf_wheel(study: Study) -> None:
    """Raise InputError for a study with what the ANCF model of its wheel has not."""
    if (lacking := without_ancf_wheel(study)) is not None:
        rule = "is not in the ANCF model of the wheel"
        raise InputError(lacking, "", rule, "take it out of the study, or ask for another model")


def _curve_tasks(study: Study, section: AncfWheelSection, orientations_deg: Sequence[float]) -> list[Task]:
    points = curve_deflections(study)
    shared = {
        "wheel": wheel_inputs(study),
        "options": {
            "element_size": section.element_size,
            "axial_size": section.axial_size,
            "half_width": sized_mesh(study).half_width,
            "ground_spacing": _SPACING[study.fe.obstacle.shape == "plane"],
            **({} if study.fe.hub == "rigid" else {"hub": study.fe.hub}),
        },
        # Friction depends on the way, and so on the steps.
        "deflections": points if study.fe.friction else every_second(points),
        "friction": study.fe.friction,
        "max_load": study.fe.max_load,
        "keep_points": study.fe.keep_points,
        "contact_stiffness": study.fe.contact_stiffness,
        "obstacle": study.fe.obstacle.model_dump(mode="json"),
        "camber_deg": degrees(study.fe.camber),
        "inner_contact_stiffness": INNER_STIFFNESS if study.fe.inner_contact else 0.0,
    }
    function = "workbench.questions.ancf_wheel.task:solve_orientation"
    return [
        Task(
            name=orientation_name("ancf_wheel", o),
            function=function,
            inputs={**shared, "orientation_deg": o},
            cost=25.0,
        )
        for o in orientations_deg
    ]


def _shape_task(study: Study, shared: Mapping[str, Any]) -> Task:
    given = {name: shared[name] for name in ("wheel", "options", "inner_contact_stiffness")}
    names = [
        (degrees(o), orientation_name("ancf_wheel", degrees(o)), orientation_name("fe", degrees(o)))
        for o in study.fe.orientations
    ]
    return Task(
        name="ancf_wheel_shape",
        function="workbench.questions.ancf_wheel.shape_task:compare_shapes",
        inputs=given | {"mesh": "mesh", "pairs": names},
        needs=("mesh", *(name for row in names for name in row[1:])),
        cost=15.0,
    )
