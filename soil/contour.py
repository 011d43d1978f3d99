"""Where the rim of a wheel touches soil, and how hard: the contour of `soil.steady_wheel`, equation 11.5 of the manual.

Verified by tests/unit/test_soil_steady_wheel.py.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from soil.carcass import RimShape
from soil.laws import rebound
from soil.soil import Soil

__all__ = ["Contour", "PressureLaw", "contour_of", "hub_heights", "integrated"]

FloatArray = NDArray[np.float64]
_NODES = 40
"""Gauss points of each of the two regions."""
_FARTHEST = 1.5
"""Largest angle of contact [rad]."""


class Contour(NamedTuple):
    """Along the contact, from the first contact backwards.

    ends [rad] and depth of the deepest point [m]; at the points angle, weight of integration [rad], pressure [Pa], and
    depth and the derivatives of x and depth over the angle [m].
    """

    ends: tuple[float, float]
    deepest: float
    angle: FloatArray
    weight: FloatArray
    pressure: FloatArray
    depth: FloatArray
    along: FloatArray
    down: FloatArray


class PressureLaw(NamedTuple):
    """p = modulus z^exponent behind and before ``top`` times theta_1; None of these for a wheel that stands."""

    modulus: float
    exponent: float
    top: float | None


def _integration() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Gauss points on (0, 1), weights, and the matrix that integrates from 0 to each of them."""
    x, w = legendre.leggauss(_NODES)
    upto = np.empty((_NODES, _NODES))
    for k in range(_NODES):
        upto[:, k] = legendre.legval(x, legendre.legint(np.eye(_NODES)[k], lbnd=-1))
    matrix = 0.5 * upto @ np.linalg.inv(legendre.legvander(x, _NODES - 1))
    return 0.5 * (x + 1.0), 0.5 * w, matrix


_U, _W, _UPTO = _integration()


def hub_heights(radius: float, shape: RimShape) -> tuple[float, float]:
    """Heights of the hub [m] between which it is looked for: in the soil up to the farthest angle, barely touching."""
    angle = np.linspace(-_FARTHEST, _FARTHEST, 601)
    rim = (radius - shape.at(angle)[0]) * np.cos(angle)
    return float(max(rim[0], rim[-1])) + 1e-9, float(rim.max()) - 1e-9 * radius


def contour_of(radius: float, soil: Soil, law: PressureLaw, shape: RimShape, height: float) -> Contour:
    """Pressure and place along the contact of a rim of a shape whose hub is at a height [m]."""
    entry = _crossing(radius, shape, height, 1.0)
    top = 0.0 if law.top is None else law.top * entry
    front = entry - (entry - top) * _U**2
    fore = _rim(radius, shape, height, front)
    if law.top is None:
        behind = -_crossing(radius, shape, height, -1.0)
        rear = behind + (top - behind) * (1.0 - _U) ** 2
        aft = _rim(radius, shape, height, rear)
        pressed = aft[0]
    else:
        peak = float(_rim(radius, shape, height, np.array([top]))[0][0])
        back = rebound(peak, law.modulus, law.exponent, soil.unloading_stiffness, soil.unloading_growth)
        lowest = _deepest(radius, shape, height, entry)
        behind = min(-_crossing(radius, shape, height + max(lowest - back, 0.0), -1.0), top - 1e-9)
        rear = behind + (top - behind) * (1.0 - _U) ** 2
        aft = _rim(radius, shape, height, rear)
        pressed = _rim(radius, shape, height, top + (top - rear) * (entry - top) / (top - behind))[0]
    depth = np.concatenate([fore[0], pressed])
    return Contour(
        ends=(entry, behind),
        deepest=_deepest(radius, shape, height, entry),
        angle=np.concatenate([front, rear]),
        weight=np.concatenate([2.0 * (entry - top) * _U * _W, 2.0 * (top - behind) * (1.0 - _U) * _W]),
        pressure=law.modulus * np.maximum(depth, 0.0) ** law.exponent,
        depth=np.concatenate([fore[0], aft[0]]),
        along=np.concatenate([fore[1], aft[1]]),
        down=np.concatenate([fore[2], aft[2]]),
    )


def _deepest(radius: float, shape: RimShape, height: float, entry: float) -> float:
    """Depth of the rim's lowest point [m], by a parabola through three of its points."""
    angle = np.linspace(-entry, entry, 121)
    depth = _rim(radius, shape, height, angle)[0]
    k = int(np.clip(np.argmax(depth), 1, len(depth) - 2))
    before, most, after = depth[k - 1 : k + 2].tolist()
    bend = before - 2.0 * most + after
    return float(most - 0.125 * (after - before) ** 2 / bend) if bend < 0.0 else float(most)


def _rim(radius: float, shape: RimShape, height: float, angle: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Depth of the rim and the derivatives of x and depth over the angle [m]."""
    w, dw = shape.at(angle)
    reach, cosine, sine = radius - w, np.cos(angle), np.sin(angle)
    return reach * cosine - height, reach * cosine - dw * sine, -reach * sine - dw * cosine


def _crossing(radius: float, shape: RimShape, height: float, side: float) -> float:
    """Angle [rad] from below the hub, forwards (side 1) or backwards (-1), up to which the rim lies deeper than H."""
    from scipy.optimize import brentq

    if not shape.cosines.any() and not shape.sines.any():
        return math.acos(min(1.0, height / radius))

    def depth(angle: float) -> float:
        return float(_rim(radius, shape, height, np.array([side * angle]))[0][0])

    tried = np.linspace(0.0, _FARTHEST, 301)
    above = np.flatnonzero(_rim(radius, shape, height, side * tried)[0] > 0.0)
    if not above.size:
        return 1e-9
    last = int(above[-1])
    return float(brentq(depth, tried[last], tried[last + 1], xtol=1e-14)) if last < 300 else _FARTHEST


def integrated(contour: Contour, rate: FloatArray) -> FloatArray:
    """Integral of a rate over the angle from the first contact on, at each point."""
    per_node = rate * contour.weight / np.tile(_W, 2)
    front, rear = per_node[:_NODES], per_node[_NODES:]
    return np.concatenate([_UPTO @ front, float(front @ _W) + _UPTO @ rear])
