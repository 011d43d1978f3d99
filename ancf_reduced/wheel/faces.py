"""Points of an ANCF wheel that may touch the ground, the hub or each other, and the strips they belong to.

Verified by tests/unit/test_ancf_wheel_mesh.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.wheel import WheelDesign

__all__ = ["APART", "FacePoints", "Strips", "ground_points", "inner_points"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_ACROSS = 4
"""Contact points of a plate along the axle."""
APART = 1.5e-3
"""Largest distance of contact points along strips, and around the rim where the ground is flat [m]."""
_LOBATTO = np.array([-1.0, 0.0, 1.0]), np.array([1.0, 4.0, 1.0]) / 6.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FacePoints:
    """Points on the faces of plates.

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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Strips:
    """Which strip each plate belongs to; the rim is strip 0, those that touch nothing have numbers below.

    Attributes
    ----------
    strip : (n_plates,) numbers
    facing : (n_plates,) 1 or -1: the side of the plate's normal that faces the rim where a leg begins; the rim's faces
        the hub
    bare : (n_plates,) no weld lies on that side
    """

    strip: Index
    facing: Array
    bare: NDArray[np.bool_]


def _grid(length: float, apart: float = APART) -> tuple[Array, Array]:
    """Places (n, 2) in a plate of this length [m] and the shares (n,) of its area they stand for."""
    n = max(1, math.ceil(length / apart))
    around = ((2.0 * np.arange(n) + 1.0) / n - 1.0, np.full(n, 1.0 / n))
    return _product(around)


def _product(around: tuple[Array, Array]) -> tuple[Array, Array]:
    """Places and shares: those given on [-1, 1] around, Gauss points along the axle."""
    y, w = np.polynomial.legendre.leggauss(_ACROSS)
    place = np.stack(np.meshgrid(0.5 + 0.5 * around[0], 0.5 + 0.5 * y, indexing="ij"), axis=-1).reshape(-1, 2)
    return place, np.outer(around[1], 0.5 * w).ravel()


def inner_points(strips: Strips, sizes: Array, thickness: Array) -> FacePoints:
    """Points on both faces of springs and on the inside of the rim; thickness (n_plates,) [m]."""
    found = []
    for length in np.unique(sizes[:, 0]):
        place, share = _grid(float(length))
        for side in (1.0, -1.0):
            plates = np.flatnonzero(
                (sizes[:, 0] == length) & ((strips.strip > 0) | ((strips.strip == 0) & (side > 0.0)))
            )
            height = 0.5 * side * thickness[plates] * strips.facing[plates]
            found.append(
                FacePoints(
                    plate=np.repeat(plates, len(share)),
                    at=np.tile(place, (len(plates), 1)),
                    height=np.repeat(height, len(share)),
                    area=np.outer(sizes[plates].prod(axis=1), share).ravel(),
                )
            )
    return FacePoints(**{name: np.concatenate([getattr(f, name) for f in found]) for name in FacePoints.__slots__})


def ground_points(
    design: WheelDesign, plates: Index, sizes: Array, fin: tuple[float, float] | None = None, apart: float = APART
) -> FacePoints:
    """Points of one row of the rim's plates: on its outer face, or on the tip of a grouser.

    fin : where the row begins, from the grouser's middle on, and how far it goes [rad]
    apart : largest distance of points around the rim [m]
    """
    tire, fins = design.tire, design.grousers
    middle = 0.5 * (tire.inner_radius + tire.outer_radius)
    length = float(sizes[0, 0])
    if fin is not None and fins is not None:
        height, (place, share) = 0.5 * tire.thickness + fins.height, _product(_LOBATTO)
        low, high = (tire.outer_radius * math.sin(a) for a in (fin[0], fin[0] + fin[1]))
        # The tip is as wide as the foot; the rays between them are not, and could leave a plate that holds a part.
        rays = (low + (high - low) * place[:, 0]) / (tire.outer_radius + fins.height)
        place[:, 0] = np.clip((rays - fin[0]) / fin[1], 0.0, 1.0)
        along = high - low
    else:
        height, (place, share) = 0.5 * tire.thickness, _grid(length, apart)
        along = length * tire.outer_radius / middle
    count = len(share)
    return FacePoints(
        plate=np.repeat(plates, count),
        at=np.tile(place, (len(plates), 1)),
        height=np.full(count * len(plates), -height),
        area=np.concatenate([share * along * b for b in sizes[:, 1]]),
    )
