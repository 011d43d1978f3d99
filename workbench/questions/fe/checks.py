"""Checks of the continuum model: how far curves go, how they vary around the wheel, springs that pass into the rim.

Verified by tests/unit/test_workbench_checks.py and tests/unit/test_workbench_limits.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check, Role
from workbench.questions.fe.results import PartsDepth
from workbench.questions.model_curves import ModelCurves
from workbench.questions.models.metrics import largest_spread
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_least, at_most

__all__ = ["overlap_checks", "parts_overlap_check", "reach_check", "spread_checks"]

_SWEEP = "Samarini 2020, section 3.2 and Fig. 20: 160 to 250 N on a wheel; the room beyond is ours"
_SPREAD_AT = (0.005, 0.020, 0.030)
GAP = "spring_rim_gap_m"
_OVERLAP_ALLOWED = 50e-6
"""Less than a tenth of the strips' thickness."""
_LOADS = (160.0, 250.0)


def spread_checks(
    fe: ModelCurves, tolerances: ToleranceSection, up_to: float, *, of_the_thesis: bool = False
) -> list[Check]:
    """How much the load varies around the wheel at those of three deflections that lie within ``up_to`` [m].

    A single orientation of any but the thesis' wheel is asked none.
    """
    curves = list(fe.by_orientation.values())
    return [
        at_most(
            _claim(
                f"fe.spread_{d * 1e3:g}mm",
                f"FE: (largest - smallest) / mean load over the orientations at {d * 1e3:g} mm",
                "spread",
                "-",
                "finding",
                "the thesis says that stiffness varies around the wheel, not how much; the limit is ours",
            ),
            partial(_spread, curves, d),
            tolerances.orientation_spread,
        )
        for d in _SPREAD_AT
        if d <= up_to and (len(curves) > 1 or of_the_thesis)
    ]


def _spread(curves: list[StiffnessCurve], deflection: float) -> float:
    if len(curves) < 2:
        rule = "needs at least two to have a spread"
        raise InputError("orientations", len(curves), rule, "add another to fe.orientations")
    return largest_spread(curves, deflection)


def reach_check(fe: ModelCurves, tol: ToleranceSection) -> Check:
    """How far every orientation came: what the wheel does, no matter of the computation, and so a finding."""

    def reach() -> float:
        ends = [
            (c.deflection[-1] / tol.reach_deflection, c.load.max() / tol.reach_load) for c in fe.by_orientation.values()
        ]
        return float(min(max(pair) for pair in ends))

    goal = f"{tol.reach_deflection * 1e3:g} mm or {tol.reach_load:g} N"
    claim = _claim("fe.reach", f"FE: every orientation reaches {goal}", "part reached", "-", "finding", _SWEEP)
    return at_least(claim, reach, 1.0)


def _claim(id: str, title: str, quantity: str, unit: str, role: Role, source: str) -> Claim:
    return Claim(id=id, title=title, quantity=quantity, unit=unit, role=role, source=source)


def overlap_checks(fe: ModelCurves, *, inner_contact: bool, up_to: float = math.inf) -> list[Check]:
    """How far the springs pass into the rim up to each wheel load of the sweep, or up to a smaller ``up_to`` [N].

    A gate where contact holds them off and a curve goes so far: what no curve reaches is not known, but no failure.
    """
    largest = max(float(curve.load.max()) for curve in fe.by_orientation.values())
    without = "" if inner_contact else " (their contact is switched off)"
    return [
        at_most(
            Claim(
                id=f"fe.spring_rim_overlap_{load:g}N",
                title=f"FE: springs pass into the rim by, up to {load:g} N{without}",
                quantity="overlap",
                unit="m",
                role="gate" if inner_contact and largest >= load else "finding",
                source="none should: what is left is the penalty's penetration; the limit is ours",
            ),
            partial(_largest_overlap, list(fe.by_orientation.values()), load),
            _OVERLAP_ALLOWED,
        )
        for load in dict.fromkeys(min(load, up_to) for load in _LOADS)
    ]


def parts_overlap_check(found: Mapping[str, PartsDepth], *, inner_contact: bool) -> Check:
    """Deepest overlap of any two parts at any curve's last point, searched for in the deformed shape alone.

    A gate where contact holds the parts off.
    """
    worst = max(found.values(), key=lambda one: one.depth, default=None)
    where = "" if worst is None or worst.depth == 0.0 else f" ({' in '.join(worst.parts)}, {worst.load:.0f} N)"
    claim = Claim(
        id="fe.parts_overlap",
        title=f"FE: deepest overlap of any two parts at any curve's last point{where}",
        quantity="overlap",
        unit="m",
        role="gate" if inner_contact else "finding",
        source="none should: what is left is the penalty's penetration; the limit is ours",
    )
    return at_most(claim, lambda: math.nan if worst is None else worst.depth, _OVERLAP_ALLOWED)


def _largest_overlap(curves: list[StiffnessCurve], load: float) -> float:
    """Largest overlap at any point with at most this load, of any curve that reaches it or ends before [m]."""
    recorded = [curve for curve in curves if GAP in curve.columns]
    if not recorded or max(curve.load.max() for curve in recorded) < load:
        raise InputError("overlap", f"{load:g} N", "lies beyond every curve", "compute the curves further")
    return max(float(np.max(-curve.columns[GAP][curve.load <= load], initial=0.0)) for curve in recorded)
