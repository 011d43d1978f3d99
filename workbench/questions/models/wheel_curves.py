"""Curves of a study's wheel all around, solved by `wheel_tasks`, and the potential that the rover's tires make of them.

Verified by tests/unit/test_workbench_wheel_curves.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve, read_curve
from contracts.hub_travel import Way
from contracts.travel_curve import read_travel
from rover_dynamics.rover.scenarios.ground import on_wheel_curves
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.tires.wheel_potential import (
    MOMENT,
    Tips,
    WheelPotential,
    load_and_slope,
    raise_and_slope,
    wheel_potential,
)
from workbench.questions.model_curves import CURVE
from workbench.questions.models.between import Between
from workbench.questions.models.wheel_brush import carcass_of
from workbench.questions.travel_start import TRAVEL
from workbench.study.orientation import deep_name

__all__ = ["curves_around", "largest_between", "on_solved_tires"]


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
    """Curves of a tire of `solved_tire` at every step of one period, from the folders of those solved.

    The mirror image of one turns the wheel the other way.
    """
    found = []
    for orientation, task in values["curves"]:
        curve = read_curve(folders[task] / CURVE, model=values["model"], orientation_deg=orientation)
        if MOMENT in curve.columns and task != deep_name(values["model"], orientation):
            curve = replace(curve, columns={**curve.columns, MOMENT: -curve.columns[MOMENT]})
        found.append(curve)
    return found
