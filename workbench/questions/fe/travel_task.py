"""Task of the continuum model: the hub of the pressed wheel moved over the ground.

Verified by tests/end_to_end/test_travel.py and tests/end_to_end/test_hub_path.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.hub_travel import HubTravel, Way
from contracts.path_curve import PathCurve, write_path
from contracts.travel_curve import WRENCH, TravelCurve, write_travel
from reference_fe.wheel.pressed import WheelResult, solve_wheel
from workbench.execution.result_files import FAILURE, increment_rows, write_result
from workbench.questions.fe.task import converged_part, load_case, materials_of
from workbench.questions.travel_start import PATH, TRAVEL, approach, hub_travel
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve_travel"]


def solve_travel(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """``travel.csv``, of a path ``path.csv``, and ``result.json``; returns the unknowns.

    Needs the task of the mesh, ``inputs["mesh"]``, and but for a path that of the curve that says where the wheel bears
    the load, ``inputs["curve"]``.
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
    asked, partial = inputs["travel"], failure is not None
    if "path" in asked and not result.curve.unloaded:
        write_path(_path(result, travel, partial=partial), out / PATH)
    elif "path" not in asked and result.travelled:
        write_travel(_curve(result, travel, Way(asked["way"]), partial=partial), out / TRAVEL)
    numbers = {
        "dofs": result.dofs,
        "solve_s": result.wall_s,
        "cells": len(mesh.cells),
        "increments": increment_rows(result.increments),
        FAILURE: failure,
    }
    write_result(out, numbers)
    return result.dofs


def _path(result: WheelResult, travel: HubTravel, *, partial: bool) -> PathCurve:
    curve, names = result.curve, ["load_N", *result.curve.columns]
    pressed = {"load_N": curve.load, **curve.columns}
    controls = [*curve.deflection, *(row["control"] for row in result.travelled)]
    return PathCurve(
        model="fe",
        orientation_deg=_orientation(result),
        places=np.array([travel.place(control) for control in controls]),
        columns={n: np.array([*pressed[n], *(row.get(n, 0.0) for row in result.travelled)]) for n in names},
        source=f"solid finite elements, {result.dofs} unknowns, the hub's places from first touch",
        partial=partial,
    )


def _orientation(result: WheelResult) -> float:
    assert result.curve.orientation_deg is not None
    return result.curve.orientation_deg


def _curve(result: WheelResult, travel: HubTravel, way: Way, *, partial: bool) -> TravelCurve:
    standing = {name: float(column[-1]) for name, column in result.curve.columns.items()}
    rows = [{"control": travel.start, "load_N": float(result.curve.load[-1])} | standing, *result.travelled]
    kept = [*WRENCH, *(name for name in rows[0] if name not in ("control", "deflection_m", *WRENCH))]
    at = f"at {1e3 * travel.start:.4g} mm from first touch"
    return TravelCurve(
        model="fe",
        way=way,
        orientation_deg=_orientation(result),
        deflection=travel.start,
        travel=np.array([travel.at(row["control"]) for row in rows]),
        columns={name: np.array([row.get(name, 0.0) for row in rows]) for name in kept},
        source=f"solid finite elements, {result.dofs} unknowns, {at}",
        partial=partial,
    )
