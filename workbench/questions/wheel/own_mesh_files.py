"""Task that writes a mesh from another program as this one does. Verified by tests/end_to_end/test_own_mesh.py."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geometry.msh import write_msh
from geometry.vtu import write_vtu
from workbench.charts.stills import draw_parts
from workbench.execution.result_files import RESULT
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["write_files"]


def write_files(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """The mesh as it is solved for other programs, a summary and a picture."""
    mesh = read_mesh(needs["mesh"] / MESH)
    write_msh(mesh, out / "solved.msh")
    write_vtu(mesh, out / "solved.vtu")
    progress(0.5)
    draw_parts(mesh, out / "wheel.png")
    shutil.copyfile(needs["mesh"] / RESULT, out / "summary.json")
    return 0
