"""The way back of a pressed wheel, as its task leaves it, and what remains of it.

Verified by tests/unit/test_workbench_unloading.py and tests/end_to_end/test_materials_page.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from workbench.study.orientation import orientation_name

__all__ = ["UNLOADING", "Unloading", "loop_energy", "unloadings"]

UNLOADING = "unloading.csv"
"""In a task's folder."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unloading:
    """The way back at one orientation.

    Attributes
    ----------
    orientation_deg : what faces the ground [deg]
    curve : deflections ascending, from the permanent set to where the way back began
    permanent_set : deflection at which no load is left [m]; None where the run ended before
    lost : energy lost in the loop, work there less work back [J]; None likewise
    work : there [J]
    """

    orientation_deg: float
    curve: StiffnessCurve
    permanent_set: float | None
    lost: float | None
    work: float


def loop_energy(there: StiffnessCurve, back: StiffnessCurve) -> float:
    """Work there less work back, by the trapezoid rule over the points of both [J]."""
    return float(np.trapezoid(there.load, there.deflection) - np.trapezoid(back.load, back.deflection))


def unloadings(curves: Mapping[float, StiffnessCurve], folders: Mapping[str, Path]) -> dict[float, Unloading]:
    """The ways back of curves by orientation [deg], from the folders of their tasks; of those that have one."""
    found = {}
    for orientation, there in curves.items():
        path = folders[orientation_name("fe", orientation)] / UNLOADING
        if not path.exists():
            continue
        back = read_curve(path, model="fe_unloading", orientation_deg=orientation)
        found[orientation] = Unloading(
            orientation_deg=orientation,
            curve=back,
            permanent_set=None if back.partial else float(back.deflection[0]),
            lost=None if back.partial else loop_energy(there, back),
            work=float(np.trapezoid(there.load, there.deflection)),
        )
    return found
