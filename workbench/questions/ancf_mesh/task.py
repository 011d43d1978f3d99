"""Task: the ANCF tire with another number of plates around its rim.

Verified by tests/unit/test_workbench_ancf_mesh.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import TirePreset, refined_preset
from ancf_reduced.tire.static import TireEquilibria, solve_tire
from ancf_reduced.tire.surfaces import outer_face_error
from contracts.errors import ConvergenceError
from workbench.execution.result_files import write_result

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve_refined"]


def solve_refined(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Loads at chosen deflections and orientations: ``result.json``; None where no equilibrium was found."""
    values: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in inputs["preset"].items()}
    tire = build_tire(refined_preset(TirePreset(**values), inputs["plates"]))
    loads: dict[str, list[float | None]] = {}
    for done, orientation in enumerate(inputs["orientations_deg"], start=1):
        wanted = inputs["deflections"]
        try:
            found: list[float] = solve_tire(tire, math.radians(orientation), wanted).load.tolist()
        except ConvergenceError as error:
            found = error.last_good.load.tolist() if isinstance(error.last_good, TireEquilibria) else []
        loads[f"{orientation:g}"] = [*found, *[None] * (len(wanted) - len(found))]
        progress(done / len(inputs["orientations_deg"]))
    unknowns = 12 * len(tire.tie.free)
    write_result(out, {"loads": loads, "outer_face_error_m": outer_face_error(tire), "dofs": unknowns})
    return unknowns
