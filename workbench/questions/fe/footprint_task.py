"""Task: footprints of a curve at the loads at which its fields are kept.

Verified by tests/end_to_end/test_commands.py and tests/unit/test_workbench_footprint.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contracts.curves import read_curve
from contracts.footprint import FOOTPRINT, Footprint, write_footprint
from reference_fe.wheel.footprint import footprint, pressure_at_nodes
from workbench.execution.result_files import read_result, write_result
from workbench.questions.fe.field_file import POINTS_FILE, PRESSURE_FILE, read_points, write_pressures
from workbench.questions.fe.task import load_case
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["find"]


def find(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``footprint_200N.csv`` of a curve at each load, ``pressure.npz`` at the nodes at each load and at the points
    kept, ``result.json`` with load, centre and size; returns points.

    Needs the mesh and the curve on it, whose own inputs are ``case``.
    """
    case, curve, found, count = inputs["case"], needs[inputs["curve"]], dict[str, dict[str, float]](), 0
    mesh, snapshots = read_mesh(needs[inputs["mesh"]] / MESH), read_result(curve)["snapshots"]
    solved, pressures = load_case(case), list[tuple[float, NDArray[np.float64]]]()
    for done, snapshot in enumerate(snapshots, 1):
        _, wanted = min((abs(load - snapshot["load_N"]), load) for load in case["snapshot_loads"])
        with np.load(curve / f"fields_{wanted:.0f}N.npz", allow_pickle=False) as fields:
            state = mesh, fields["displacement"], solved, snapshot["deflection_m"]
        one = footprint(*state)
        pressures.append((float(f"{wanted:.0f}"), pressure_at_nodes(*state)))
        source = f"footprint of the solid wheel at {one.load:.6g} N, {1e3 * snapshot['deflection_m']:.6g} mm"
        write_footprint(one, out / f"{FOOTPRINT}_{wanted:.0f}N.csv", source)
        found[f"{wanted:.0f}N"] = _numbers(one)
        count += len(one.force)
        progress(0.5 * done / len(snapshots))
    if case["keep_points"] and (curve / POINTS_FILE).exists():
        deflections = read_curve(curve / "curve.csv", model="fe").deflection[1:]
        for (load, displacement, _), deflection in zip(read_points(curve / POINTS_FILE), deflections, strict=True):
            pressures.append((load, pressure_at_nodes(mesh, displacement, solved, float(deflection))))
    write_pressures(pressures, out / PRESSURE_FILE)
    write_result(out, found)
    return count


def _numbers(one: Footprint) -> dict[str, float]:
    low, high = one.place.min(axis=0), one.place.max(axis=0)
    return {
        "load_N": one.load,
        "centre_forward_m": float(one.centre[0]),
        "centre_left_m": float(one.centre[1]),
        "length_m": float(high[0] - low[0]),
        "width_m": float(high[1] - low[1]),
    }
