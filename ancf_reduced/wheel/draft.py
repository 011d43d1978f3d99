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
    """Where the first edges of springs follow the rim, one row per plate of a spring.

    Attributes
    ----------
    spring, rim : (n,) plates; the spring's edge is its u = 0
    ends : (n, 2, 2) places (u, v) in the rim's plate of that edge's ends v = 0, 1
    offset : (n,) of the spring's middle from the rim's, along the rim's normal [m]
    turning : (n,) moment by angle and width that the weld's end has against turning [N/rad]
    """

    spring: Index
    rim: Index
    ends: Array
    offset: Array
    turning: Array


@dataclass(frozen=True, slots=True, eq=False)
class Rim:
    """The rim's division around, first row of plates after each of its breaks, and all plates (rows, columns)."""

    ring: Ring
    breaks: Index
    plates: Index


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
        self, part: str, line: tuple[Array, Array], steps: Array, columns: range, front: Array
    ) -> tuple[Index, Index]:
        """A strip along ``line``, points and unit tangents (m, 2) in the section; closed if it has as many steps.

        columns : axial intervals it covers; front : normal (2,) of its front at its beginning. Returns numbers of its
        nodes (m, n + 1) and plates (steps, n).
        """
        points, tangents = line
        y = self.levels[columns.start : columns.stop + 1]
        new = np.zeros((len(points), len(y), 4, 3))
        new[:, :, 0, [0, 2]], new[:, :, 0, 1] = points[:, None], y
        new[:, :, 1, [0, 2]], new[:, :, 2] = tangents[:, None], _AXLE
        facing = float(np.sign(tangents[0, 0] * front[1] - tangents[0, 1] * front[0]))
        return self.add_grid(part, new, (steps, np.diff(y)), max(self.strips, default=-1) + 1, facing)

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
