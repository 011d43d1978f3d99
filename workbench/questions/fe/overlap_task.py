"""Task: how deep the wheel's parts lie in one another at the last point of each curve, from the deformed shape alone.

Verified by tests/unit/test_workbench_overlap.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reference_fe.contact.parts_overlap import PartsOverlap
from workbench.execution.result_files import write_result
from workbench.questions.fe.field_file import POINTS_FILE, read_points
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["measure"]


def measure(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Deepest overlap at each curve's last point: ``result.json``, curve's task -> load [N], depth [m], parts, place.

    Needs the mesh and curves on it with fields at their points; a curve of which no point converged is left out.
    """
    overlap = PartsOverlap(read_mesh(needs[inputs["mesh"]] / MESH))
    curves, found = [name for name in needs if name != inputs["mesh"]], {}
    for done, name in enumerate(curves, 1):
        if (needs[name] / POINTS_FILE).is_file():
            *_, (load, displacement, _) = read_points(needs[name] / POINTS_FILE)
            found[name] = {"load_N": load} | asdict(overlap.deepest(displacement))
        progress(done / len(curves))
    write_result(out, found)
    return 0
