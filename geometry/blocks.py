"""Four-sided blocks of a wheel's section with shared corners, and a section while it is built of them.

Corners carry names, not coordinates, so that two blocks share a corner because they were built on it.
Verified by tests/unit/test_geometry_section.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from geometry.division import MeshSize, Ring
from geometry.springs import polar

__all__ = ["Block", "Curve", "Draft", "Key", "Section", "Surfaces"]

Array = NDArray[np.float64]
Key = tuple[str | int, ...]
"""Name of a corner, e.g. ``("rim_in", 3)``."""

Surfaces = tuple[tuple[str, str], tuple[float, float]]
"""Names and radii [m] of the two surfaces that bound a ring."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """A long side of a block: a circular arc about ``centre``, a spline through ``through``, or else straight.

    Attributes
    ----------
    start, end : names of its corners
    centre : (2,) float [m] of an arc
    through : (n, 2) float [m], interior points of a spline
    tangents : (2, 2) float [-], unit tangents of a spline at its start and end
    """

    start: Key
    end: Key
    centre: Array | None = None
    through: Array | None = None
    tangents: Array | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A four-sided face: ``inner`` and ``outer`` run side by side, straight lines join their ends.

    An end that a block before it has as a long side has that one's form.

    Attributes
    ----------
    part : part name
    inner, outer : the long sides
    n_length, n_thickness : elements along and across
    groups : side (``"inner"``, ``"outer"``, ``"ends"``) -> face group, where it is boundary
    """

    part: str
    inner: Curve
    outer: Curve
    n_length: int
    n_thickness: int
    groups: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """Corners (name -> (2,) [m] in x, z) and blocks."""

    corners: Mapping[Key, Array]
    blocks: tuple[Block, ...]


@dataclass(slots=True, kw_only=True)
class Draft:
    """A section while it is built, with the division of the rings."""

    size: MeshSize
    corners: dict[Key, Array] = field(default_factory=dict)
    blocks: list[Block] = field(default_factory=list)

    def corner(self, key: Key, point: Array) -> Key:
        self.corners.setdefault(key, point)
        return key

    def ring_arc(self, name: str, radius: float, ring: Ring, i: int) -> Curve:
        """Arc of ``radius`` [m] about the axle between breaks ``i`` and ``i + 1`` of a ring."""
        j = (i + 1) % len(ring.angles)
        ends = [self.corner((name, k), polar(radius, ring.angle(k))) for k in (i, j)]
        return Curve(start=ends[0], end=ends[1], centre=np.zeros(2))

    def level_names(self, first: str, last: str, count: int | None = None) -> list[str]:
        """Names of the surfaces between two surfaces of a ring, both included, one element apart."""
        n = count or self.size.thickness_elements
        return [first, *(f"{first}|{last}|{k}" for k in range(1, n)), last]

    def add_ring_piece(
        self, part: str, surfaces: Surfaces, ring: Ring, i: int, groups: Mapping[str, str], count: int | None = None
    ) -> None:
        """Layers of a ring between breaks ``i`` and ``i + 1``, from one named surface to another; as many as a
        thickness has elements, or ``count``."""
        (first, last), radii = surfaces
        names = self.level_names(first, last, count)
        levels = zip(names, np.linspace(*radii, len(names)), strict=True)
        self.add_layers(part, [self.ring_arc(n, float(r), ring, i) for n, r in levels], int(ring.counts[i]), groups)

    def add_layers(self, part: str, curves: Sequence[Curve], n_length: int, groups: Mapping[str, str]) -> None:
        """One block between each curve and the next, so that every long edge of an element lies on a drawn curve."""
        for k, (inner, outer) in enumerate(pairwise(curves)):
            here = {"ends"} | ({"inner"} if k == 0 else set()) | ({"outer"} if k == len(curves) - 2 else set())
            kept = {side: group for side, group in groups.items() if side in here}
            self.blocks.append(
                Block(part=part, inner=inner, outer=outer, n_length=n_length, n_thickness=1, groups=kept)
            )
