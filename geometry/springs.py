"""Centrelines of the springs in the wheel's section plane.

Section coordinates are ``(x, z)`` [m] of the wheel frame; polar (r, phi) is ``(r sin phi, -r cos phi)``.
Verified by tests/unit/test_geometry_springs.py.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.parts import SpringSet

__all__ = ["ARC_SEGMENTS", "SPLINE_SEGMENTS", "Leg", "leg_sides", "polar", "spring_leg", "station_angles", "weld_angle"]

ARC_SEGMENTS = 2
SPLINE_SEGMENTS = 8
_SAMPLES_PER_SEGMENT = 16
_FINE = 4001

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """One curved strip from the end of the rim weld to the end of the hub weld.

    Attributes
    ----------
    points : (n, 2) float [m], centreline, equal steps of arc length, from rim to hub
    normals : (n, 2) float [-], unit normals to the side that faces the rim at the start and the hub at the end
    length : arc length of the centreline [m]
    segments : number of equal pieces the mesh divides it into; n - 1 is a multiple of it
    centre : (2,) float [m] of a circular centreline, None for a spline
    """

    points: Array
    normals: Array
    length: float
    segments: int
    centre: Array | None


def polar(radius: float, phi: float) -> Array:
    """Section point (x, z) [m] at ``radius`` [m] and circumferential position ``phi`` [rad]; shape (2,)."""
    return radius * np.array([math.sin(phi), -math.cos(phi)])


def station_angles(springs: SpringSet) -> Array:
    """Circumferential positions of the weld centres, shape (count,) [rad]."""
    angles: Array = springs.phase + 2.0 * math.pi / springs.count * np.arange(springs.count, dtype=np.float64)
    return angles


def weld_angle(springs: SpringSet, rim_radius: float) -> float:
    """Angle [rad] the weld covers: weld length / ``rim_radius``, the radius [m] of the surface it sits on."""
    return springs.weld_length / rim_radius


def leg_sides(springs: SpringSet) -> tuple[int, ...]:
    """Sides to which strips leave a weld: (1, -1) for a hoop, else (direction,)."""
    return (1, -1) if springs.shape == "hoop" else (springs.direction,)


@functools.lru_cache(maxsize=512)
def spring_leg(springs: SpringSet, gap: tuple[float, float], station: float, side: int) -> Leg:
    """Return the strip that leaves the weld at ``station`` [rad] towards ``side``, its arrays read-only as it is kept.

    Parameters
    ----------
    springs : the set
    gap : (hub, rim): radii [m] of the two surfaces between which the springs lie
    station : position of the weld's centre [rad]
    side : 1 towards larger phi, -1 towards smaller
    """
    hub, rim = gap
    ray = station + side * 0.5 * weld_angle(springs, rim)
    ends = hub + 0.5 * springs.hub_thickness, rim - 0.5 * springs.thickness
    if springs.shape == "spline":
        leg = _spline_leg(springs, ends, ray, side)
    else:
        leg = _arc_leg(ends, ray, side, SPLINE_SEGMENTS if springs.tapered else ARC_SEGMENTS)
    for array in (leg.points, leg.normals):
        array.flags.writeable = False
    return leg


def _arc_leg(ends: tuple[float, float], ray: float, side: int, segments: int) -> Leg:
    """Semicircle whose diameter lies on the ray between the radii ``ends``; its sides are splines where they taper."""
    radius = 0.5 * (ends[1] - ends[0])
    centre = polar(0.5 * (ends[0] + ends[1]), ray)
    radial, hoop = polar(1.0, ray), np.array([math.cos(ray), math.sin(ray)])
    theta = np.linspace(0.0, math.pi, segments * _SAMPLES_PER_SEGMENT + 1)[:, None]
    normals = np.cos(theta) * radial + side * np.sin(theta) * hoop
    return Leg(
        points=centre + radius * normals,
        normals=normals,
        length=math.pi * radius,
        segments=segments,
        centre=centre,
    )


def _spline_leg(springs: SpringSet, ends: tuple[float, float], ray: float, side: int) -> Leg:
    """Cubic spline in chord length through the user's points, clamped to the ring's tangents at both ends."""
    from scipy.interpolate import CubicSpline

    hub, rim = ends
    through = [(0.0, 0.0), *springs.points, (1.0, 0.0)]
    knots = np.array([polar(rim + fraction * (hub - rim), ray + side * angle) for fraction, angle in through])
    chord = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1))])
    tangent = side * np.array([math.cos(ray), math.sin(ray)])
    spline = CubicSpline(chord, knots, bc_type=((1, tangent), (1, -tangent)))
    fine = np.linspace(0.0, chord[-1], _FINE)
    speed = np.linalg.norm(spline(fine, 1), axis=1)
    middle = np.linalg.norm(spline(0.5 * (fine[1:] + fine[:-1]), 1), axis=1)
    steps = (speed[1:] + 4.0 * middle + speed[:-1]) / 6.0 * np.diff(fine)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.interp(np.linspace(0.0, arc[-1], SPLINE_SEGMENTS * _SAMPLES_PER_SEGMENT + 1), arc, fine)
    slope = spline(at, 1) / np.linalg.norm(spline(at, 1), axis=1)[:, None]
    normals = side * np.column_stack([slope[:, 1], -slope[:, 0]])
    return Leg(points=spline(at), normals=normals, length=float(arc[-1]), segments=SPLINE_SEGMENTS, centre=None)
