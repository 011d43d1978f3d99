"""From a study to the tasks that compute it. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from workbench.checks.preset_table import preset_table
from workbench.execution.task import Task
from workbench.graph.fe import curve_deflections, fe_inputs, fe_task, mesh_task
from workbench.graph.foresight import foreseen
from workbench.graph.section import section_tasks
from workbench.graph.surfaces import report_surfaces_task
from workbench.study.curve_file import in_si
from workbench.study.model import Study, stated
from workbench.study.model_parameters import ancf_tire, brush_parameters
from workbench.study.sections import AncfSection
from workbench.study.wheel_design import wheel_design
from workbench.tasks.orientation import degrees, orientation_name
from workbench.topics.registry import topics_of

__all__ = ["MODELS", "Model", "degrees", "mesh_tasks", "orientation_name", "report_tasks", "stiffness_tasks"]

type Model = str
"""One of `MODELS`."""
MODELS = ("fe", "section", "ancf", "brush")


_COMPARED_UP_TO = 250.0
"""End of the load range over which the models are compared [N]: the upper wheel load of the thesis' sweep."""


def report_tasks(study: Study, curve_folder: Path) -> tuple[Task, ...]:
    """Everything the report shows. ``curve_folder`` is where the study's own curve files lie."""
    fe = tuple(degrees(o) for o in study.fe.orientations)
    tasks = [*mesh_tasks(study), *_fe_tasks(study, fe)]
    if study.ancf is not None:
        tasks += [*_ancf_tasks(study, study.ancf, ()), report_surfaces_task(study)]
    if study.brush is not None:
        tasks.append(_brush_task(study))
    tasks += [task for topic in topics_of(study) for task in topic.tasks(study)]
    curves = [t.name for t in tasks if t.name.startswith(("fe_phi", "ancf_phi")) or t.name == "brush"]
    tasks.append(_metrics_task(study, curves, curve_folder))
    tasks.append(_picture_task(study, fe))
    return foreseen(tasks)


def mesh_tasks(study: Study, with_files: bool = False) -> tuple[Task, ...]:
    """The mesh that is solved, and the whole wheel with every part for the picture and the mass; their files."""
    whole = mesh_task(study, "mesh_whole", {"parts": "all", "half_width": False}, factor=1.0)
    solved = mesh_task(study, "mesh")
    if not with_files:
        return foreseen((solved, whole))
    files = Task(
        name="mesh_files",
        function="workbench.tasks.mesh_files:write_files",
        inputs={"wheel": study.model_dump(mode="json", include={"name", "wheel", "materials"})},
        needs=("mesh", "mesh_whole"),
    )
    return foreseen((solved, whole, files))


def stiffness_tasks(study: Study, model: Model, orientations_deg: Sequence[float]) -> tuple[Task, ...]:
    """Curves of one model; no orientation means those of the study."""
    if model == "fe":
        wanted = orientations_deg or [degrees(o) for o in study.fe.orientations]
        return foreseen((mesh_task(study, "mesh"), *_fe_tasks(study, wanted)))
    if model == "section":
        return foreseen(section_tasks(study, orientations_deg))
    if model == "ancf":
        return tuple(_ancf_tasks(study, stated(study.ancf, "ancf"), orientations_deg))
    stated(study.brush, "brush")
    return (_brush_task(study),)


def _fe_tasks(study: Study, orientations_deg: Sequence[float]) -> list[Task]:
    points = curve_deflections(study)
    return [fe_task(orientation_name("fe", o), fe_inputs(study, o, points)) for o in orientations_deg]


def _ancf_tasks(study: Study, ancf: AncfSection, orientations_deg: Sequence[float]) -> list[Task]:
    """Curves of the ANCF tire; no orientation means those of the study."""
    grid = np.linspace(0.0, ancf.max_deflection, ancf.points + 1).round(12).tolist()
    points = sorted({*grid, *_table_deflections(ancf)})
    tire = ancf_tire(study)
    return [
        Task(
            name=orientation_name("ancf", orientation),
            function="workbench.tasks.ancf:solve_orientation",
            inputs=tire | {"orientation_deg": orientation, "deflections": points},
            cost=10.0,
        )
        for orientation in orientations_deg or [degrees(o) for o in ancf.orientations]
    ]


def _table_deflections(ancf: AncfSection) -> list[float]:
    """Deflections of the preset's table [m] that the study reaches, solved themselves and never interpolated."""
    if not ancf.thesis_preset:
        return []
    return [d for d in preset_table()[:, 0].round(12).tolist() if d <= ancf.max_deflection]


def _brush_task(study: Study) -> Task:
    end = max([study.fe.max_deflection, *([study.ancf.max_deflection] if study.ancf is not None else [])])
    inputs = {"radial_stiffness": brush_parameters(study).radial_stiffness, "max_deflection": end}
    return Task(name="brush", function="workbench.tasks.brush:solve", inputs=inputs)


def _metrics_task(study: Study, curves: Sequence[str], curve_folder: Path) -> Task:
    """Distances between curves; the text of the user's own curves is part of the inputs, their labels are not."""
    users = [
        {
            "orientation": None if section.orientation is None else degrees(section.orientation),
            "text": in_si(curve_folder / section.file),
        }
        for section in study.compare.curves
    ]
    inputs = {"max_load": _COMPARED_UP_TO, "user_curves": users}
    function = "workbench.tasks.metrics:measure"
    return Task(name="metrics", function=function, inputs=inputs, needs=tuple(curves), cost=8.0)


def _picture_task(study: Study, orientations_deg: Sequence[float]) -> Task:
    first = orientation_name("fe", orientations_deg[0])
    strength = min(material.yield_strength for material in wheel_design(study).materials.values())
    return Task(
        name="pictures",
        function="workbench.tasks.pictures:draw",
        inputs={"orientation_deg": orientations_deg[0], "yield_strength": strength},
        needs=("mesh_whole", "mesh", first),
        cost=10.0,
    )
