"""How a lattice divides the rings that it stands on: cut at its feet and under its walls.

Verified by tests/unit/test_geometry_lattice.py.
"""

from __future__ import annotations

import math
from itertools import pairwise

from contracts.errors import InputError
from geometry.division import Interval, MeshSize, Ring
from geometry.lattice import JOINTS, Lattice, foot_half_angle, wall_half_angle

__all__ = ["across_walls", "foot_intervals"]


def foot_intervals(lattice: Lattice, row: int, radius: float, size: MeshSize) -> list[Interval]:
    """Feet of a row of radial walls on a ring's surface, in four pieces: beside the wall and under its halves."""
    limit = size.of(JOINTS) / radius
    foot = foot_half_angle(lattice, radius)
    pieces: list[Interval] = []
    for middle, wall in _walls(lattice, row, radius):
        pieces += [(middle + a, middle + b, limit) for a, b in pairwise((-foot, -wall, 0.0, wall, foot))]
    return pieces


def across_walls(ring: Ring, lattice: Lattice, row: int, radius: float, size: MeshSize) -> Ring:
    """The ring with as many elements under each wall as across it; raises InputError where something cuts it there."""
    counts = ring.counts.copy()
    for middle, wall in _walls(lattice, row, radius):
        under = ring.span(middle - wall, middle + wall)
        if len(under) != 2:
            rule = f"puts a wall's end at {math.degrees(middle) % 360.0:.4g} deg on a grouser's flank or a weld's end"
            value = f"{math.degrees(lattice.phase):g} deg"
            hint = "turn the lattice by a few degrees, or the grousers"
            raise InputError("lattice phase", value, rule, hint, key="lattice.phase")
        counts[under] = size.half_wall_elements
    return Ring(angles=ring.angles, counts=counts)


def _walls(lattice: Lattice, row: int, radius: float) -> list[tuple[float, float]]:
    """Middle of each radial wall of a row and half the angle it covers where it ends, on its foot's top [rad]."""
    wall = wall_half_angle(lattice, radius + (lattice.thickness if row == 0 else -lattice.thickness))
    turns = (k + 0.5 * (row % 2) for k in range(lattice.cells))
    return [(lattice.phase + turn * lattice.pitch, wall) for turn in turns]
