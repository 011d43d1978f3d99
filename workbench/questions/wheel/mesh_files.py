"""Task that writes meshes for other programs. Verified by tests/end_to_end/test_commands.py."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geometry.msh import write_msh
from geometry.step import write_step
from geometry.vtu import write_vtu
from workbench.charts.stills import draw_parts
from workbench.questions.wheel.mesh_file import MESH, read_mesh
from workbench.questions.wheel.mesh_task import measure
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["write_files"]


def write_files(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Both meshes for other programs, the wheel as CAD, a summary and a picture."""
    design = design_from(inputs["wheel"])
    meshes = {"wheel": read_mesh(needs["mesh_whole"] / MESH), "solved": read_mesh(needs["mesh"] / MESH)}
    for i, (name, mesh) in enumerate(meshes.items()):
        write_msh(mesh, out / f"{name}.msh")
        write_vtu(mesh, out / f"{name}.vtu")
        progress(0.3 * (i + 1))
    write_step(design, out / "wheel.step")
    progress(0.8)
    draw_parts(meshes["wheel"], out / "wheel.png")
    summary = {name: measure(mesh, design) for name, mesh in meshes.items()}
    (out / "summary.json").write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    return 0
