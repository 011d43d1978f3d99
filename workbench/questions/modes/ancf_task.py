"""Task: modes of the wheel as thin ANCF plates. Verified by tests/end_to_end/test_modes.py."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround
from ancf_reduced.wheel.vibration import standing_under, wheel_modes
from geometry.inertia import rigid_mass
from workbench.execution.result_files import write_result
from workbench.questions.ancf_wheel.ground import terrain_of
from workbench.questions.fe.field_file import write_shapes
from workbench.questions.modes.mode_file import FIELDS, MODES, KeptModes, write_modes
from workbench.questions.modes.picture import PICTURE, draw
from workbench.questions.wheel.mesh_file import MESH, read_mesh
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["SHAPES", "solve", "wheel_of"]

SHAPES = "shapes.npz"
"""All coordinates of the modes, in a task's folder."""


def wheel_of(inputs: Mapping[str, Any]) -> AncfWheel:
    """The wheel of a task's inputs."""
    return build_ancf_wheel(design_from(inputs["wheel"]), **inputs["options"])


def solve(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``modes.npz``, ``shapes.npz``, ``modes.vtu``, ``modes.png`` and ``result.json``; returns the unknowns.

    A free wheel needs the task of the whole mesh, for what of it is no plate.
    """
    wheel, asked, begun = wheel_of(inputs), inputs["modes"], time.perf_counter()
    problem = WheelOnGround(
        wheel,
        math.radians(inputs["orientation_deg"]),
        inputs["contact_stiffness"],
        inputs["inner_contact_stiffness"],
        terrain=terrain_of(inputs["obstacle"]),
        camber=math.radians(inputs["camber_deg"]),
    )
    progress(0.1)
    stands = standing_under(problem, asked["load"]) if asked["state"] == "standing" else None
    progress(0.6)
    hub = _hub_mass(inputs, needs, wheel) if asked["state"] == "free" else None
    found, shapes = wheel_modes(problem, asked["count"] + 1, state=stands, hub=hub, grip=asked["grip"])
    modes = found.whole_pairs(asked["count"])
    shapes = shapes[: len(modes.eigenvalue)]
    parts = tuple(dict.fromkeys(wheel.parts.tolist()))
    part = np.zeros(len(modes.points), dtype=np.int64)
    for number in range(len(parts) - 1, -1, -1):
        part[wheel.plates.plates[wheel.parts == parts[number]]] = number
    kept = KeptModes(modes=modes, parts=parts, part=part, half=False)
    write_modes(kept, out / MODES)
    np.savez_compressed(out / SHAPES, allow_pickle=False, shapes=shapes)
    write_shapes(modes.points, wheel.plates.plates[:, [0, 2, 3, 1]], modes.shape, out / FIELDS)
    draw(kept, out / FIELDS, out / PICTURE)
    numbers = {
        "dofs": wheel.basis.shape[1],
        "load_N": 0.0 if stands is None else stands.load,
        "deflection_m": 0.0 if stands is None else stands.deflection,
        "solve_s": time.perf_counter() - begun,
    }
    write_result(out, numbers)
    return int(wheel.basis.shape[1])


def _hub_mass(inputs: Mapping[str, Any], needs: Mapping[str, Path], wheel: AncfWheel) -> NDArray[np.float64]:
    """Mass matrix (6, 6) of the hub's parts that are no plates."""
    design, mesh = design_from(inputs["wheel"]), read_mesh(needs[inputs["mesh"]] / MESH)
    plates = {*wheel.parts.tolist(), "grousers"}  # layers of the rim's plates
    return rigid_mass(mesh, {part: design.materials[part].density for part in mesh.parts if part not in plates})
