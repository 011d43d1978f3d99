"""Task of the ANCF wheel: its hub, pressed, moved over the ground.

Verified by tests/end_to_end/test_travel.py and tests/end_to_end/test_hub_path.py.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import Equilibrium, WheelOnGround, press
from contracts.errors import ConvergenceError, IncrementRecord
from contracts.hub_travel import HubTravel, Way
from contracts.path_curve import PathCurve, write_path
from contracts.travel_curve import TravelCurve, write_travel
from workbench.execution.result_files import FAILURE, increment_rows, write_result
from workbench.questions.ancf_wheel.task import wrench_columns
from workbench.questions.travel_start import PATH, TRAVEL, approach, hub_travel
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve_travel"]


def solve_travel(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``travel.csv``, of a path ``path.csv``, and ``result.json``; returns the unknowns.

    Needs the curve ``inputs["curve"]`` but for a path.
    """
    asked = inputs["travel"]
    wheel = build_ancf_wheel(design_from(inputs["wheel"]), **inputs["options"])
    travel = hub_travel(inputs, needs)
    problem = WheelOnGround(
        wheel,
        math.radians(inputs["orientation_deg"]),
        inputs["contact_stiffness"],
        inputs["inner_contact_stiffness"],
        friction=asked["friction"],
        travel=travel,
    )
    start, failure = time.perf_counter(), None
    states, history = [problem.unloaded()], list[IncrementRecord]()
    try:
        for state in press(problem, [*approach(travel.start), *travel.controls], history=history):
            progress(state.deflection / travel.controls[-1])
            states.append(state)
    except ConvergenceError as error:
        failure = str(error)
    partial, gone = failure is not None, [state for state in states if state.deflection >= travel.start]
    if "path" in asked and len(states) > 1:
        write_path(_path(problem, states, travel, partial=partial), out / PATH)
    elif "path" not in asked and len(gone) > 1:
        write_travel(_curve(problem, gone, travel, Way(asked["way"]), partial=partial), out / TRAVEL)
    numbers = {
        "dofs": wheel.basis.shape[1],
        "cells": len(wheel.plates.plates),
        "solve_s": time.perf_counter() - start,
        "increments": increment_rows(history),
        FAILURE: failure,
    }
    write_result(out, numbers)
    return wheel.basis.shape[1]


def _path(problem: WheelOnGround, states: list[Equilibrium], travel: HubTravel, *, partial: bool) -> PathCurve:
    return PathCurve(
        model="ancf_wheel",
        orientation_deg=round(math.degrees(problem.orientation), 9),
        places=np.array([travel.place(s.deflection) for s in states]),
        columns=_columns(problem, states),
        source=f"{_plates(problem)}, the hub's places from first touch",
        partial=partial,
    )


def _columns(problem: WheelOnGround, states: list[Equilibrium]) -> dict[str, NDArray[np.float64]]:
    load, energy = np.array([s.load for s in states]), np.array([s.energy for s in states])
    return {"load_N": load, **wrench_columns(problem, states), "stored_energy_J": energy}


def _plates(problem: WheelOnGround) -> str:
    return f"thin ANCF plates of the wheel, {problem.wheel.basis.shape[1]} unknowns"


def _curve(
    problem: WheelOnGround, states: list[Equilibrium], travel: HubTravel, way: Way, *, partial: bool
) -> TravelCurve:
    return TravelCurve(
        model="ancf_wheel",
        way=way,
        orientation_deg=round(math.degrees(problem.orientation), 9),
        deflection=travel.start,
        travel=np.array([travel.at(s.deflection) for s in states]),
        columns=_columns(problem, states),
        source=f"{_plates(problem)}, at {1e3 * travel.start:.4g} mm from first touch",
        partial=partial,
    )
