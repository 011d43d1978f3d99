"""Task that writes the ANCF tire's surfaces as STEP files and reads them back.

Verified by tests/unit/test_workbench_ancf_surfaces.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.mesh import PlateMesh
from ancf_reduced.plates.spline_plates import FACES, plate_surfaces
from ancf_reduced.tire.static import solve_tire
from ancf_reduced.tire.surfaces import surface_grid
from geometry.surface_step import step_points, write_surfaces_step
from workbench.execution.result_files import write_result
from workbench.study.ancf_tire import tire_from
from workbench.study.orientation import orientation_name

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["read_back_deviation", "write_surfaces"]

_GRID = 9
"""Points along xi and eta at which a surface is compared: more than twice as many as a bicubic needs."""


def write_surfaces(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``ancf.step`` unloaded, one file for each deflection, and in ``result.json`` how far they lie off, read back."""
    tire, orientation = tire_from(inputs), inputs["orientation_deg"]
    states = {"ancf": tire.mesh.reference_coordinates()}
    if inputs["deflections"]:
        solved = solve_tire(tire, math.radians(orientation), inputs["deflections"])
        name = orientation_name("ancf", orientation)
        states |= {f"{name}_{1e3 * d:g}mm": solved.at(d) for d in inputs["deflections"]}
    progress(0.5)
    deviation = {}
    for name, coordinates in states.items():
        write_surfaces_step(plate_surfaces(tire.mesh, coordinates), out / f"{name}.step")
        deviation[name] = read_back_deviation(tire.mesh, coordinates, out / f"{name}.step")
    write_result(out, {"surfaces": len(FACES) * len(tire.mesh.elements), "read_back_m": deviation})
    return int(tire.mesh.reference_coordinates()[tire.tie.free].size)


def read_back_deviation(mesh: PlateMesh, coordinates: NDArray[np.float64], path: Path) -> float:
    """Largest distance between the surfaces gmsh finds in a STEP file and the plates' own, thesis eqs. 2.11-2.13 [m].

    Parameters
    ----------
    mesh : plates
    coordinates : (n_nodes, 4, 3) float [m, -]
    path : file with a surface ``"{part} {number} {face}"`` for each face of each plate
    """
    line = np.linspace(0.0, 1.0, _GRID)
    found = step_points(path, np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2))
    return max(
        float(np.linalg.norm(found[f"{part} {j} {face}"] - grid[j].reshape(-1, 3), axis=1).max())
        for face, zeta in FACES.items()
        for grid in [surface_grid(mesh, coordinates, _GRID, zeta)]
        for j, part in enumerate(mesh.parts)
    )
