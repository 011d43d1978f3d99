"""Task of the ANCF tire: one orientation.

Verified by tests/unit/test_workbench_tasks.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ancf_reduced.plates.mass import flexible_mass
from ancf_reduced.tire.static import tire_curve
from ancf_reduced.tire.surfaces import outer_face_error
from contracts.curves import write_curve
from workbench.execution.result_files import write_result
from workbench.study.ancf_tire import tire_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve_orientation"]


def solve_orientation(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Stiffness curve of the tire at one orientation: ``curve.csv`` and ``result.json``."""
    tire = tire_from(inputs)
    curve = tire_curve(tire, math.radians(inputs["orientation_deg"]), inputs["deflections"])
    write_curve(curve, out / "curve.csv")
    mass = flexible_mass(tire.model)
    write_result(out, {"flexible_mass_kg": mass, "outer_face_error_m": outer_face_error(tire)})
    progress(1.0)
    return int(tire.mesh.reference_coordinates()[tire.tie.free].size)
