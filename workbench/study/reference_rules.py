"""Rules between [reference] and the curves it is held against.

Verified by tests/unit/test_workbench_reference.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from workbench.study.broken_rule import BrokenRule
from workbench.study.model import Study

__all__ = ["broken_reference"]


def broken_reference(study: Study) -> Iterator[BrokenRule]:
    """Orientations that are none of the FE's, and what lies beyond its curves or contradicts itself."""
    reference, fe = study.reference, study.fe
    if reference is None:
        return
    slope = reference.slope
    asked: list[tuple[str, float | None]]
    asked = [("slope.orientations", angle) for angle in (slope.orientations or () if slope else ())]
    asked += [(f"curves[{k}].orientation", one.orientation) for k, one in enumerate(reference.curves)]
    for key, angle in asked:
        if angle is not None and not any(abs(angle - o) < 1e-9 for o in fe.orientations):
            value, rule = f"{math.degrees(angle):g} deg", "must be one of fe.orientations"
            yield BrokenRule(key=f"reference.{key}", value=value, rule=rule, hint="add it there")
    if slope is not None and slope.up_to > fe.max_deflection * (1.0 + 1e-9):
        rule = f"must not exceed fe.max_deflection = {1e3 * fe.max_deflection:g} mm"
        key, value = "reference.slope.up_to", f"{1e3 * slope.up_to:g} mm"
        yield BrokenRule(key=key, value=value, rule=rule, hint="take it over less, or compute the curve further")
    if reference.band is not None:
        yield from _of_the_points(study)


def _of_the_points(study: Study) -> Iterator[BrokenRule]:
    """Points of the band within the range of the FE curves, and in an order that one curve can follow."""
    assert study.reference is not None
    assert study.reference.band is not None
    points, fe = study.reference.band.points, study.fe
    for k, point in enumerate(points):
        for name, number, end, unit, scale in (
            ("load", point.load, ("max_load", fe.max_load), "N", 1.0),
            ("low", point.low, ("max_deflection", fe.max_deflection), "mm", 1e3),
        ):
            if end[1] is not None and number > end[1] * (1.0 + 1e-9):
                key, value = f"reference.band.points[{k}].{name}", f"{scale * number:g} {unit}"
                rule = f"lies beyond fe.{end[0]} = {scale * end[1]:g} {unit}, where the curves end"
                yield BrokenRule(key=key, value=value, rule=rule, hint=f"raise fe.{end[0]}, or leave the point out")
    ordered = sorted(enumerate(points), key=lambda one: one[1].load)
    for (_, before), (k, point) in pairwise(ordered):
        lower = max((p for _, p in ordered if p.load <= before.load), key=lambda p: p.low)
        if f"{point.load:g}" == f"{before.load:g}" or point.high < lower.low:
            lower = before if f"{point.load:g}" == f"{before.load:g}" else lower
            key, value = f"reference.band.points[{k}]", f"{1e3 * point.low:g} to {1e3 * point.high:g} mm"
            rule = f"contradicts {1e3 * lower.low:g} to {1e3 * lower.high:g} mm at {lower.load:g} N: "
            rule += "one load once, and the deflection does not fall as the load rises"
            yield BrokenRule(key=key, value=value, rule=rule, hint="correct one of the two")
