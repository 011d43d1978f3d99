"""Task of the ANCF wheel: its shape beside the solid's. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.hub import HUB_PARTS
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.shape import MiddleSurface
from contracts.archive import read_archive
from contracts.curves import read_curve
from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from reference_fe.contact.rim_force import RimForce
from workbench.execution.result_files import FAILURE, write_result
from workbench.questions.ancf_wheel.task import STATES
from workbench.questions.fe.field_file import POINTS_FILE, read_points
from workbench.questions.model_curves import CURVE
from workbench.questions.wheel.mesh_file import MESH, read_mesh
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["compare_shapes"]

_LARGEST = 1_000_000_000
"""Bytes of the states along one curve."""


def compare_shapes(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: rows of orientation, deflection, load, distances of the middle surfaces, forces of springs on
    the rim by both models; returns their number.

    No row, and the reason, where the solid has no nodes on a middle surface. Needs the mesh, and the curves of both
    models at each orientation. A point counts where both models have it.
    """
    wheel = build_ancf_wheel(design_from(inputs["wheel"]), **inputs["options"])
    mesh = read_mesh(needs[inputs["mesh"]] / MESH)
    try:
        parts = [part for part in dict.fromkeys(wheel.parts.tolist()) if part not in HUB_PARTS]
        surfaces = {part: _middle_surface(wheel, mesh, part) for part in parts}
    except InputError as error:
        write_result(out, {"rows": [], FAILURE: str(error)})
        return 0
    rows, penalty = list[dict[str, Any]](), inputs["inner_contact_stiffness"]
    on_rim = RimForce(mesh, penalty) if penalty > 0.0 else None
    for i, (orientation, ancf, fe) in enumerate(inputs["pairs"]):
        curve = read_curve(needs[ancf] / CURVE)
        for deflection, q, moved in _common_points(wheel, needs[ancf], needs[fe]):
            row: dict[str, Any] = {"orientation_deg": orientation, "deflection_m": deflection}
            row["load_N"] = curve.load_at(deflection)
            row["rim_force_N"] = float(np.interp(deflection, curve.deflection, curve.columns["rim_force_N"]))
            row["solid_rim_force_N"] = on_rim(moved) if on_rim is not None else 0.0
            every = list[NDArray[np.float64]]()
            for part, (surface, points) in surfaces.items():
                apart = surface.distances(q, points + moved[_nodes_of(mesh, part)])
                every.append(apart)
                row[f"rms_{part}_m"] = float(np.sqrt((apart**2).mean()))
                row[f"largest_{part}_m"] = float(apart.max())
            rows.append(row | {"rms_m": float(np.sqrt((np.concatenate(every) ** 2).mean()))})
        progress((i + 1.0) / len(inputs["pairs"]))
    write_result(out, {"rows": rows, "nodes": {part: len(one.nodes) for part, (one, _) in surfaces.items()}})
    return len(rows)


def _nodes_of(mesh: TaggedMesh, part: str) -> NDArray[np.int64]:
    return np.unique(mesh.cells[mesh.cell_tags == mesh.parts[part]])


def _middle_surface(wheel: AncfWheel, mesh: TaggedMesh, part: str) -> tuple[MiddleSurface, NDArray[np.float64]]:
    points = mesh.points[_nodes_of(mesh, part)]
    return MiddleSurface(wheel, part, points), points


def _common_points(
    wheel: AncfWheel, ancf: Path, fe: Path
) -> Iterator[tuple[float, NDArray[np.float64], NDArray[np.float64]]]:
    """Deflection [m], nodes of the plates and displacements of the solid's at points that both have, none at rest."""
    states, solid = read_archive(ancf / STATES, "states", _LARGEST, ("deflection", "free")), fe / POINTS_FILE
    if not solid.is_file():
        return
    at = dict(zip(read_curve(fe / CURVE).load.tolist(), read_curve(fe / CURVE).deflection.tolist(), strict=True))
    loads = np.array(list(at))
    moved = {at[float(loads[np.abs(loads - load).argmin()])]: u for load, u, _ in read_points(solid)}
    for deflection, free in zip(states["deflection"].tolist(), states["free"], strict=True):
        near = min(moved, key=lambda d: abs(d - deflection), default=0.0)
        if deflection > 0.0 and abs(near - deflection) < 1e-9:
            yield deflection, wheel.coordinates(free), moved[near]
