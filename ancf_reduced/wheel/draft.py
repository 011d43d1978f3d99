"""A wheel's network of plates while it is drawn: strips as grids of plates, springs tied to rim and hub.

Verified by tests/unit/test_ancf_wheel_mesh.py.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer
from ancf_reduced.wheel.supports import HubEnd
from geometry.resolution import Ring

__all__ = ["Draft", "Rim", "TieLine"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_AXLE = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TieLine:
    """Where edges of springs follow the rim (or springs and cone an elastic hub), one row per plate of a spring.

    Attributes
    ----------
    spring, rim : (n,) plates
    edge : (n, 2, 2) places (u, v) in the spring's plate of the ends of its edge
    ends : (n, 2, 2) places (u, v) in the rim's plate of the same ends
    leaving : (n,) axis of the spring's plate that leaves the edge, 0 or 1
    offset : (n,) of the spring's middle from the rim's, along the rim's normal [m]
    square : (n, 2) parts along the rim's normal and its r_2 of a direction at right angles to the spring there
    turning : (n,) moment by angle and width that the weld's end has against turning [N/rad]
    """

    spring: Index
    rim: Index
    edge: Array
    ends: Array
    leaving: Index
    offset: Array
    square: Array
    turning: Array

    @classmethod
    def of(
        cls,
        spring: Index,
        rim: Index,
        places: tuple[Array, Array],
        offset: float,
        turning: float,
        *,
        leaving: int = 0,
        square: tuple[float, float] = (1.0, 0.0),
    ) -> TieLine:
        """Equal rows for some plates; places (2, 2) of the edge and of its ends on the rim."""
        n = len(spring)
        edge, ends = (np.tile(one, (n, 1, 1)) for one in places)
        return cls(
            spring=spring,
            rim=rim,
            edge=edge,
            ends=ends,
            leaving=np.full(n, leaving),
            offset=np.full(n, offset),
            square=np.tile(square, (n, 1)),
            turning=np.full(n, turning),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Rim:
    """A ring of plates, the rim or an elastic hub.

    Attributes
    ----------
    ring : its division around
    breaks : first row of plates after each of its breaks
    plates : all of them (rows, columns)
    columns : axial intervals they cover
    thickness : [m]
    inner_radius : [m]
    """

    ring: Ring
    breaks: Index
    plates: Index
    columns: range
    thickness: float
    inner_radius: float

    @property
    def outer_radius(self) -> float:
        """[m]."""
        return self.inner_radius + self.thickness

    def beginning(self, angle: float, columns: range) -> Index:
        """Plates whose first edge, u = 0, lies at a break of the ring [rad], in some axial intervals."""
        row = self.breaks[self.ring.index(angle)]
        return self.plates[row, columns.start - self.columns.start : columns.stop - self.columns.start]


@dataclass(slots=True)
class Draft:
    """Nodes, plates and what belongs to each plate, strip by strip.

    Attributes
    ----------
    levels : axial positions at which strips are divided [m]
    ties, ends : springs on the rim and on the hub
    """

    levels: Array
    nodes: list[Array] = field(default_factory=list)
    plates: list[Index] = field(default_factory=list)
    sizes: list[Array] = field(default_factory=list)
    layers: list[tuple[Layer, ...]] = field(default_factory=list)
    parts: list[str] = field(default_factory=list)
    strips: list[int] = field(default_factory=list)
    facing: list[float] = field(default_factory=list)
    ties: list[TieLine] = field(default_factory=list)
    ends: list[HubEnd] = field(default_factory=list)
    count: int = 0
    plate_count: int = 0

    def columns(self, bands: Iterable[tuple[float, float]]) -> list[range]:
        """Axial intervals of every band that lies in the drawn width."""
        found = []
        for low, high in bands:
            middle = 0.5 * (self.levels[1:] + self.levels[:-1])
            inside = np.flatnonzero((middle > low) & (middle < high))
            if len(inside):
                found.append(range(int(inside[0]), int(inside[-1]) + 1))
        return found

    def add_strip(
        self,
        part: str,
        line: tuple[Array, Array],
        steps: Array,
        columns: range,
        front: Array,
        *,
        touches: bool = True,
    ) -> tuple[Index, Index]:
        """A strip along ``line``, points and unit tangents (m, 2) in the section; closed if it has as many steps.

        columns : axial intervals it covers; front : normal (2,) of its front at its beginning; touches : whether its
        strip is among those that touch something. Returns numbers of its nodes (m, n + 1) and plates (steps, n).
        """
        points, tangents = line
        y = self.levels[columns.start : columns.stop + 1]
        new = np.zeros((len(points), len(y), 4, 3))
        new[:, :, 0, [0, 2]], new[:, :, 0, 1] = points[:, None], y
        new[:, :, 1, [0, 2]], new[:, :, 2] = tangents[:, None], _AXLE
        facing = float(np.sign(tangents[0, 0] * front[1] - tangents[0, 1] * front[0]))
        return self.add_grid(part, new, (steps, np.diff(y)), self.next_strip(touches), facing)

    def next_strip(self, touches: bool) -> int:
        """Number of a new strip, negative for those that touch nothing."""
        return max(self.strips, default=-1) + 1 if touches else min(self.strips) - 1

    def add_grid(
        self, part: str, nodes: Array, sizes: tuple[Array, Array], strip: int, facing: float
    ) -> tuple[Index, Index]:
        """A strip of nodes (m, n + 1, 4, 3) and the plates' sizes along and across it; as `add_strip`."""
        steps, widths = sizes
        m, n = nodes.shape[:2]
        numbers = self.count + np.arange(m * n).reshape(m, n)
        ahead = np.arange(1, len(steps) + 1) % m
        behind = np.arange(len(steps))
        corners = [numbers[i][:, j] for i in (behind, ahead) for j in (slice(None, -1), slice(1, None))]
        self.nodes.append(nodes.reshape(-1, 4, 3))
        self.plates.append(np.stack(corners, axis=-1).reshape(-1, 4))
        grid = np.meshgrid(steps, widths, indexing="ij")
        self.sizes.append(np.stack(grid, axis=-1).reshape(-1, 2))
        plates = self.plate_count + np.arange(len(steps) * (n - 1)).reshape(len(steps), n - 1)
        self.parts += [part] * plates.size
        self.strips += [strip] * plates.size
        self.facing += [facing] * plates.size
        self.count += m * n
        self.plate_count += plates.size
        return numbers, plates
