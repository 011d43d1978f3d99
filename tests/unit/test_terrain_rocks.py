"""Random rocks: repeatable, as many and as large as the law says, smooth at their feet, and the values refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.terrain_rocks import RandomRocks


def test_the_seed_decides() -> None:
    first, again, other = (RandomRocks(seed=seed, size=(5.0, 4.0)).terrain() for seed in (7, 7, 8))
    np.testing.assert_array_equal(first.heights, again.heights)
    assert np.abs(first.heights - other.heights).max() > 0.03
    assert first.heights.shape == (251, 201)


def test_rocks_cover_the_share_of_the_law() -> None:
    field = RandomRocks(seed=3, size=(200.0, 200.0), spacing=0.025)
    diameter = field.rocks()[:, 2]
    q = 1.79 + 0.152 / 0.07
    for low, high in ((0.1, 0.4), (0.2, 0.4)):
        share = 0.07 * (math.exp(-q * low) - math.exp(-q * high))
        covered = (0.25 * math.pi * diameter[diameter >= low] ** 2).sum() / 200.0**2
        assert covered == pytest.approx(share, rel=0.02)


def test_height_of_a_rock_is_its_share_of_the_diameter() -> None:
    field = RandomRocks(seed=1, size=(6.0, 6.0), origin=(-3.0, -3.0), height_ratio=0.5)
    terrain, (x, y, diameter) = field.terrain(), max(field.rocks(), key=lambda rock: rock[2])
    assert float(terrain.height(np.array(x), np.array(y))) == pytest.approx(0.5 * diameter, rel=0.02)
    assert terrain.heights.min() == 0.0


def test_the_start_is_clear() -> None:
    field = RandomRocks(seed=2, size=(8.0, 8.0), origin=(-4.0, -4.0), clear=(0.5, 0.0, 1.5))
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    for radius in (0.0, 0.7, 1.45):
        around = field.terrain().height(0.5 + radius * np.cos(angle), radius * np.sin(angle))
        np.testing.assert_allclose(around, 0.0, atol=1e-12)
    assert len(field.rocks()) > 10


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seed": -1}, "rock seed"),
        ({"abundance": 0.0}, "rock abundance"),
        ({"abundance": 0.7}, "rock abundance"),
        ({"diameters": (0.4, 0.1)}, "rock diameters"),
        ({"spacing": 0.05}, "quarter of the smallest diameter"),
        ({"size": (0.05, 5.0)}, "four spacings"),
        ({"height_ratio": 0.0}, "height ratio"),
        ({"size": (math.nan, 5.0)}, "finite"),
    ],
)
def test_bad_fields_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        RandomRocks(**{"seed": 1, "size": (5.0, 5.0), **change})
