"""Points of an ANCF wheel that may touch the ground. Verified by tests/unit/test_ancf_wheel_mesh.py."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.wheel import WheelDesign

__all__ = ["GroundPoints", "ground_points"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_ACROSS = 4
"""Contact points of a plate along the axle."""
_APART = 1.5e-3
"""Largest distance of contact points around the rim [m]."""
_LOBATTO = np.array([-1.0, 0.0, 1.0]), np.array([1.0, 4.0, 1.0]) / 6.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GroundPoints:
    """Points that may touch the ground.

    Attributes
    ----------
    plate : (n,) plates
    at : (n, 2) places (u, v) in them
    height : (n,) above the plate's middle, along its normal [m]
    area : (n,) [m^2]
    """

    plate: Index
    at: Array
    height: Array
    area: Array


def ground_points(design: WheelDesign, plates: Index, sizes: Array, fin: bool) -> GroundPoints:
    """Points of one row of the rim's plates: on its outer face, or on the tip of a grouser."""
    tire, fins = design.tire, design.grousers
    middle = 0.5 * (tire.inner_radius + tire.outer_radius)
    length = float(sizes[0, 0])
    if fin and fins is not None:
        height, around = 0.5 * tire.thickness + fins.height, _LOBATTO
    else:
        n = max(1, math.ceil(length / _APART))
        height, around = 0.5 * tire.thickness, ((2.0 * np.arange(n) + 1.0) / n - 1.0, np.full(n, 1.0 / n))
    y, w = np.polynomial.legendre.leggauss(_ACROSS)
    place = np.stack(np.meshgrid(0.5 + 0.5 * around[0], 0.5 + 0.5 * y, indexing="ij"), axis=-1).reshape(-1, 2)
    share = np.outer(around[1], 0.5 * w).ravel()
    along = fins.thickness if fin and fins is not None else length * tire.outer_radius / middle
    if fin and fins is not None:  # the tip is as wide as the foot, the rays between them are not
        place[:, 0] = 0.5 + (place[:, 0] - 0.5) * fins.thickness / length * middle / (tire.outer_radius + fins.height)
    count = len(share)
    return GroundPoints(
        plate=np.repeat(plates, count),
        at=np.tile(place, (len(plates), 1)),
        height=np.full(count * len(plates), -height),
        area=np.concatenate([share * along * b for b in sizes[:, 1]]),
    )
