"""Curves of a study's wheel all around, and the potential that the rover's tires make of them.

Verified by tests/unit/test_workbench_wheel_curves.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.travel_curve import TravelCurve, read_travel
from rover_dynamics.rover.scenarios.ground import Carcass, on_wheel_curves
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.tires.wheel_potential import Tips, WheelPotential, load_and_slope, raise_and_slope, wheel_potential
from workbench.execution.task import Task
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import without_end
from workbench.questions.model_curves import CURVE
from workbench.questions.travel_start import TRAVEL
from workbench.questions.travels import WORKING_LOAD, travel_name, travel_tasks
from workbench.study.full import is_mirrored, require_level, rotational_period, steps_around
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.wheel_design import wheel_design

__all__ = [
    "Between",
    "between_steps",
    "carcass_of",
    "curves_around",
    "deep_tasks",
    "largest_between",
    "on_solved_tires",
    "orientations_to_solve",
    "solved_tire",
    "where_it_moves",
]

_MOVED, _BETWEEN, _DEEPER, _ROOM, _APART = 4, 8, 1.6, 0.6, 8.0


def orientations_to_solve(study: Study) -> list[float]:
    """Orientations [deg] by ``full.orientation_step``, over one period, or half of one where it mirrors itself.

    Raises
    ------
    InputError
        For a study whose solid model does not stand on level ground, and a step that does not divide the period.
    """
    require_level(study)
    steps = steps_around(study)
    return [one for one in steps if not is_mirrored(study) or one <= 0.5 * rotational_period(study) + 1e-9]


def deep_tasks(study: Study, model: str) -> tuple[Task, ...]:
    """Curves at every orientation to be solved that go on beyond the study's, as deep as a rover may press a wheel.

    Behind the study's points one every eighth of its last deflection, up to 1.6 times that or 0.6 times the room
    between rim and hub, whatever is less; no load ends them.
    """
    design, last = wheel_design(study), study.fe.max_deflection
    room = design.tire.outer_radius - design.outer_hub.outer_radius
    deepest, apart = max(last, min(_DEEPER * last, _ROOM * room)), last / _APART
    more = [round(last + k * apart, 12) for k in range(1, 1 + int((deepest - last) / apart + 1e-9))]
    tasks = []
    for task in stiffness_tasks(study, model, orientations_to_solve(study)):
        if "deflections" in task.inputs:
            inputs = without_end(task.inputs) | {"deflections": [*task.inputs["deflections"], *more]}
            tasks.append(replace(task, name=_deep_name(model, task.inputs["orientation_deg"]), inputs=inputs))
        else:
            tasks.append(task)
    return foreseen(tasks)


def _deep_name(model: str, orientation_deg: float) -> str:
    return orientation_name(f"{model}_deep", orientation_deg)


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
        "curves": [[one, _deep_name(model, _solved_as(one, solved, period))] for one in steps_around(study)],
        "travels": [[way.value, one, travel_name(model, way, one)] for one in moved for way in ways],
        "tips": _tips(study)._asdict(),
    }, tuple(tasks.values())


def _solved_as(orientation: float, solved: Sequence[float], period: float) -> float:
    """The orientation solved [deg] that is this one, or where it was not solved that is its mirror image."""
    near = min(solved, key=lambda one: abs(one - orientation))
    return near if abs(near - orientation) < 1e-6 else min(solved, key=lambda one: abs(period - one - orientation))


def on_solved_tires(scenario: Scenario, values: Mapping[str, Any], folders: Mapping[str, Path]) -> Scenario:
    """The scenario on a wheel of `solved_tire`, from the folders of the tasks it needs.

    Raises
    ------
    InputError
        For a run that found nothing, or curves that make no potential.
    """
    potential = _potential(values, folders)
    found = [(Way(way), one, folders[name] / TRAVEL) for way, one, name in values["travels"]]
    travels = [read_travel(path, values["model"], way, one) for way, one, path in found if path.exists()]
    words = {"fe": "the solid model", "ancf_wheel": "the ANCF wheel, without inertia of its plates,"}
    told = f"{len(values['curves'])} curves of {words[values['model']]} of {values['study']}"
    return on_wheel_curves(scenario, potential, told, carcass_of(travels), values["model"])


def _potential(values: Mapping[str, Any], folders: Mapping[str, Path]) -> WheelPotential:
    return wheel_potential(curves_around(values, folders), math.radians(values["period_deg"]), Tips(**values["tips"]))


class Between(NamedTuple):
    """Where a tire's load differs most from a curve solved apart: orientation [deg], deflection [m], relative [-]."""

    orientation_deg: float
    deflection: float
    difference: float


def between_steps(study: Study) -> list[float]:
    """Eight orientations [deg], evenly spread, half a step beside those that a tire's potential goes through."""
    steps = steps_around(study)
    half = 0.5 * (steps[1] - steps[0]) if len(steps) > 1 else 0.5 * rotational_period(study)
    return [one + half for one in steps[:: max(1, len(steps) // _BETWEEN)]]


def largest_between(
    values: Mapping[str, Any], folders: Mapping[str, Path], curves: Sequence[StiffnessCurve], loads: tuple[float, float]
) -> Between:
    """The largest difference of load from curves solved apart, at their points whose loads [N] lie in a range."""
    potential, found = _potential(values, folders), [Between(0.0, 0.0, 0.0)]
    for curve in curves:
        at = math.radians(curve.orientation_deg or 0.0)
        rise = raise_and_slope(potential.tips, at)[0]
        for d, load in zip(curve.deflection.tolist(), curve.load.tolist(), strict=True):
            if loads[0] <= load <= loads[1]:
                difference = load_and_slope(potential, d - rise, at)[1] / load - 1.0
                found.append(Between(curve.orientation_deg or 0.0, d, difference))
    return max(found, key=lambda one: abs(one.difference))


def curves_around(values: Mapping[str, Any], folders: Mapping[str, Path]) -> list[StiffnessCurve]:
    """Curves of a tire of `solved_tire` at every step of one period, from the folders of those solved."""
    return [read_curve(folders[task] / CURVE, model=values["model"], orientation_deg=o) for o, task in values["curves"]]


def where_it_moves(study: Study) -> list[float]:
    """Four of the orientations [deg] solved, evenly spread, at which the hub is moved over the ground; fewer of few."""
    solved = orientations_to_solve(study)
    apart = max(1, len(solved) // _MOVED + 1)
    return solved[::apart]


def carcass_of(travels: Sequence[TravelCurve]) -> Carcass:
    """Mean stiffness of the wheel forwards and sideways.

    Raises
    ------
    InputError
        If there is no travel one way, or one that does not resist.
    """
    found = {}
    for way in (Way.FORE_AFT, Way.LATERAL):
        stiffness = [one.stiffness for one in travels if one.way is way]
        if not stiffness or not min(stiffness) > 0.0:
            rule = "must be found at one orientation at least, and be > 0 at each"
            raise InputError(f"stiffness {way} of the wheel", f"{stiffness} N/m", rule, "ask for closer points in [fe]")
        found[way] = float(np.mean(stiffness))
    return Carcass(forward=found[Way.FORE_AFT], sideways=found[Way.LATERAL])


def _tips(study: Study) -> Tips:
    """Of the wheel's grousers."""
    design = wheel_design(study)
    radius, grousers = design.tire.outer_radius, design.grousers
    if grousers is None:
        return Tips(radius=radius, height=0.0, number=1.0, phase=0.0, half=0.0)
    half = math.asin(0.5 * grousers.thickness / (radius + grousers.height))
    height, number = grousers.height, float(grousers.count)
    return Tips(radius=radius, height=height, number=number, phase=grousers.phase, half=half)
