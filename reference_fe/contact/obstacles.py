"""Rigid obstacles as analytic surfaces: plane, step edge, cleat, half-round rock.

Each is a cylinder over a profile in a plane: s points along the ground, z up; nothing varies across. A profile is made
of convex pieces of solid. A point has one normal gap to each piece, and one contact condition for each: the union of
the pieces therefore needs no blend and has no kink at its re-entrant corners, where a point is pressed by both.

Verified by tests/unit/test_fe_obstacles.py and tests/verification/test_fe_wheel_obstacles.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe.compiled import compiled

__all__ = ["Cleat", "HalfRoundRock", "Obstacle", "Plane", "StepEdge", "piece_gap", "smallest_gap", "touch_level"]

_HALF_PLANE, _CORNER, _HALF_ROUND, _CLEAT = 0.0, 1.0, 2.0, 3.0


class Obstacle(Protocol):
    """A profile, and how it is turned about the ground's normal."""

    @property
    def yaw_deg(self) -> float:
        """Angle from the forward direction to the profile's s axis, about the ground's normal [deg]."""

    def pieces(self) -> NDArray[np.float64]:
        """Convex pieces, (n, 5): kind, and s, z, radius, half width [m] as `piece_gap` reads them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Plane:
    """Flat ground: z < 0 is solid."""

    yaw_deg: float = 0.0

    def pieces(self) -> NDArray[np.float64]:
        """One half plane, (1, 5), see `Obstacle`."""
        return np.array([_level(0.0)])


@dataclass(frozen=True, slots=True, kw_only=True)
class StepEdge:
    """A block's corner on lower ground: the block fills s > position, z < 0; the ground lies ``height`` below.

    Attributes
    ----------
    height : of the block's top over the ground [m]
    edge_radius : radius of the block's edge [m]; penetration must stay below it
    position : of the block's face along s [m]
    yaw_deg : see `Obstacle`
    """

    height: float
    edge_radius: float
    position: float = 0.0
    yaw_deg: float = 0.0

    def __post_init__(self) -> None:
        _positive("step height", self.height)
        _positive("step edge radius", self.edge_radius)
        if self.edge_radius > self.height:
            raise InputError("step edge radius", f"{self.edge_radius:g} m", "must not exceed the height", "lower it")

    def pieces(self) -> NDArray[np.float64]:
        """Rounded corner and lower ground, (2, 5), see `Obstacle`."""
        corner = [_CORNER, self.position, 0.0, self.edge_radius, 0.0]
        return np.array([corner, _level(-self.height)])


@dataclass(frozen=True, slots=True, kw_only=True)
class Cleat:
    """A bar across the ground with rounded edges; its top is at z = 0, the ground at z = -height.

    Attributes
    ----------
    height : of the bar's top over the ground [m]
    width : from side to side along s [m]
    edge_radius : radius of both edges [m]; penetration must stay below it
    position : of the bar's middle along s [m]
    yaw_deg : see `Obstacle`; at 0 the bar is lateral
    """

    height: float
    width: float
    edge_radius: float
    position: float = 0.0
    yaw_deg: float = 0.0

    def __post_init__(self) -> None:
        _positive("cleat height", self.height)
        _positive("cleat width", self.width)
        _positive("cleat edge radius", self.edge_radius)
        if self.edge_radius > min(self.height, 0.5 * self.width):
            rule = "must not exceed the height and half the width"
            raise InputError("cleat edge radius", f"{self.edge_radius:g} m", rule, "lower it")

    def pieces(self) -> NDArray[np.float64]:
        """Bar and ground, (2, 5), see `Obstacle`."""
        bar = [_CLEAT, self.position, 0.0, self.edge_radius, 0.5 * self.width]
        return np.array([bar, _level(-self.height)])


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfRoundRock:
    """Half a cylinder that lies on the ground; its crown is at z = 0, the ground at z = -radius.

    Attributes
    ----------
    radius : of the cylinder [m]
    position : of its axis along s [m]
    yaw_deg : see `Obstacle`; at 0 the axis is lateral
    """

    radius: float
    position: float = 0.0
    yaw_deg: float = 0.0

    def __post_init__(self) -> None:
        _positive("rock radius", self.radius)

    def pieces(self) -> NDArray[np.float64]:
        """Half-round and ground, (2, 5), see `Obstacle`."""
        crown = [_HALF_ROUND, self.position, -self.radius, self.radius, 0.0]
        return np.array([crown, _level(-self.radius)])


@compiled()
def piece_gap(piece: NDArray[np.float64], s: float, z: float) -> tuple[float, float, float, float]:
    """Signed distance of a point from one convex piece of a profile, with its derivatives.

    Parameters
    ----------
    piece : (5,) kind, s0, z0, r, w: half plane z < z0; corner s > s0, z < z0 with edge radius r; half-round
        about (s0, z0), with upright sides below; cleat |s - s0| < w, z < z0 with edge radius r
    s, z : the point [m]

    Returns
    -------
    gap : distance [m], open > 0
    n_s, n_z : its gradient, the unit normal [-]
    curvature : second derivative along the surface [1/m]; the Hessian is curvature * t t^T with t at right angles to n

    Verified by tests/unit/test_fe_obstacles.py (finite differences).
    """
    kind, r = piece[0], piece[3]
    x, y = s - piece[1], z - piece[2]
    if kind == _HALF_PLANE:
        return y, 0.0, 1.0, 0.0
    ahead = 1.0
    if kind == _CLEAT:  # the corner of its nearer side
        ahead, x = math.copysign(1.0, -x), piece[4] - abs(x)
    if kind in (_CORNER, _CLEAT):
        x, y = x - r, y + r
        if x >= 0.0 or y <= 0.0:  # over the top, before the face, or inside
            return (y - r, 0.0, 1.0, 0.0) if y >= -x else (-x - r, -ahead, 0.0, 0.0)
    elif y < 0.0:  # below the axis of a half-round: its upright sides
        return abs(x) - r, math.copysign(1.0, x), 0.0, 0.0
    distance = max(math.hypot(x, y), 1e-300)
    return distance - r, ahead * x / distance, y / distance, 1.0 / distance


@compiled()
def smallest_gap(pieces: NDArray[np.float64], s: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Smallest gap over the pieces at many points, (n,) [m]."""
    out = np.empty(len(s))
    for i in range(len(s)):
        out[i] = np.inf
        for piece in pieces:
            out[i] = min(out[i], piece_gap(piece, s[i], z[i])[0])
    return out


def touch_level(obstacle: Obstacle, s: NDArray[np.float64], z: NDArray[np.float64]) -> float:
    """How far an obstacle must rise along z from level 0 to just touch the lowest of many points [m]; bisection."""
    pieces = obstacle.pieces()
    low = float(z.min()) - 1e-12
    high = low + float(np.ptp(pieces[:, 2])) + float(pieces[:, 3].max()) + 1e-9
    for _ in range(60):
        middle = 0.5 * (low + high)
        if smallest_gap(pieces, s, z - middle).min() > 0.0:
            low = middle
        else:
            high = middle
    return low


def _level(z: float) -> list[float]:
    """Row of a half plane below z [m]."""
    return [_HALF_PLANE, 0.0, z, 0.0, 0.0]


def _positive(what: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(what, f"{value:g} m", "must be > 0", "give a length")
