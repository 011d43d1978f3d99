"""Whether springs keep clear of the rings they join, of themselves and of each other.

Strips are compared by their centrelines as polylines: two strips overlap where these come closer than the mean of their
thicknesses. What that costs depends on the number of strips only, not on any dimension. Verified by
tests/unit/test_geometry_validation.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely  # type: ignore[import-untyped]
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.parts import SpringSet
from geometry.springs import Leg, leg_sides, polar, spring_leg, station_angles, weld_angle

__all__ = ["bends_one_way", "overlaps_itself", "require_clear_of_rings", "require_clear_sets"]

Array = NDArray[np.float64]

_MOST_PIECES = 2048
"""Pieces of a centreline that are held against each other."""
_WELD_STEP = math.radians(1.0)


def require_clear_of_rings(springs: SpringSet, gap: tuple[float, float], key: str = "") -> None:
    """Raise InputError if a strip crosses one of its rings, bends sharper than its thickness allows or crosses itself.

    Parameters
    ----------
    springs : the set
    gap : (hub, rim): radii [m] of the surfaces between which the springs lie
    key : where the set stands in its wheel
    """
    leg = spring_leg(springs, gap, 0.0, leg_sides(springs)[0])
    half, what = 0.5 * springs.largest_thickness, f"{springs.name} shape"
    radius = np.linalg.norm(leg.points, axis=1)
    own = 0.5 * springs.thickness_at(np.linspace(0.0, 1.0, len(radius)))
    if np.any(radius < gap[0] + own - 1e-7) or np.any(radius > gap[1] - own + 1e-7):
        text = f"centreline at radius {radius.min() * 1e3:.4g}..{radius.max() * 1e3:.4g} mm"
        rule = f"crosses the hub or the rim, whose surfaces lie at {gap[0] * 1e3:.4g} and {gap[1] * 1e3:.4g} mm"
        raise InputError(what, text, rule, "move the spline's points into the gap", key=f"{key}.shape")
    step = leg.length / (len(leg.points) - 1)
    bend = 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(np.diff(leg.normals, axis=0), axis=1), 0.0, 1.0)) / step
    if bend.max() * half >= 1.0:
        text = f"smallest bend radius {1e3 / bend.max():.4g} mm"
        raise InputError(
            what, text, f"must exceed half the thickness, {half * 1e3:.4g} mm", "smooth the spline", key=f"{key}.shape"
        )
    if not bends_one_way(leg) and overlaps_itself(leg, springs.largest_thickness):
        raise InputError(
            what, springs.shape, "the strip overlaps itself", "move the spline's points apart", key=f"{key}.shape"
        )


def require_clear_sets(sets: Sequence[SpringSet], gap: tuple[float, float], keys: Sequence[str]) -> None:
    """Raise InputError if springs of one set overlap, or those of two sets that share (or touch) an axial band.

    ``gap`` is (hub, rim), radii [m] as in `require_clear_of_rings`; ``keys`` say where the sets stand in their wheel.
    """
    strips = [_strips(springs, gap) for springs in sets]
    for i, (first, own) in enumerate(zip(sets, strips, strict=True)):
        if _any_within(own[:1], own[1:], first.largest_thickness):
            rule = "springs of the set overlap each other"
            raise InputError(
                f"{first.name} count",
                first.count,
                rule,
                "use fewer springs, or an arc instead of a hoop",
                key=f"{keys[i]}.count",
            )
        for second, others in zip(sets[i + 1 :], strips[i + 1 :], strict=True):
            thickness = 0.5 * (first.largest_thickness + second.largest_thickness)
            if _share_band(first, second) and _any_within(own, others, thickness):
                rule = "their springs overlap or cross in a shared or touching axial band"
                hint = "turn one set (phase) or separate their bands"
                raise InputError("spring sets", f"{first.name} and {second.name}", rule, hint, key="spring_sets")


def _share_band(a: SpringSet, b: SpringSet) -> bool:
    return any(y0 <= z1 and z0 <= y1 for y0, y1 in a.bands for z0, z1 in b.bands)


def _any_within(strips: Sequence[shapely.Geometry], others: Sequence[shapely.Geometry], thickness: float) -> bool:
    """Whether one of the ``strips`` comes closer than ``thickness`` [m] to one of the ``others``."""
    tree, limit = shapely.STRtree(others), thickness * (1.0 - 1e-9)
    return any(len(tree.query(strip, predicate="dwithin", distance=limit)) for strip in strips)


def bends_one_way(leg: Leg) -> bool:
    """Whether a strip bends to one side only, through half a turn at most: then it does not overlap itself.

    Two places on it, l apart along it with an angle of 2 a between their tangents, are as far apart along the mean
    tangent as the cosine of the angle to that is long along the strip. Where no bend is sharper than r that is at least
    2 r sin a + (l - 2 r a) cos a, least at a quarter turn, a = pi / 2: 2 r, more than the strip's thickness, for r is
    more than half of that.
    """
    x, y = leg.normals.T
    turns = np.arctan2(x[:-1] * y[1:] - y[:-1] * x[1:], x[:-1] * x[1:] + y[:-1] * y[1:])
    side = 1.0 if turns.sum() > 0.0 else -1.0
    return bool(np.all(side * turns >= -1e-12) and abs(turns.sum()) <= math.pi * (1.0 + 1e-9))


def overlaps_itself(leg: Leg, thickness: float) -> bool:
    """Whether two places of a strip, three thicknesses [m] apart along it, come closer than one thickness."""
    line = _divided(leg.points, max(0.25 * thickness, leg.length / _MOST_PIECES))
    pieces = shapely.linestrings(np.stack([line[:-1], line[1:]], axis=1))
    first, second = shapely.STRtree(pieces).query(pieces, predicate="dwithin", distance=thickness)
    between = (second - first - 1) * leg.length / len(pieces)
    return bool(np.any(between > 3.0 * thickness))


def _divided(points: Array, step: float) -> Array:
    """Points along the polyline, spaced at most ``step`` [m]."""
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    new = np.linspace(0.0, at[-1], max(2, math.ceil(at[-1] / step) + 1))
    return np.column_stack([np.interp(new, at, points[:, 0]), np.interp(new, at, points[:, 1])])


def _strips(springs: SpringSet, gap: tuple[float, float]) -> list[shapely.Geometry]:
    """Centrelines of each spring of a set, its two weld layers included: the first one's, turned."""
    hub, rim = gap
    half_angle = 0.5 * weld_angle(springs, rim)
    station, *_ = stations = station_angles(springs)
    on_weld = np.linspace(station - half_angle, station + half_angle, 2 + math.ceil(2.0 * half_angle / _WELD_STEP))
    pieces = [spring_leg(springs, gap, station, side).points for side in leg_sides(springs)]
    for radius in (rim - 0.5 * springs.thickness, hub + 0.5 * springs.hub_thickness):
        pieces.append(np.array([polar(radius, angle) for angle in on_weld]))
    turns = [(math.cos(angle), math.sin(angle)) for angle in stations - station]
    return [shapely.MultiLineString([p @ np.array([[c, s], [-s, c]]) for p in pieces]) for c, s in turns]
