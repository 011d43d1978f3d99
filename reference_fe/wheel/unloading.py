"""The way back of a pressed wheel: where the ground goes next, and how flat the wheel stays when it has left.

Verified by tests/verification/test_fe_unloading.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.problem import WheelProblem, ground_contact

__all__ = ["FORCE_SHARE", "at_end", "next_deflection", "permanent_set", "unloading_curve"]

FORCE_SHARE = 0.1
"""Of the largest load, added to the forces that residuals are held against on the way back: none are left there."""

type Rows = Sequence[Mapping[str, float]]


def next_deflection(case: WheelLoadCase, rows: Rows, returned: Rows, reached: float) -> float | None:
    """Control parameter of the ground's next stop [m], by the rows up and back so far; None at the end.

    Up through the load case's deflections, and what travel follows them, to the maximum load; then, if it unloads, down
    through the same deflections and below first touch, until no load is left.
    """
    if not returned and not at_end(case, rows):
        ahead = [*case.deflections, *(case.travel.controls if case.travel is not None else ())]
        return next((target for target in ahead if target > reached), None)
    if not case.unload or (returned and returned[-1]["load_N"] == 0.0):
        return None
    if lower := [target for target in (0.0, *case.deflections) if target < reached]:
        return lower[-1]
    return min(-2.0 * case.contact_ramp, 2.0 * reached)


def at_end(case: WheelLoadCase, rows: Rows) -> bool:
    """Whether the way up has ended."""
    last = rows[-1]
    ended = last["load_N"] >= case.maximum_load or last["deflection_m"] >= case.deflections[-1]
    return case.travel is None and ended


def permanent_set(wheel: WheelProblem, load_case: WheelLoadCase) -> float:
    """Deflection at which the ground, coming back to the wheel as it is now, free of load, would touch it [m]."""
    problem = wheel.problem
    now = replace(wheel.mesh, points=wheel.mesh.points + problem.nodal_displacement())
    return wheel.contact.distance_at_touch - ground_contact(now, load_case).distance_at_touch


def unloading_curve(up: StiffnessCurve, top: Mapping[str, float], back: Rows, ramp: float) -> StiffnessCurve | None:
    """The curve of the way back, deflections ascending; None where there is nothing of it.

    It begins at the permanent set if the ground has left the wheel, and is partial if not. Its last point is the
    curve's ``top``. Rows within the contact's ``ramp`` [m] of the set are left out: there the ground touches with next
    to no load.
    """
    if not back:
        return None
    left, kept = back[-1]["load_N"] == 0.0, list(back)
    if left:
        kept = [row for row in back[:-1] if row["deflection_m"] > back[-1]["deflection_m"] + ramp] + [back[-1]]
    rows = [*reversed(kept), top]
    table: dict[str, NDArray[np.float64]] = {
        name: np.array([row.get(name, 0.0) for row in rows]) for name in ("deflection_m", "load_N", *up.columns)
    }
    return StiffnessCurve(
        model=f"{up.model}_unloading",
        orientation_deg=up.orientation_deg,
        deflection=table.pop("deflection_m"),
        load=table.pop("load_N"),
        columns=table,
        source=f"{up.source}; on the way back",
        partial=not left,
    )
