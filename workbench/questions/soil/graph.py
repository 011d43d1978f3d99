"""Tasks of a wheel on soil: how its rim gives way, the bench, and the wheel at rest by its two models.

Verified by tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from rover_dynamics.rover.planets import gravity_named
from soil.soil import Soil, with_ends_of_ranges
from soil.steady_wheel import WheelOnSoil, steady_wheel
from workbench.execution.task import Task
from workbench.questions.ancf_wheel.graph import ancf_wheel_curve_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import fe_curve_tasks, fe_inputs, fe_task, without_end, without_fields
from workbench.questions.soil.bench import wheel_on_soil
from workbench.questions.travels import WORKING_LOAD
from workbench.questions.wheel.graph import MESH, coarse_across, mesh_task, wheel_inputs, wheel_meshes
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.model import Study, stated
from workbench.study.off_soil import without_soil
from workbench.study.soil_file import soil_of
from workbench.study.wheel_design import wheel_design

__all__ = [
    "AT_REST",
    "BENCH",
    "CARCASS_MODELS",
    "MEASURED",
    "SLIPS",
    "at_rest_orientation",
    "carcass_name",
    "carcass_tasks",
    "pressed_tasks",
    "soil_tasks",
    "soils_of",
]

CARCASS_MODELS = ("fe", "ancf_wheel")
BENCH, MEASURED, MESH_SOIL = "soil_bench", "soil_measured", "mesh_soil"
AT_REST = {"fe": "soil_fe", "ancf_wheel": "soil_ancf_wheel"}
SLIPS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
_STEPS = 4
"""Points of the wheel at rest, the last at its largest deflection."""


def carcass_name(model: str) -> str:
    """Of the task that finds how the rim gives way."""
    return f"carcass_{model}"


def soils_of(study: Study) -> tuple[Soil, ...]:
    """The soils of [soil]; files lie beside the study's.

    Raises
    ------
    InputError
        As `workbench.study.soil_file.soil_of`, and for two of one name.
    """
    folder = Path() if study.kept is None else study.kept.parent
    found = tuple(soil_of(name, folder) for name in stated(study.soil, "soil").soils)
    for name, count in Counter(one.name for one in found).items():
        if count > 1:
            raise InputError("soil.soils", name, "is the name of two of them", "leave one out, or rename its file")
    return found


def soil_tasks(study: Study) -> list[Task]:
    """What the report asks of a study with [soil]; InputError for a soil that buries the rigid wheel at some slip."""
    section, soils = stated(study.soil, "soil"), soils_of(study)
    wheel, gravity = wheel_on_soil(wheel_design(study)), gravity_named("mars")
    for one in (end for soil in soils for end in with_ends_of_ranges(soil)):
        _driven_once(wheel, one, section.load, gravity)
    bench = Task(
        name=BENCH,
        function="workbench.questions.soil.bench_task:drive",
        inputs={
            "wheel": wheel_inputs(study),
            "soils": [asdict(one) for one in soils],
            "load": section.load,
            "slips": list(SLIPS),
            "gravity": gravity,
            "carcass": carcass_name("fe"),
        },
        needs=(carcass_name("fe"),),
        cost=15.0,
    )
    held = Task(name=MEASURED, function="workbench.questions.soil.bench_task:hold", inputs={}, cost=2.0)
    return [_carcass(study, "fe", *_shown(study, "fe")), bench, held, *_at_rest(study, soils[0])]


@lru_cache(maxsize=128)
def _driven_once(wheel: WheelOnSoil, soil: Soil, load: float, gravity: float) -> None:
    """Kept, as a study is planned again and again."""
    steady_wheel(wheel, soil, load, SLIPS[-1], gravity)


def at_rest_orientation(study: Study) -> float:
    """What faces the ground of the wheel at rest [deg]: half way between two grousers, where it has any."""
    lugs = wheel_design(study).grousers
    return 0.0 if lugs is None else round(math.degrees(lugs.phase) % 360.0 + 180.0 / lugs.count, 6)


def _at_rest(study: Study, soil: Soil) -> list[Task]:
    """The wheel pressed into a soil by the solid model, and by plates where the study has them."""
    section, orientation = stated(study.soil, "soil"), at_rest_orientation(study)
    law = [soil.modulus(wheel_design(study).tire.width), soil.exponent]
    deepest = study.fe.max_deflection
    changed: dict[str, Any] = {
        "soil": law,
        "contact_method": "penalty",
        "deflections": [round(deepest * (k + 1) / _STEPS, 12) for k in range(_STEPS)],
        "max_load": section.load,
    }
    inputs = without_fields(without_end(fe_inputs(study, orientation, changed["deflections"]))) | changed
    mesh = mesh_task(study, MESH_SOIL, coarse_across(study))
    found = [mesh, fe_task(AT_REST["fe"], inputs, MESH_SOIL)]
    if study.ancf_wheel is not None and without_ancf_wheel(study) is None:
        (plates,) = ancf_wheel_curve_tasks(study, [orientation])
        level = {name: changed[name] for name in ("soil", "deflections", "max_load")}
        asked = {**plates.inputs, **level, "keep_points": False}
        found.append(replace(plates, name=AT_REST["ancf_wheel"], inputs=asked))
    return found


def pressed_tasks(study: Study, model: str, soil: Soil, orientations_deg: Sequence[float]) -> tuple[Task, ...]:
    """Curves of one of the `CARCASS_MODELS` pressed into a soil; no orientation means those of the study.

    Raises
    ------
    InputError
        For another model, and as `carcass_tasks`.
    """
    if model not in CARCASS_MODELS:
        rule = f"is not pressed into soil; {', '.join(CARCASS_MODELS)} are"
        raise InputError("model", model, rule, "leave out --soil")
    if (lacking := without_soil(study)) is not None:
        raise InputError(*lacking)
    law = [soil.modulus(wheel_design(study).tire.width), soil.exponent]
    if model == "ancf_wheel":
        plates = ancf_wheel_curve_tasks(study, orientations_deg)
        return tuple(replace(one, inputs={**one.inputs, "soil": law}) for one in plates)
    changed = {"soil": law, "contact_method": "penalty"}
    curves = [replace(one, inputs={**one.inputs, **changed}) for one in fe_curve_tasks(study, orientations_deg)]
    return foreseen((wheel_meshes(study)[0], *curves))


def carcass_tasks(study: Study, model: str) -> tuple[Task, ...]:
    """The curves at the study's orientations, with the wheel's shape near `WORKING_LOAD`, and the task that reads them.

    Raises
    ------
    InputError
        For a study whose wheel is a mesh from a file, does not stand on level ground, or can yield for good.
    """
    if (lacking := without_soil(study)) is not None:
        raise InputError(*lacking)
    load, curves = _shown(study, model)
    given = (wheel_meshes(study)[0],) if model == "fe" else ()
    return (*foreseen((*given, *curves)), _carcass(study, model, load, curves))


def _carcass(study: Study, model: str, load: float, curves: Sequence[Task]) -> Task:
    solved = [(one.inputs["orientation_deg"], one.name) for one in curves]
    return Task(
        name=carcass_name(model),
        function="workbench.questions.soil.carcass_task:find",
        inputs={
            "model": model,
            "load": load,
            "wheel": wheel_inputs(study),
            "curves": [list(one) for one in solved],
            **({} if model == "fe" else {"options": curves[0].inputs["options"]}),
        },
        needs=(*((MESH,) if model == "fe" else ()), *(name for _, name in solved)),
        cost=2.0,
    )


def _shown(study: Study, model: str) -> tuple[float, Sequence[Task]]:
    """The load at which shapes are kept [N], and the curves' tasks that keep them: the report's own where they do."""
    if model == "ancf_wheel":
        plates = ancf_wheel_curve_tasks(study)
        return WORKING_LOAD, [one if one.inputs["keep_points"] else _with(one, keep_points=True) for one in plates]
    loads = study.fe.snapshot_loads
    load = min(loads, key=lambda one: abs(one - WORKING_LOAD)) if loads else min(WORKING_LOAD, study.fe.max_load)
    solid = fe_curve_tasks(study)
    return load, solid if loads else [_with(one, snapshot_loads=[load]) for one in solid]


def _with(task: Task, **inputs: object) -> Task:
    return replace(task, inputs={**task.inputs, **inputs})
