"""Whether springs keep clear of the rings they join, of themselves and of each other.

Strips are compared by their centrelines, sampled at a quarter of the thinner strip: two strips overlap where the
centrelines come closer than the mean of their thicknesses. Verified by tests/unit/test_geometry_validation.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from contracts.errors import InputError
from geometry.parts import SpringSet
from geometry.springs import leg_sides, polar, spring_leg, station_angles, weld_angle

__all__ = ["require_clear_of_rings", "require_clear_sets"]

Array = NDArray[np.float64]


def require_clear_of_rings(springs: SpringSet, gap: tuple[float, float]) -> None:
    """Raise InputError if a strip crosses one of its rings, bends sharper than its thickness allows or crosses itself.

    Parameters
    ----------
    springs : the set
    gap : (hub, rim): radii [m] of the surfaces between which the springs lie
    """
    leg = spring_leg(springs, gap, 0.0, leg_sides(springs)[0])
    half, what = 0.5 * springs.thickness, f"{springs.name} shape"
    radius = np.linalg.norm(leg.points, axis=1)
    if radius.min() < gap[0] + half - 1e-7 or radius.max() > gap[1] - half + 1e-7:
        text = f"centreline at radius {radius.min() * 1e3:.4g}..{radius.max() * 1e3:.4g} mm"
        rule = f"crosses the hub or the rim, whose surfaces lie at {gap[0] * 1e3:.4g} and {gap[1] * 1e3:.4g} mm"
        raise InputError(what, text, rule, "move the spline's points into the gap")
    step = leg.length / (len(leg.points) - 1)
    bend = 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(np.diff(leg.normals, axis=0), axis=1), 0.0, 1.0)) / step
    if bend.max() * half >= 1.0:
        text = f"smallest bend radius {1e3 / bend.max():.4g} mm"
        raise InputError(what, text, f"must exceed half the thickness, {half * 1e3:.4g} mm", "smooth the spline")
    line = _densify(leg.points, 0.25 * springs.thickness)
    pairs = cKDTree(line).query_pairs(springs.thickness, output_type="ndarray")
    spacing = leg.length / (len(line) - 1)
    if np.any(np.abs(np.diff(pairs, axis=1)) * spacing > 3.0 * springs.thickness):
        raise InputError(what, springs.shape, "the strip overlaps itself", "move the spline's points apart")


def require_clear_sets(sets: Sequence[SpringSet], gap: tuple[float, float]) -> None:
    """Raise InputError if springs of one set overlap, or those of two sets that share (or touch) an axial band."""
    for i, first in enumerate(sets):
        lines = _set_lines(first, gap, 0.25 * first.thickness)
        if len(lines) > 1 and _distance(lines[0], np.concatenate(lines[1:])) < first.thickness * (1.0 - 1e-9):
            rule = "springs of the set overlap each other"
            raise InputError(f"{first.name} count", first.count, rule, "use fewer springs, or an arc instead of a hoop")
        for second in sets[i + 1 :]:
            thickness = 0.5 * (first.thickness + second.thickness)
            step = 0.25 * min(first.thickness, second.thickness)
            if not _share_band(first, second):
                continue
            a, b = (np.concatenate(_set_lines(springs, gap, step)) for springs in (first, second))
            if _distance(a, b) < thickness * (1.0 - 1e-9):
                rule = "their springs overlap or cross in a shared or touching axial band"
                hint = "turn one set (phase) or separate their bands"
                raise InputError("spring sets", f"{first.name} and {second.name}", rule, hint)


def _share_band(a: SpringSet, b: SpringSet) -> bool:
    return any(y0 <= z1 and z0 <= y1 for y0, y1 in a.bands for z0, z1 in b.bands)


def _distance(a: Array, b: Array) -> float:
    distance, _ = cKDTree(b).query(a)
    return float(np.min(distance))


def _densify(points: Array, step: float) -> Array:
    """Points along the polyline, spaced at most ``step`` [m]."""
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    new = np.linspace(0.0, at[-1], max(2, math.ceil(at[-1] / step) + 1))
    return np.column_stack([np.interp(new, at, points[:, 0]), np.interp(new, at, points[:, 1])])


def _set_lines(springs: SpringSet, gap: tuple[float, float], step: float) -> list[Array]:
    """Centreline points of each spring of a set, its two weld layers included."""
    hub, rim = gap
    half_angle = 0.5 * weld_angle(springs, rim)
    lines = []
    for station in station_angles(springs):
        pieces = [_densify(spring_leg(springs, gap, station, side).points, step) for side in leg_sides(springs)]
        for radius in (rim - 0.5 * springs.thickness, hub + 0.5 * springs.thickness):
            angles = np.linspace(station - half_angle, station + half_angle, math.ceil(springs.weld_length / step) + 1)
            pieces.append(np.array([polar(radius, angle) for angle in angles]))
        lines.append(np.concatenate(pieces))
    return lines
