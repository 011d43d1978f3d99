"""Wheels of others: what is published of them, what is left open, and the tasks that answer how far that matters.

Verified by tests/unit/test_workbench_validation.py.
"""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

from contracts.errors import InputError
from contracts.published import published_table
from workbench.execution.task import Task
from workbench.questions.fe.graph import fe_inputs, fe_task, without_fields
from workbench.questions.section.graph import section_task
from workbench.questions.wheel.graph import mesh_task
from workbench.study.model import Study
from workbench.study.reading import read_study_table, study_of

__all__ = ["COMMAND", "FACTORS", "NAME", "OpenInput", "PublishedWheel", "input_task", "published_wheels", "wheel_tasks"]

NAME, COMMAND = "validation", "make bench NAME=validation"
FACTORS = (1.0, 2.0, 3.0)
"""Counts of elements along strips and axle over those of the wheel's study; the finest mesh answers."""
_SHARES = (0.3, 0.5, 0.65, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5)
"""Deflections solved, over the largest published."""
_ORIENTATION = ["orientation"]


@dataclass(frozen=True, slots=True, kw_only=True)
class OpenInput:
    """A number that the publication leaves open.

    Attributes
    ----------
    what : its name
    key : its place in the study file, names and numbers in lists; ``["orientation"]`` is that of the run [deg]
    values : what it may be as well, as a study file has it
    source : where these values come from
    shown : how the page calls the values; without any, the values
    """

    what: str
    key: Sequence[str | int]
    values: Sequence[Any]
    source: str
    shown: Sequence[str] = ()

    @property
    def names(self) -> list[str]:
        """Of the values, for a reader."""
        return [str(value) for value in self.shown or self.values]


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedWheel:
    """One wheel.

    Attributes
    ----------
    name : in the published table
    study : file beside the built-in study
    title : for a heading
    orientation : of the published model [deg]
    inputs_by : model that tells what the inputs do: solid finite elements or the planar section model
    data : what is known of the uncertainty of the published number
    open : what the publication leaves open, in words
    inputs : what of that is a number
    data_range : smallest and largest published value of the last load [m], if any is given
    """

    name: str
    study: str
    title: str
    orientation: float
    inputs_by: Literal["fe", "section"]
    data: str
    open: Sequence[str]
    inputs: Sequence[OpenInput]
    data_range: tuple[float, float] | None = None

    @property
    def points(self) -> list[tuple[float, float]]:
        """Load [N] and published hub displacement [m], ascending."""
        table = published_table("flexible_wheels")
        rows = zip(table.text("wheel"), table["load_N"].tolist(), table["hub_displacement_m"].tolist(), strict=True)
        return [(load, displacement) for name, load, displacement in rows if name == self.name]

    @property
    def deflections(self) -> list[float]:
        """At which the wheel is solved [m]."""
        return [round(share * self.points[-1][1], 9) for share in _SHARES]


@cache
def published_wheels() -> tuple[PublishedWheel, ...]:
    """All of them."""
    content = tomllib.loads((Path(__file__).parent / "cases.toml").read_text(encoding="utf-8"))
    return tuple(_wheel(row) for row in content["wheel"])


def _wheel(row: Mapping[str, Any]) -> PublishedWheel:
    values = dict(row)
    inputs = [OpenInput(**one) for one in values.pop("inputs")]
    span = values.pop("data_range", None)
    return PublishedWheel(**values, inputs=inputs, data_range=None if span is None else (span[0], span[1]))


def wheel_tasks(wheel: PublishedWheel, path: Path) -> list[Task]:
    """The wheel on three meshes, then every open input at each of its values; ``path`` is its study's file.

    Names: ``solid_x{factor}``, ``inputs_nominal`` (section model alone) and `input_task`.
    """
    table = read_study_table(path)
    study, tasks = study_of(path, table), []
    for factor in FACTORS:
        tasks += _solid(wheel, study, f"solid_x{factor:g}", wheel.orientation, factor)
    if wheel.inputs_by == "section":
        tasks.append(section_task(study, "inputs_nominal", wheel.orientation, wheel.deflections))
    for i, one in enumerate(wheel.inputs):
        for k, value in enumerate(one.values):
            turned = list(one.key) == _ORIENTATION
            other = study if turned else study_of(path, _changed(table, one.key, value))
            orientation = float(value) if turned else wheel.orientation
            if wheel.inputs_by == "section":
                tasks.append(section_task(other, input_task(i, k), orientation, wheel.deflections))
            else:
                tasks += _solid(wheel, other, input_task(i, k), orientation, FACTORS[0])
    return tasks


def input_task(number: int, value: int) -> str:
    """Name of the task of an input's value, both counted from 0."""
    return f"input_{number}_{value}"


def _solid(wheel: PublishedWheel, study: Study, name: str, orientation: float, factor: float) -> list[Task]:
    mesh = mesh_task(study, f"mesh_{name}", factor=factor)
    inputs = without_fields(fe_inputs(study, orientation, wheel.deflections)) | {"max_load": wheel.points[-1][0]}
    return [mesh, fe_task(name, inputs, mesh.name)]


def _changed(table: Mapping[str, Any], key: Sequence[str | int], value: Any) -> dict[str, Any]:
    """A study file's table with another value at a place that it has; InputError for one that it does not have."""
    changed: dict[str, Any] = copy.deepcopy(dict(table))
    place: Any = changed
    for part in key[:-1]:
        place = place[part]
    if isinstance(place, dict) and key[-1] not in place:
        raise InputError("validation case", str(list(key)), "is not in the study file", "name a key that it has")
    place[key[-1]] = value
    return changed
