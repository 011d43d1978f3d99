"""Tasks of the brush line and of the distances between curves. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from workbench.execution.task import Task
from workbench.study.curve_file import in_si
from workbench.study.full import around
from workbench.study.model import Study, stated
from workbench.study.model_parameters import brush_parameters
from workbench.study.orientation import degrees, orientation_name

__all__ = ["brush_task", "metrics_task"]

_COMPARED_UP_TO = 250.0
"""End of the load range over which the models are compared [N]: the upper wheel load of the thesis' sweep."""


def brush_task(study: Study) -> Task:
    """The brush tire's line, as far as any other curve goes."""
    stated(study.brush, "brush")
    end = max([study.fe.max_deflection, *([study.ancf.max_deflection] if study.ancf is not None else [])])
    inputs = {"radial_stiffness": brush_parameters(study).radial_stiffness, "max_deflection": end}
    return Task(name="brush", function="workbench.questions.models.brush_task:solve", inputs=inputs)


def metrics_task(study: Study) -> Task:
    """Distances between curves; the text of the reference's curves is part of the inputs, their labels are not."""
    users = [
        {
            "orientation": None if section.orientation is None else degrees(section.orientation),
            "text": in_si(Path(section.file)),
        }
        for section in study.reference_curves
    ]
    curves = [orientation_name("fe", degrees(o)) for o in study.fe.orientations]
    if study.ancf is not None:
        curves += [orientation_name("ancf", degrees(o)) for o in study.ancf.orientations]
    curves += [] if study.brush is None else ["brush"]
    inputs = {"max_load": _COMPARED_UP_TO, "user_curves": users, "around": asdict(around(study))}
    function = "workbench.questions.models.metrics_task:measure"
    return Task(name="metrics", function=function, inputs=inputs, needs=tuple(curves), cost=8.0)
