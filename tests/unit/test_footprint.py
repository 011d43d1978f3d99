"""Footprint: load, centre of pressure, map on a grid, file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.footprint import Footprint, read_footprint, write_footprint

GRID = 4e-3 * np.arange(-20.0, 21.0)


def points(n: int = 300) -> Footprint:
    random = np.random.default_rng(2)
    place = random.uniform(-0.06, 0.07, (n, 2))
    return Footprint(place=place, force=random.uniform(0.0, 2.0, n), pressure=random.uniform(1e3, 1e6, n))


def test_a_map_keeps_load_and_centre() -> None:
    one = points()
    force = one.spread(GRID, GRID) * 4e-3**2
    assert force.sum() == pytest.approx(one.load, rel=1e-12)
    np.testing.assert_allclose([(force.sum(1) @ GRID), (force.sum(0) @ GRID)] / force.sum(), one.centre, atol=1e-15)


def test_even_pressure_is_even_on_the_map() -> None:
    """Points 1 mm apart under 0.1 MPa; away from the edge every place has just that."""
    at = 1e-3 * (np.arange(-40, 40) + 0.5)
    place = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
    even = Footprint(place=place, force=np.full(len(place), 0.1), pressure=np.full(len(place), 1e5))
    inside = np.abs(GRID) < 35e-3
    np.testing.assert_allclose(even.spread(GRID, GRID)[np.ix_(inside, inside)], 1e5, rtol=1e-9)


def test_a_grid_must_cover_it() -> None:
    with pytest.raises(InputError, match="must cover it"):
        points().spread(GRID[10:-10], GRID)


def test_a_file_gives_it_back(tmp_path: Path) -> None:
    one = points()
    write_footprint(one, tmp_path / "one.csv", "a test")
    back = read_footprint(tmp_path / "one.csv")
    assert (np.diff(back.place[:, 0]) >= 0.0).all()
    assert back.load == pytest.approx(one.load, rel=1e-11)
    np.testing.assert_allclose(back.centre, one.centre, rtol=1e-9)
