"""Task of the continuum model: the hub of the pressed wheel moved over the ground.

Verified by tests/end_to_end/test_travel.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.hub_travel import HubTravel
from contracts.travel_curve import WRENCH, TravelCurve, write_travel
from reference_fe.wheel.pressed import WheelResult, solve_wheel
from workbench.execution.result_files import FAILURE, increment_rows, write_result
from workbench.questions.fe.task import converged_part, load_case, materials_of
from workbench.questions.travel_start import TRAVEL, approach, hub_travel
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve_travel"]


def solve_travel(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """``travel.csv`` and ``result.json``; returns the unknowns.

    Needs the tasks of the mesh, ``inputs["mesh"]``, and of the curve that says where the wheel bears the load,
    ``inputs["curve"]``.
    """
    mesh = read_mesh(needs[inputs["mesh"]] / MESH)
    travel = hub_travel(inputs, needs)
    case = replace(
        load_case(inputs), deflections=approach(travel.start), travel=travel, friction=inputs["travel"]["friction"]
    )
    materials = materials_of(inputs)

    def report(control: float, _load: float) -> None:
        progress(control / travel.controls[-1])

    result, failure = converged_part(lambda: solve_wheel(mesh, materials, case, report, checkpoint))
    if result.travelled:
        write_travel(_curve(result, travel, partial=failure is not None), out / TRAVEL)
    numbers = {
        "dofs": result.dofs,
        "solve_s": result.wall_s,
        "cells": len(mesh.cells),
        "increments": increment_rows(result.increments),
        FAILURE: failure,
    }
    write_result(out, numbers)
    return result.dofs


def _curve(result: WheelResult, travel: HubTravel, *, partial: bool) -> TravelCurve:
    standing = {name: float(column[-1]) for name, column in result.curve.columns.items()}
    rows = [{"travel": 0.0, "load_N": float(result.curve.load[-1])} | standing, *result.travelled]
    kept = [*WRENCH, *(name for name in rows[0] if name not in ("travel", "deflection_m", *WRENCH))]
    at = f"at {1e3 * travel.start:.4g} mm from first touch"
    assert result.curve.orientation_deg is not None
    return TravelCurve(
        model="fe",
        way=travel.way,
        orientation_deg=result.curve.orientation_deg,
        deflection=travel.start,
        travel=np.array([row["travel"] for row in rows]),
        columns={name: np.array([row.get(name, 0.0) for row in rows]) for name in kept},
        source=f"solid finite elements, {result.dofs} unknowns, {at}",
        partial=partial,
    )
