"""Task that asks whether a fitted tire stands, and whether its mesh decides its load.

Verified by tests/unit/test_workbench_ancf_stands.py and tests/end_to_end/test_calibrate_ancf.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.standing import first_unstable, mesh_change
from ancf_reduced.tire.static import solve_tire
from contracts.errors import ConvergenceError
from workbench.execution.result_files import FAILURE, read_result, write_result
from workbench.study.ancf_tire import preset_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["LARGEST_CHANGE", "reasons_against", "stands"]

LARGEST_CHANGE = 0.05
"""Of the load on a doubled mesh, beyond which a tire's mesh decides what it carries [-]."""


def stands(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: ``unstable`` by orientation, ``mesh`` at some of them; of the fit that it needs.

    The tire is looked at at the deflections it was fitted at. A fit that failed has nothing to look at.
    """
    (folder,) = needs.values()
    fitted = read_result(folder)
    if fitted.get(FAILURE):
        write_result(out, {"unstable": [], "mesh": [], FAILURE: fitted[FAILURE]})
        return 0
    preset = preset_from(fitted["preset"])
    tire, deflections = build_tire(preset), fitted["deflections_m"]
    unstable, mesh = list[dict[str, Any]](), list[dict[str, Any]]()
    orientations, doubled = fitted["orientations_deg"], inputs["doubled_at_deg"]
    for i, orientation in enumerate(orientations):
        phi = math.radians(orientation)
        if (found := first_unstable(tire, solve_tire(tire, phi, deflections))) is not None:
            unstable.append({"orientation_deg": orientation, **asdict(found)})
        progress((i + 1.0) / (len(orientations) + 5.0 * len(doubled)))
    for i, orientation in enumerate(doubled):
        row: dict[str, Any] = {"orientation_deg": orientation}
        try:
            row |= asdict(mesh_change(preset, math.radians(orientation), deflections))
        except ConvergenceError as error:
            row |= {"largest": None, "deflection": None, "reached": 0.0, "error": str(error)}
        mesh.append(row)
        progress((len(orientations) + 5.0 * (i + 1.0)) / (len(orientations) + 5.0 * len(doubled)))
    write_result(out, {"unstable": unstable, "mesh": mesh, "last_deflection_m": deflections[-1]})
    return 0


def reasons_against(result: Mapping[str, Any]) -> list[str]:
    """Sentences, one a reason why the tire is not to be trusted; none for one that stands on a mesh that suffices."""
    found = []
    for row in result["unstable"]:
        where = f"{1e3 * row['deflection']:.1f} mm, {row['load']:.0f} N at {row['orientation_deg']:g} deg"
        place = f"most at {row['angle_deg']:.0f} deg, {1e3 * row['radius']:.0f} mm from the axle"
        found.append(f"it does not stand from {where} on: {row['count']} negative eigenvalues, moving {place}")
    for row in result["mesh"]:
        at = f"at {row['orientation_deg']:g} deg"
        if row["largest"] is None:
            found.append(f"on twice as many plates it has no equilibrium {at}")
        elif row["reached"] < result["last_deflection_m"] - 1e-9:
            found.append(f"on twice as many plates it has no equilibrium beyond {1e3 * row['reached']:.1f} mm {at}")
        elif abs(row["largest"]) > LARGEST_CHANGE:
            change = f"{100.0 * row['largest']:+.0f} % of its load at {1e3 * row['deflection']:.1f} mm"
            found.append(f"twice as many plates change {change} {at}: its mesh decides what it carries")
    return found
