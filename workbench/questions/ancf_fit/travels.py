"""Stiffnesses against the hub's travel in the fit of the ANCF tire: those of the FE wheel, and a tire's beside them.

Verified by tests/unit/test_workbench_ancf_fit_travel.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ancf_reduced.fit.travel_fit import TravelData, travel_stiffness
from ancf_reduced.tire.mesh import Tire
from ancf_reduced.tire.static import solve_tire
from contracts.errors import ConvergenceError, InputError
from contracts.hub_travel import Way
from workbench.questions.ancf_fit.records import TravelRow
from workbench.questions.travel_files import travel_curves

__all__ = ["fe_travels", "travel_rows"]


def fe_travels(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], orientations_deg: Sequence[float]
) -> TravelData | None:
    """What the FE runs found, as data of the fit, at some orientations [deg]; None if the study does not ask.

    Raises
    ------
    InputError
        For a run that ended before its first step.
    """
    asked = inputs.get("travel")
    if asked is None:
        return None
    ways = tuple(Way(name) for name in asked["ways"])
    found = {(c.way, c.orientation_deg): c.stiffness for c in travel_curves("fe", ways, orientations_deg, needs)}
    lacking = [f"{way} at {o:g} deg" for o in orientations_deg for way in ways if (way, o) not in found]
    if lacking:
        rule = "ended before the hub's first step"
        raise InputError("FE travels", ", ".join(lacking), rule, "try another ancf_fit.travel.load")
    stiffness = np.array([[found[way, o] for way in ways] for o in orientations_deg])
    return TravelData(ways=ways, load=asked["load"], stiffness=stiffness, weight=asked["weight"])


def travel_rows(
    tire: Tire, data: TravelData | None, orientations_deg: Sequence[float], deflections: Sequence[float]
) -> tuple[TravelRow, ...]:
    """A tire beside the FE wheel; the deflections (n,) [m] are those between which it comes to the load."""
    if data is None:
        return ()
    rows = []
    for o, solid in zip(orientations_deg, data.stiffness, strict=True):
        try:
            one = replace(data, stiffness=solid[None])
            own = travel_stiffness(tire, [solve_tire(tire, math.radians(o), deflections)], one)[0].tolist()
        except (InputError, ConvergenceError):
            own = [None] * len(data.ways)
        rows += [_row(way, o, fe, s) for way, fe, s in zip(data.ways, solid.tolist(), own, strict=True)]
    return tuple(rows)


def _row(way: Way, orientation_deg: float, fe: float, tire: float | None) -> TravelRow:
    return TravelRow(
        way=way.value,
        orientation_deg=orientation_deg,
        unit="N m/rad" if way.turns else "N/m",
        fe=fe,
        tire=tire,
        difference=None if tire is None else tire / fe - 1.0,
    )
