"""Tasks of a wheel on soil: how its rim gives way, by the curves of one of its models.

Verified by tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.travels import WORKING_LOAD
from workbench.questions.wheel.graph import MESH, wheel_inputs
from workbench.study.full import require_level
from workbench.study.laws import require_elastic
from workbench.study.model import Study
from workbench.study.own_mesh import own_mesh

__all__ = ["CARCASS_MODELS", "carcass_name", "carcass_tasks"]

CARCASS_MODELS = ("fe", "ancf_wheel")


def carcass_name(model: str) -> str:
    """Of the task that finds how the rim gives way."""
    return f"carcass_{model}"


def carcass_tasks(study: Study, model: str) -> tuple[Task, ...]:
    """The curves at the study's orientations, with the wheel's shape near `WORKING_LOAD`, and the task that reads them.

    Raises
    ------
    InputError
        For a study whose wheel is a mesh from a file, does not stand on level ground, or can yield for good.
    """
    if own_mesh(study) is not None:
        raise InputError("mesh.file", "", "has no rim of known radius and lugs", "describe the wheel by its parts")
    require_level(study)
    require_elastic(study, "a wheel on soil, whose rim springs back")
    load, curves = _shown(study, model)
    solved = [(one.inputs["orientation_deg"], one.name) for one in curves if "orientation_deg" in one.inputs]
    find = Task(
        name=carcass_name(model),
        function="workbench.questions.soil.carcass_task:find",
        inputs={
            "model": model,
            "load": load,
            "wheel": wheel_inputs(study),
            "curves": solved,
            **({} if model == "fe" else {"options": curves[0].inputs["options"]}),
        },
        needs=(*((MESH,) if model == "fe" else ()), *(name for _, name in solved)),
        cost=2.0,
    )
    return (*curves, find)


def _shown(study: Study, model: str) -> tuple[float, Sequence[Task]]:
    """The load at which shapes are kept [N], and the curves' tasks that keep them: the report's own where they do."""
    tasks = stiffness_tasks(study, model, ())
    if model == "ancf_wheel":
        kept = [one if one.inputs["keep_points"] else _with(one, keep_points=True) for one in tasks]
        return WORKING_LOAD, kept
    loads = study.fe.snapshot_loads
    load = min(loads, key=lambda one: abs(one - WORKING_LOAD)) if loads else min(WORKING_LOAD, study.fe.max_load)
    return load, [one if loads or one.name == MESH else _with(one, snapshot_loads=[load]) for one in tasks]


def _with(task: Task, **inputs: object) -> Task:
    return replace(task, inputs={**task.inputs, **inputs})
