"""Tasks of `workbench mission`. Verified by tests/unit/test_workbench_rover_mission.py."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.models.driving_brush import driving_inputs
from workbench.questions.models.wheel_tasks import between_steps, rock_tasks, solved_tire
from workbench.questions.rover_mission.requirements import MISSION
from workbench.study.model import Study
from workbench.study.model_parameters import fits_rover, rover_ancf, rover_on_ancf, rover_on_brush, rover_radius

__all__ = ["COMPARED", "MISSION_TIRES", "SEARCHED", "mission_task_name", "mission_tasks"]

MISSION_TIRES = ("rigid", "brush", "fe", "ancf_wheel", "ancf")
"""As on the command line of ``workbench rover``."""
SEARCHED = ("brush", "fe")
"""Tires on which smallest torque and friction are searched; with the last one's torque ``ancf_wheel`` is tried."""
COMPARED = (20.0, 250.0)
"""Loads between which a tire is held against curves solved apart [N]."""
_COSTS = {"rigid": 3.0, "brush": 40.0, "fe": 60.0, "ancf_wheel": 10.0, "ancf": 40.0}


def mission_task_name(tire: str, scenario: str) -> str:
    """Name of the task."""
    return f"mission_{tire}_{scenario}"


def mission_tasks(study: Study, tires: Sequence[str] = MISSION_TIRES) -> tuple[Task, ...]:
    """Every scenario of the mission on each of these tires, behind the tasks of the wheel they need.

    Raises
    ------
    InputError
        For a tire that is none of `MISSION_TIRES`, a study without [rover], or a wheel that is not of the rover's size.
    """
    for tire in tires:
        if tire not in MISSION_TIRES:
            raise InputError("tire of the mission", repr(tire), "is not known", f"give of {', '.join(MISSION_TIRES)}")
    base = {"wheel": None, "ancf": None, "confirms": None, **rover_on_brush(study)}
    if study.rover is None:
        hint = "copy it from studies/exomars.toml, if the wheel is of the rover's size"
        raise InputError("[rover]", "", "is missing: it says that a rover drives on the study's tires", hint)
    before: dict[str, Task] = {}
    driven: list[Task] = []
    for tire in tires:
        own: dict[str, Any] = {"tire": tire, "searched": tire in SEARCHED}
        needs: tuple[str, ...] = ()
        if tire in ("fe", "ancf_wheel"):
            own["wheel"], tasks = solved_tire(study, tire)
            before |= {task.name: task for task in (*tasks, *stiffness_tasks(study, tire, between_steps(study)))}
            if tire == "fe":
                before |= {task.name: task for task in rock_tasks(study, COMPARED[1])}
            needs = tuple(sorted({name for *_, name in (*own["wheel"]["curves"], *own["wheel"]["travels"])}))
        elif tire == "brush":
            own |= driving_inputs(study)
        elif tire == "ancf":
            if not fits_rover(study):
                rule = "is not that of the rover's wheels"
                hint = f"give {1e3 * rover_radius():g} mm, or leave ancf out of --tire"
                raise InputError("radius of [ancf]", f"{1e3 * rover_ancf(study).zero_radius:g} mm", rule, hint)
            own["ancf"] = {name: value for name, value in rover_on_ancf(study).items() if name != "friction"}
        for scenario in MISSION:
            confirms = mission_task_name("fe", scenario) if tire == "ancf_wheel" and "fe" in tires else None
            driven.append(
                Task(
                    name=mission_task_name(tire, scenario),
                    function="workbench.questions.rover_mission.task:drive_mission",
                    inputs={**base, **own, "scenario": scenario, "confirms": confirms},
                    needs=needs if confirms is None else (*needs, confirms),
                    cost=_COSTS[tire],
                )
            )
    return (*before.values(), *driven)
