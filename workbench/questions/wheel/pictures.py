"""Task of the report's stills. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.frames import ground_direction_h
from workbench.charts.stills import draw_deformed, draw_parts
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["draw"]


def draw(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``wheel.png``, and ``deformed_{load}N.png`` for each load at which the solver kept fields."""
    draw_parts(read_mesh(needs["mesh_whole"] / MESH), out / "wheel.png")
    progress(0.5)
    mesh = read_mesh(needs["mesh"] / MESH)
    direction = ground_direction_h(math.radians(inputs["orientation_deg"]))
    (solved,) = (folder for name, folder in needs.items() if name.startswith("fe_"))
    for fields in sorted(solved.glob("fields_*N.npz")):
        picture = out / f"{fields.stem.replace('fields', 'deformed')}.png"
        draw_deformed(mesh, fields, direction, inputs["yield_strength"], picture)
    progress(1.0)
    return 0
