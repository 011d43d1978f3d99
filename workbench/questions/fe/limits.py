"""Checks on which mean is meant, and on how well contact holds the springs off the rim.

Verified by tests/unit/test_workbench_limits.py.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.model_curves import ModelCurves
from workbench.study.model import Band
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_most, near

__all__ = ["circumferential_tangent_check", "overlap_checks"]

GAP = "spring_rim_gap_m"
_OVERLAP_ALLOWED = 50e-6
"""Less than a tenth of the strips' thickness."""
_LOADS = (160.0, 250.0)


def circumferential_tangent_check(
    fe: ModelCurves, band: Band, tolerances: ToleranceSection, period_deg: float = 360.0
) -> Check:
    """Initial tangent of the mean around the wheel, each orientation weighted by the arc it stands for.

    Orientations that cover one period [deg] of the wheel evenly weigh alike.
    """
    up_to = tolerances.initial_tangent_up_to
    claim = Claim(
        id="fe.initial_tangent_around",
        title="FE: the same slope, of the mean that weights each orientation by the arc it stands for",
        quantity="initial tangent",
        unit="N/m",
        role="finding",
        source=f"{band.source}; which mean the thesis means is not known",
    )
    return near(claim, lambda: _tangent_around(fe, up_to, period_deg), band.initial_tangent, tolerances.initial_tangent)


def _tangent_around(fe: ModelCurves, up_to: float, period_deg: float) -> float:
    angles = np.array(sorted(fe.by_orientation))
    if len(angles) < 2:
        raise InputError("orientations", len(angles), "two or more are needed for a mean", "add an orientation")
    tangents = np.array([fe.by_orientation[angle].initial_tangent(up_to) for angle in angles])
    steps = np.diff([*angles, angles[0] + period_deg])
    if np.allclose(steps, steps[0]):
        return float(tangents.mean())
    return float(np.trapezoid(tangents, angles) / (angles[-1] - angles[0]))


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


def _largest_overlap(curves: list[StiffnessCurve], load: float) -> float:
    """Largest overlap at any point with at most this load, of any curve that reaches it or ends before [m]."""
    recorded = [curve for curve in curves if GAP in curve.columns]
    if not recorded or max(curve.load.max() for curve in recorded) < load:
        raise InputError("overlap", f"{load:g} N", "lies beyond every curve", "compute the curves further")
    return max(float(np.max(-curve.columns[GAP][curve.load <= load], initial=0.0)) for curve in recorded)
