"""Task: modes of the wheel by finite elements. Verified by tests/end_to_end/test_modes.py."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.mesh import TaggedMesh
from reference_fe.vibration.wheel import WheelState, wheel_modes
from workbench.execution.result_files import write_result
from workbench.questions.fe.field_file import write_shapes
from workbench.questions.fe.task import load_case, materials_of
from workbench.questions.modes.mode_file import FIELDS, MODES, KeptModes, write_modes
from workbench.questions.modes.picture import PICTURE, draw
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve"]


def solve(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``modes.npz``, ``modes.vtu``, ``modes.png``, ``result.json``; returns the unknowns. Needs the mesh's task.

    One mode more than asked for where the last would be half a pair.
    """
    (mesh_folder,) = needs.values()
    mesh, asked, begun = read_mesh(mesh_folder / MESH), inputs["modes"], time.perf_counter()
    found = wheel_modes(
        mesh,
        materials_of(inputs),
        load_case(inputs),
        WheelState(asked["state"]),
        asked["count"] + 1,
        load=asked["load"],
        grip=asked["grip"],
        progress=lambda share: progress(0.8 * share),
    )
    half = "symmetry" in mesh.faces
    part = _part_of_points(mesh)
    modes = found.modes.whole_pairs(asked["count"])
    kept = KeptModes(modes=modes, parts=tuple(mesh.parts), part=part, half=half)
    write_modes(kept, out / MODES)
    write_shapes(mesh.points, mesh.cells, modes.shape, out / FIELDS)
    draw(kept, out / FIELDS, out / PICTURE)
    numbers = {
        "dofs": found.dofs,
        "load_N": found.load,
        "deflection_m": found.deflection,
        "solve_s": time.perf_counter() - begun,
    }
    write_result(out, numbers)
    return found.dofs


def _part_of_points(mesh: TaggedMesh) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Number of each node's part in the mesh's order; of a shared node the first."""
    found = np.zeros(len(mesh.points), dtype=np.int64)
    for number, tag in reversed(list(enumerate(mesh.parts.values()))):
        found[mesh.cells[mesh.cell_tags == tag]] = number
    return found
