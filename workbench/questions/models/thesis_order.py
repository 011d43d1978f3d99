"""The thesis' two statements in its own order: the brush line at small deflection, then the ANCF tire over the sweep.

Verified by tests/unit/test_workbench_thesis_order.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError

__all__ = ["SEEN", "Secant", "leaves", "over_the_sweep", "secants"]

TOLD_AT = (0.005, 0.010, 0.020, 0.030)
"""Deflections of the secants [m]."""
SWEEP = (160.0, 250.0)
"""Loads of the thesis' comparison of the ANCF tire [N] (Samarini 2020, section 3.2)."""
SEEN = 0.05
"""Relative difference that two curves of one figure may have unseen [-]; ours."""
_SAMPLES = 201


@dataclass(frozen=True, slots=True, kw_only=True)
class Secant:
    """Load over deflection at ``deflection`` [m]: of the FE average [N/m], and relative differences from it [-].

    None where a curve does not reach, or the study has no such tire.
    """

    deflection: float
    average: float | None
    brush: float | None
    ancf: float | None


def secants(average: StiffnessCurve, brush: StiffnessCurve | None, ancf: StiffnessCurve | None) -> list[Secant]:
    """Of the average by arc, and of both tires beside it."""
    found = []
    for at in TOLD_AT:
        own = _secant(average, at)
        others = [None if one is None else _secant(one, at) for one in (brush, ancf)]
        off = [None if own is None or one is None else one / own - 1.0 for one in others]
        found.append(Secant(deflection=at, average=own, brush=off[0], ancf=off[1]))
    return found


def _secant(curve: StiffnessCurve, deflection: float) -> float | None:
    try:
        return float(curve.load_at(deflection)) / deflection
    except InputError:
        return None


def leaves(average: StiffnessCurve, tire: StiffnessCurve) -> tuple[float, float] | None:
    """First deflection [m] from 5 mm on at which a tire's load differs from the average's by more than `SEEN`, and
    the average's load there [N]; None if it does so nowhere on their common range, up to the sweep's 250 N."""
    end = min(average.deflection[-1], tire.deflection[-1])
    if end <= TOLD_AT[0]:
        return None
    at = np.linspace(TOLD_AT[0], end, _SAMPLES)
    own = average.load_at(at)
    beyond = (np.abs(tire.load_at(at) / own - 1.0) > SEEN) & (own <= SWEEP[1])
    if not beyond.any():
        return None
    first = int(beyond.argmax())
    return float(at[first]), float(own[first])


def over_the_sweep(average: StiffnessCurve, tire: StiffnessCurve) -> tuple[float, float] | None:
    """Smallest and largest relative difference of a tire's load where the average carries the sweep's 160 to 250 N [-].

    None where either ends before.
    """
    try:
        at = np.linspace(average.deflection_at(SWEEP[0]), average.deflection_at(SWEEP[1]), _SAMPLES)
        off = tire.load_at(at) / average.load_at(at) - 1.0
    except InputError:
        return None
    return float(off.min()), float(off.max())
