"""Task of the ANCF wheel: its curve at one orientation. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.stability import unstable_mode
from ancf_reduced.wheel.static import Equilibrium, WheelOnGround, press
from ancf_reduced.wheel.stress import largest_spring_stress
from contracts.curves import StiffnessCurve, write_curve
from contracts.errors import ConvergenceError, IncrementRecord
from contracts.travel_curve import WRENCH
from workbench.execution.result_files import FAILURE, UNSTABLE, increment_rows, write_result
from workbench.questions.ancf_wheel.ground import terrain_of
from workbench.questions.model_curves import CURVE
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["STATES", "solve_orientation", "wrench_columns"]

Array = NDArray[np.float64]

STATES = "states.npz"
"""Deflections and free coordinates at the points of a curve, in a task's folder."""


def solve_orientation(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``curve.csv`` up to the load or deflection asked for, and ``result.json``; returns the unknowns."""
    wheel = build_ancf_wheel(design_from(inputs["wheel"]), **inputs["options"])
    orientation, deflections, largest = inputs["orientation_deg"], inputs["deflections"], inputs["max_load"]
    problem = WheelOnGround(
        wheel,
        math.radians(orientation),
        inputs["contact_stiffness"],
        inputs["inner_contact_stiffness"],
        terrain=terrain_of(inputs["obstacle"]),
        camber=math.radians(inputs["camber_deg"]),
        friction=inputs["friction"],
        soil=tuple(inputs["soil"]) if "soil" in inputs else None,
    )
    start, failure = time.perf_counter(), None
    states, history = [problem.unloaded()], list[IncrementRecord]()
    try:
        for state in press(problem, deflections, history=history):
            states.append(state)
            progress(max(state.deflection / deflections[-1], state.load / largest))
            if state.load >= largest:
                break
    except ConvergenceError as error:
        failure = str(error)
    write_curve(_curve(problem, states, partial=failure is not None), out / CURVE)
    if inputs["keep_points"]:
        deflection, free = np.array([s.deflection for s in states]), np.array([s.free for s in states])
        np.savez_compressed(out / STATES, allow_pickle=False, deflection=deflection, free=free)
    numbers = {
        "dofs": wheel.basis.shape[1],
        "cells": len(wheel.plates.plates),
        "solve_s": time.perf_counter() - start,
        "increments": increment_rows(history),
        FAILURE: failure,
        UNSTABLE: _does_not_stand(problem, states),
    }
    write_result(out, numbers)
    return wheel.basis.shape[1]


def _does_not_stand(problem: WheelOnGround, states: list[Equilibrium]) -> str | None:
    """Where the wheel first does not, and how it leaves; nothing with friction, whose tangent is unsymmetric."""
    if problem.friction > 0.0:
        return None
    first = next((state for state in states if state.negative), None)
    mode = None if first is None else unstable_mode(problem, first)
    if first is None or mode is None:
        return None
    where = f"{1e3 * first.deflection:.1f} mm, {first.load:.0f} N"
    place = f"most at {mode.angle_deg:.0f} deg, {1e3 * mode.radius:.0f} mm from the axle, {mode.part}"
    return f"the wheel does not stand from {where} on (negative eigenvalues: {first.negative}), it moves {place}"


def wrench_columns(problem: WheelOnGround, states: Sequence[Equilibrium]) -> dict[str, Array]:
    """The ground's force [N] and moment [N m] on the wheel at the hub's centre, without the load; (n,) each."""
    both = np.array([np.concatenate(problem.wrench(s)) for s in states])
    return {name: both[:, k] for k, name in enumerate(WRENCH) if name != "load_N"}


def _curve(problem: WheelOnGround, states: list[Equilibrium], *, partial: bool) -> StiffnessCurve:
    wheel = problem.wheel
    stresses = [largest_spring_stress(wheel, wheel.coordinates(s.free)) for s in states]
    return StiffnessCurve(
        model="ancf_wheel",
        orientation_deg=round(math.degrees(problem.orientation), 9),
        deflection=np.array([s.deflection for s in states]),
        load=np.array([s.load for s in states]),
        columns={
            "stored_energy_J": np.array([s.energy for s in states]),
            "rim_force_N": np.array([problem.rim_force(s) for s in states]),
            **({} if problem.friction > 0.0 else {"negative_pivots": np.array([float(s.negative) for s in states])}),
            **wrench_columns(problem, states),
            **{f"max_linearised_{part}_Pa": np.array([s[part] for s in stresses]) for part in stresses[0]},
        },
        source=f"thin ANCF plates of the wheel, {wheel.basis.shape[1]} unknowns, deflection from first touch",
        partial=partial,
    )
