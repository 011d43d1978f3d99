"""Tasks whose curves and travels make a study's wheel a tire of the rover: what `wheel_curves` reads.

Verified by tests/unit/test_workbench_wheel_curves.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from contracts.hub_travel import Way
from workbench.execution.task import Task
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import without_end, without_fields
from workbench.questions.travel_files import travel_name
from workbench.questions.travels import WORKING_LOAD, travel_tasks
from workbench.study.contact import RockSection
from workbench.study.full import is_mirrored, require_level, rotational_period, steps_around
from workbench.study.laws import require_elastic
from workbench.study.model import Study
from workbench.study.orientation import deep_name, orientation_name
from workbench.study.own_mesh import own_mesh
from workbench.study.wheel_design import wheel_design

__all__ = [
    "ROCK_RADIUS",
    "between_steps",
    "deep_tasks",
    "orientations_to_solve",
    "rock_name",
    "rock_tasks",
    "solved_tire",
    "where_it_moves",
]

ROCK_RADIUS = 0.02
"""Of the half-round below the hub on which a tire's equivalent plane is tried [m]."""
_MOVED, _BETWEEN, _DEEPER, _ROOM, _APART = 4, 8, 1.4, 0.6, 8.0


def orientations_to_solve(study: Study) -> list[float]:
    """Orientations [deg] by ``full.orientation_step``, over one period, or half of one where it mirrors itself.

    Raises
    ------
    InputError
        For a study whose solid model does not stand on level ground or can yield for good, and a step that does not
        divide the period.
    """
    require_level(study)
    require_elastic(study, "a rover's wheel, whose potential is elastic")
    steps = steps_around(study)
    return [one for one in steps if not is_mirrored(study) or one <= 0.5 * rotational_period(study) + 1e-9]


def deep_tasks(study: Study, model: str) -> tuple[Task, ...]:
    """Curves at every orientation to be solved that go on beyond the study's, as deep as a rover may press a wheel.

    Behind the study's points one every eighth of its last deflection, up to 1.4 times that or 0.6 times the room
    between rim and hub, whatever is less; no load ends them. A wheel with a mesh from another program is pressed no
    deeper than the study says: what room it has is not known.
    """
    more = [] if own_mesh(study) is not None else _deeper(study)
    tasks = []
    for task in stiffness_tasks(study, model, orientations_to_solve(study)):
        if "deflections" in task.inputs:
            inputs = without_end(task.inputs) | {"deflections": [*task.inputs["deflections"], *more]}
            tasks.append(replace(task, name=deep_name(model, task.inputs["orientation_deg"]), inputs=inputs))
        else:
            tasks.append(task)
    return foreseen(tasks)


def _deeper(study: Study) -> list[float]:
    """Deflections behind the study's [m]."""
    design, last = wheel_design(study), study.fe.max_deflection
    room = design.tire.outer_radius - design.outer_hub.outer_radius
    deepest, apart = max(last, min(_DEEPER * last, _ROOM * room)), last / _APART
    return [round(last + k * apart, 12) for k in range(1, 1 + int((deepest - last) / apart + 1e-9))]


def solved_tire(study: Study, model: str) -> tuple[dict[str, Any], tuple[Task, ...]]:
    """The study's wheel by a model as a tire: inputs of a task, see `on_solved_tires`, and the tasks it needs.

    Raises
    ------
    InputError
        For a model that has no hub to be moved, and a wheel that is not pressed on level ground.
    """
    ways, moved, solved = (Way.FORE_AFT, Way.LATERAL), where_it_moves(study), orientations_to_solve(study)
    tasks = {one.name: one for one in deep_tasks(study, model)}
    tasks |= {one.name: one for one in travel_tasks(study, model, ways, WORKING_LOAD, moved)}
    period = rotational_period(study)
    return {
        "model": model,
        "study": study.name,
        "period_deg": period,
        "curves": [[one, deep_name(model, _solved_as(one, solved, period))] for one in steps_around(study)],
        "travels": [[way.value, one, travel_name(model, way, one)] for one in moved for way in ways],
        "tips": _tips(study),
    }, tuple(tasks.values())


def _solved_as(orientation: float, solved: Sequence[float], period: float) -> float:
    """The orientation solved [deg] that is this one, or where it was not solved that is its mirror image."""
    near = min(solved, key=lambda one: abs(one - orientation))
    return near if abs(near - orientation) < 1e-6 else min(solved, key=lambda one: abs(period - one - orientation))


def between_steps(study: Study) -> list[float]:
    """Eight orientations [deg], evenly spread, half a step beside those that a tire's potential goes through."""
    steps = steps_around(study)
    half = 0.5 * (steps[1] - steps[0]) if len(steps) > 1 else 0.5 * rotational_period(study)
    return [one + half for one in steps[:: max(1, len(steps) // _BETWEEN)]]


def rock_tasks(study: Study, most: float) -> tuple[Task, ...]:
    """The solid model on a half-round of `ROCK_RADIUS` under the hub, up to a load [N], at two orientations.

    Its axis is the wheel's: the tire has the half-round's tangent plane there, see `rover_dynamics.tires.brush_edges`.
    """
    rock = RockSection(shape="half_round_rock", radius=ROCK_RADIUS)
    on_it = study.model_copy(update={"fe": study.fe.model_copy(update={"obstacle": rock})})
    tasks = []
    for task in stiffness_tasks(on_it, "fe", where_it_moves(study)[::2]):
        if "deflections" in task.inputs:
            inputs = without_fields(task.inputs) | {"max_load": most}
            tasks.append(replace(task, name=rock_name(task.inputs["orientation_deg"]), inputs=inputs))
        else:
            tasks.append(task)
    return foreseen(tasks)


def rock_name(orientation_deg: float) -> str:
    """Name of the task on the half-round."""
    return orientation_name("fe_rock", orientation_deg)


def where_it_moves(study: Study) -> list[float]:
    """Four of the orientations [deg] solved, evenly spread, at which the hub is moved over the ground; fewer of few."""
    solved = orientations_to_solve(study)
    apart = max(1, len(solved) // _MOVED + 1)
    return solved[::apart]


def _tips(study: Study) -> dict[str, float]:
    """Of the wheel's grousers, as `rover_dynamics.tires.wheel_potential.Tips`; a mesh of another program has none."""
    if own_mesh(study) is not None:
        return {"radius": 1.0, "height": 0.0, "number": 1.0, "phase": 0.0, "half": 0.0}  # the radius of none is unread
    design = wheel_design(study)
    radius, grousers = design.tire.outer_radius, design.grousers
    if grousers is None:
        return {"radius": radius, "height": 0.0, "number": 1.0, "phase": 0.0, "half": 0.0}
    half = math.asin(0.5 * grousers.thickness / (radius + grousers.height))
    height, number = grousers.height, float(grousers.count)
    return {"radius": radius, "height": height, "number": number, "phase": grousers.phase, "half": half}
