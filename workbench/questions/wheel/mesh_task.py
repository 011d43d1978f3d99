"""Tasks of the mesh: built, checked against its design, measured.

Verified by tests/unit/test_workbench_tasks.py and tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.checks import check_matches_design, check_mesh
from geometry.summary import summarize_mesh
from geometry.wheel import WheelDesign
from workbench.execution.result_files import write_result
from workbench.questions.wheel.mesh_file import MESH, write_mesh
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["build", "measure"]


def build(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Build one mesh and check it: ``mesh.npz``, ``result.json``."""
    design = design_from(inputs["wheel"])
    mesh = build_mesh(design, **inputs["options"])
    progress(0.6)
    check_mesh(mesh)
    check_matches_design(mesh, design)
    write_mesh(mesh, out / MESH)
    write_result(out, measure(mesh, design))
    progress(1.0)
    return 0


def measure(mesh: TaggedMesh, design: WheelDesign) -> dict[str, Any]:
    """Geometry's summary of a mesh, with totals over the parts meshed [m^3, kg]."""
    summary = summarize_mesh(mesh, design)
    parts = summary.parts.values()
    return {
        **summary.as_dict(),
        "total_mass_closed_form": sum(p.mass_closed_form for p in parts),
        "total_volume": sum(p.volume for p in parts),
        "total_volume_closed_form": sum(p.volume_closed_form for p in parts),
    }
