"""Random rocks on level ground, from a seed, as a height field.

Sizes follow the exponential law of Golombek and Rapp (J. Geophys. Res. 102, 1997, eq. 1): rocks of diameter D and more
cover the share k exp(-q D) of the ground, q = 1.79 + 0.152 / k [1/m], so that their number per area and diameter is

    n(D) = 4 k q exp(-q D) / (pi D^2).

Places are independent and uniform. A rock is the cap h = H (1 - (2 r / D)^2)^2, smooth at its foot; where rocks overlap
the higher one counts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import check_finite

__all__ = ["RandomRocks"]

FloatArray = NDArray[np.float64]
_BINS = 2001


@dataclass(frozen=True, slots=True, kw_only=True)
class RandomRocks:
    """A rocky field; `terrain` makes it, the same for the same numbers.

    Attributes
    ----------
    seed : >= 0, of the random places and sizes
    size : extent of the field along x and y [m]
    origin : its corner of smallest x and y [m]
    abundance : k, share of the ground that rocks of all sizes cover, in (0, 0.5]; 0.07 at Viking Lander 1
    diameters : smallest and largest diameter [m]
    height_ratio : height over diameter [-]
    spacing : distance of the grid lines [m], at most a quarter of the smallest diameter
    clear : x, y and radius of a circle without rocks, where the vehicle starts [m]

    Raises
    ------
    InputError
        For a number out of its range.

    Verified by tests/unit/test_terrain_rocks.py.
    """

    seed: int
    size: tuple[float, float]
    origin: tuple[float, float] = (0.0, 0.0)
    abundance: float = 0.07
    diameters: tuple[float, float] = (0.1, 0.4)
    height_ratio: float = 0.4
    spacing: float = 0.02
    clear: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        check_finite("rock field", *self.size, *self.origin, *self.diameters, *self.clear, self.height_ratio)
        if self.seed < 0:
            raise InputError("rock seed", self.seed, "must be 0 or more", "give a whole number")
        if not 0.0 < self.abundance <= 0.5:
            raise InputError("rock abundance", f"{self.abundance:g}", "must lie in (0, 0.5]", "try 0.07")
        if not 0.0 < self.diameters[0] < self.diameters[1]:
            rule = "must be above zero, smallest first"
            raise InputError("rock diameters", f"{self.diameters} m", rule, "try 0.1 m and 0.4 m")
        if not 0.0 < self.spacing <= 0.25 * self.diameters[0]:
            rule = f"must be > 0 and at most a quarter of the smallest diameter, {0.25 * self.diameters[0]:g} m"
            raise InputError("rock grid spacing", f"{self.spacing:g} m", rule, "lower it")
        if not (min(self.size) >= 4.0 * self.spacing and self.height_ratio > 0.0 and self.clear[2] >= 0.0):
            value = f"{self.size} m, {self.height_ratio:g}, {self.clear[2]:g} m"
            rule = "must be four spacings or more, > 0, >= 0"
            raise InputError("rock field size, height ratio, clear radius", value, rule, "give a larger field")

    def rocks(self) -> FloatArray:
        """(n, 3) float [m]: x, y and diameter of every rock."""
        draw = np.random.default_rng(self.seed)
        diameter = np.geomspace(*self.diameters, _BINS)
        q = 1.79 + 0.152 / self.abundance
        density = 4.0 * self.abundance * q * np.exp(-q * diameter) / (math.pi * diameter**2)
        steps = 0.5 * (density[1:] + density[:-1]) * np.diff(diameter)
        number = np.concatenate([[0.0], np.cumsum(steps)])
        count = draw.poisson(number[-1] * self.size[0] * self.size[1])
        places = np.array(self.origin) + draw.uniform(size=(count, 2)) * np.array(self.size)
        found = np.interp(draw.uniform(0.0, number[-1], count), number, diameter)
        away = np.hypot(*(places - self.clear[:2]).T) >= self.clear[2] + 0.5 * found
        keep = away if self.clear[2] > 0.0 else np.ones(count, dtype=bool)
        return np.column_stack([places, found])[keep]

    def terrain(self) -> HeightField:
        """The height field."""
        x, y = (
            low + self.spacing * np.arange(math.ceil(extent / self.spacing) + 1, dtype=np.float64)
            for low, extent in zip(self.origin, self.size, strict=True)
        )
        heights = np.zeros((len(x), len(y)))
        for place_x, place_y, diameter in self.rocks():
            radius = 0.5 * diameter
            i, j = _within(x, place_x, radius), _within(y, place_y, radius)
            off = (x[i, None] - place_x) ** 2 + (y[None, j] - place_y) ** 2
            cap = self.height_ratio * diameter * np.maximum(1.0 - off / radius**2, 0.0) ** 2
            heights[i, j] = np.maximum(heights[i, j], cap)
        return HeightField(heights=heights, spacing=(self.spacing, self.spacing), origin=self.origin)


def _within(grid: FloatArray, place: float, radius: float) -> slice:
    """Grid lines at most a radius from a place."""
    first, last = np.searchsorted(grid, [place - radius, place + radius])
    return slice(int(first), int(last))
