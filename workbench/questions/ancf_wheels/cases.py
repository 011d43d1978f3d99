"""Wheels on which the ANCF model is held against the solid one, and the tasks that compute both.

Verified by tests/unit/test_workbench_ancf_wheels.py.
"""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from contracts.hub_travel import OVER_GROUND
from workbench.execution.task import Task
from workbench.questions.ancf_wheel.graph import ancf_wheel_curve_tasks, every_second
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import curve_deflections, fe_curve_tasks, fe_inputs, fe_task, without_fields
from workbench.questions.travels import WORKING_LOAD, travel_tasks
from workbench.questions.wheel.graph import MESH, mesh_task
from workbench.study.model import Study
from workbench.study.own_mesh import sized_mesh
from workbench.study.reading import read_study_table, study_of

__all__ = ["COMMAND", "FINER", "ComparedWheel", "compared_wheels", "wheel_tasks"]

COMMAND = "make bench NAME=ancf_wheels"
FINER = 2.0
"""Counts of plates, and of the solid's elements, along strips and axle on the finer meshes, over those of the study."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedWheel:
    """One wheel.

    Attributes
    ----------
    name : of its check and its record
    title : for the page
    study : file beside the built-in study
    orientations : at which both models are computed [deg]
    fine : the one of them at which both are computed on finer meshes too [deg]
    springs : what the study's first spring set has instead
    moved : orientations at which both models' hub is moved over the ground, every way [deg]
    """

    name: str
    title: str
    study: str
    orientations: Sequence[float]
    fine: float
    springs: Mapping[str, Any] = field(default_factory=dict)
    moved: Sequence[float] = ()

    @property
    def record(self) -> str:
        """Name of what is kept beside the study's file."""
        return f"ancf_wheel_{self.name}"

    def read(self, path: Path) -> Study:
        """The wheel's study, from its file."""
        table: dict[str, Any] = copy.deepcopy(dict(read_study_table(path)))
        if self.springs:
            table["wheel"]["springs"][0] |= self.springs
        return study_of(path, table)


@cache
def compared_wheels() -> tuple[ComparedWheel, ...]:
    """All of them."""
    content = tomllib.loads((Path(__file__).parent / "wheels.toml").read_text(encoding="utf-8"))
    return tuple(ComparedWheel(**row) for row in content["wheel"])


def wheel_tasks(wheel: ComparedWheel, study: Study) -> list[Task]:
    """Curves of both models at every orientation, named as the report's, ``fe_fine``, ``ancf_wheel_fine``, travels."""
    curves = fe_curve_tasks(study, wheel.orientations)
    mesh = mesh_task(study, "mesh_fine", factor=FINER * sized_mesh(study).factor)
    points = curve_deflections(study)
    inputs = fe_inputs(study, wheel.fine, points if study.fe.friction else every_second(points))  # as the plates' own
    solid = [mesh_task(study, MESH), *curves, mesh, fe_task("fe_fine", without_fields(inputs), mesh.name)]
    plates = ancf_wheel_curve_tasks(study, wheel.orientations)
    (one,) = (task for task in plates if task.inputs["orientation_deg"] == wheel.fine)
    options = {**one.inputs["options"], "factor": FINER}
    finer = replace(one, name="ancf_wheel_fine", inputs={**one.inputs, "options": options, "keep_points": False})
    tasks = {task.name: task for task in (*foreseen(solid), *plates, finer)}
    for model in ("fe", "ancf_wheel") if wheel.moved else ():
        tasks |= {task.name: task for task in travel_tasks(study, model, OVER_GROUND, WORKING_LOAD, wheel.moved)}
    return list(tasks.values())
