"""A long way over random rocks, cut into stretches: what they have in common, and the rocks of each.

Rocks of a stretch are those of its number and the way's seed (`contracts.terrain_rocks.RandomRocks`). Rocks taller than
the rover is required to cross (0.25 m, thesis, section 1) are driven around: they are left out, and those that would
have reached into a wheel's track counted. Rocks of less than 50 mm diameter are left out.

Verified by tests/unit/test_rover_stretch.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain_rocks import RandomRocks
from rover_dynamics.rover.rover_design import RoverDesign

__all__ = ["ASIDE", "LONGER", "Way", "avoided", "crossed", "rocks"]

FloatArray = NDArray[np.float64]
TALLEST = 0.25
"""Obstacle the rover is required to cross [m]."""
SMALLEST, HEIGHT, LARGEST = 0.05, 0.4, 3.0
"""Of the rocks: smallest diameter [m], height over diameter [-], largest diameter counted as driven around [m]."""
MARGIN, ASIDE = 0.5, 0.25
"""Ground beyond the wheels' places [m], and beside them more by this share of the way, for a rover that turns."""
LONGER = 1.5
"""Way the wheels turn, over that of the stretch, at which the rover counts as stuck."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """What all stretches have in common.

    Attributes
    ----------
    length : of a stretch [m]
    speed : of the wheels' rims [m/s]
    abundance : share of the ground that rocks of all sizes cover, k of `contracts.terrain_rocks` [-]
    seed : of the rocks of all stretches, 0 or more
    tallest : rocks of more height are driven around [m]

    Raises
    ------
    InputError
        For a number out of its range.
    """

    length: float
    speed: float
    abundance: float
    seed: int
    tallest: float = TALLEST

    def __post_init__(self) -> None:
        if not 0.0 < self.length < math.inf:
            raise InputError("stretch", f"{self.length:g} m", "must be finite and > 0", "give a distance such as 2000")
        if not 1.0 / 3600.0 <= self.speed <= 500.0 / 3600.0:
            raise InputError("speed", f"{3600.0 * self.speed:g} m/h", "must lie in 1 ... 500 m/h", "try 70")
        if not 1e-3 <= self.abundance <= 0.4:
            raise InputError("abundance", f"{self.abundance:g}", "must lie in [0.001, 0.4]", "try 0.06")
        if self.seed < 0:
            raise InputError("seed", self.seed, "must be 0 or more", "give a whole number")
        if not SMALLEST * HEIGHT < self.tallest < LARGEST * HEIGHT:
            rule = f"must lie between {SMALLEST * HEIGHT:g} and {LARGEST * HEIGHT:g} m, the rocks' heights"
            raise InputError("tallest rock", f"{self.tallest:g} m", rule, f"try {TALLEST:g}")


def rocks(way: Way, number: int, design: RoverDesign) -> RandomRocks:
    """Those the rover may drive over on stretch ``number``, from 0 on."""
    return _field(way, number, design, (SMALLEST, way.tallest / HEIGHT), 0)


def crossed(way: Way, number: int, design: RoverDesign) -> FloatArray:
    """Heights [m] of the rocks that reach into a wheel's track."""
    return HEIGHT * _in_tracks(rocks(way, number, design), way, design)


def avoided(way: Way, number: int, design: RoverDesign) -> int:
    """How many rocks of a wheel's track are taller than the rover crosses, up to a diameter of 3 m."""
    return len(_in_tracks(_field(way, number, design, (way.tallest / HEIGHT, LARGEST), 1), way, design))


def _field(way: Way, number: int, design: RoverDesign, diameters: tuple[float, float], sizes: int) -> RandomRocks:
    seed = int(np.random.SeedSequence([way.seed, number, sizes]).generate_state(1)[0])
    at = np.array([leg.drive[:2] for leg in design.legs])
    beyond = design.wheel_radius + MARGIN
    low, high = at.min(axis=0) - beyond, at.max(axis=0) + beyond
    aside = ASIDE * way.length + MARGIN
    size = (float(high[0] - low[0]) + LONGER * way.length, float(high[1] - low[1]) + 2.0 * aside)
    origin = (float(low[0]), float(low[1]) - aside)
    return RandomRocks(
        seed=seed,
        size=size,
        origin=origin,
        abundance=way.abundance,
        diameters=diameters,
        height_ratio=HEIGHT,
        spacing=0.25 * SMALLEST,
    )


def _in_tracks(field: RandomRocks, way: Way, design: RoverDesign) -> FloatArray:
    """Diameters (n,) [m] of rocks whose circle reaches into the track of a wheel that goes straight ahead."""
    x, y, diameter = field.rocks().T
    met = np.zeros(len(x), dtype=bool)
    for leg in design.legs:
        ahead = x - leg.drive[0]
        beside = np.abs(y - leg.drive[1]) < 0.5 * (design.wheel_width + diameter)
        met |= beside & (ahead > 0.0) & (ahead < way.length)
    return np.asarray(diameter[met])
