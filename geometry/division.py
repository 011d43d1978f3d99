"""Element sizes, and how a ring is divided: cut at given angles, elements between the cuts.

Verified by tests/unit/test_geometry_resolution.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["Interval", "MeshSize", "Ring", "divide"]

Interval = tuple[float, float, float]
"""Piece of a ring: start, end and largest element angle inside [rad]."""

_SAME_ANGLE = 1e-9
_SLIVER = 1e-5
_LARGEST_BLOCK = math.radians(60.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshSize:
    """Element sizes asked for.

    Attributes
    ----------
    element_size : largest element length along strips and around rings [m]
    axial_size : largest element length along the axle [m]
    thickness_elements : elements through each thickness [-]
    refinement : part name -> element size [m] where it differs
    edge_size : length along the axle of one element on either side of every axial position where the section changes
        but the mid-plane [m]: a bent strip curls up at its edges, over a length sqrt(radius thickness)
    factor : every count of elements along strips and along the axle that follows from these sizes is multiplied by this
        one and rounded up; those through a thickness are not. A family of meshes for a grid convergence study [-]
    """

    element_size: float
    axial_size: float
    thickness_elements: int
    refinement: Mapping[str, float]
    edge_size: float | None = None
    factor: float = 1.0

    def of(self, part: str) -> float:
        """Element size [m] of a part."""
        return self.refinement.get(part, self.element_size)

    @property
    def half_wall_elements(self) -> int:
        """Elements across half a lattice's wall: its joints need an even number across the whole."""
        return math.ceil(0.5 * self.thickness_elements)

    def refined(self, count: int) -> int:
        """A count of elements times the factor, rounded up."""
        return math.ceil(self.factor * count - 1e-6)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ring:
    """The circumferential division of a ring.

    Attributes
    ----------
    angles : (n,) float [rad] in [0, 2 pi), increasing: where blocks meet
    counts : (n,) int, elements between angle i and angle i + 1 (the last wraps around)
    """

    angles: NDArray[np.float64]
    counts: NDArray[np.int64]

    def index(self, angle: float) -> int:
        """Number of the break at ``angle`` [rad]."""
        offset = np.abs((self.angles - angle + math.pi) % (2.0 * math.pi) - math.pi)
        return int(np.argmin(offset))

    def span(self, start: float, end: float) -> list[int]:
        """Numbers of the intervals from the break at ``start`` to the break at ``end`` [rad], in order."""
        first, last = self.index(start), self.index(end)
        return [(first + k) % len(self.angles) for k in range((last - first) % len(self.angles))]

    def angle(self, i: int) -> float:
        """Angle [rad] of break ``i``, taken around the ring."""
        return float(self.angles[i % len(self.angles)])

    def step(self, i: int) -> float:
        """Angle [rad] covered by interval ``i``."""
        return (self.angle(i + 1) - self.angle(i)) % (2.0 * math.pi)


def divide(intervals: Iterable[Interval], largest: float) -> Ring:
    """Ring cut at the ends of ``intervals`` (start, end, largest element angle inside [rad])."""
    marked = list(intervals)
    angles = _unique_angles([end for a, b, _ in marked for end in (a, b)])
    gaps = (np.roll(angles, -1) - angles) % (2.0 * math.pi)
    gaps[gaps == 0.0] = 2.0 * math.pi
    pieces = [
        a + gap * np.arange(n) / n
        for a, gap, n in zip(angles, gaps, np.ceil(gaps / _LARGEST_BLOCK - 1e-9).astype(int), strict=True)
    ]
    ring = Ring(angles=_unique_angles(np.concatenate(pieces)), counts=np.zeros(0, dtype=np.int64))
    limit = np.full(len(ring.angles), largest)
    for a, b, inside in marked:
        for i in ring.span(a, b):
            limit[i] = min(limit[i], inside)
    counts = [math.ceil(ring.step(i) / limit[i] - 1e-6) for i in range(len(limit))]
    return Ring(angles=ring.angles, counts=np.maximum(np.array(counts, dtype=np.int64), 1))


def _unique_angles(angles: Iterable[float]) -> NDArray[np.float64]:
    """Angles [rad] in [0, 2 pi), sorted, equal ones once; raises InputError for cuts that all but coincide."""
    turned = np.sort(np.mod(np.fromiter(angles, dtype=np.float64), 2.0 * math.pi))
    if len(turned) == 0:
        return np.zeros(1)
    turned[np.abs(turned - 2.0 * math.pi) < _SAME_ANGLE] = 0.0
    turned = np.sort(turned)
    kept = turned[np.concatenate([[True], np.diff(turned) > _SAME_ANGLE])]
    gaps = (np.roll(kept, -1) - kept) % (2.0 * math.pi)
    if len(kept) > 1 and gaps.min() < _SLIVER:
        where = math.degrees(kept[int(np.argmin(gaps))])
        rule = f"two weld ends or grouser flanks near phi = {where:.4g} deg make a sliver"
        raise InputError("ring cut", f"{gaps.min():.3g} rad apart", rule, "make them equal or change a weld length")
    return np.asarray(kept, dtype=np.float64)
