"""Whether a terrain reaches as far as a path: only height fields end."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import PieceKind, Terrain

__all__ = ["check_covered", "extent"]


def check_covered(terrain: Terrain, path: NDArray[np.float64], margin: float = 0.0) -> None:
    """Refuse a path that leaves a terrain's height field.

    Parameters
    ----------
    terrain : any
    path : (n, 2) float [m], x and y of the places to be covered
    margin : how far the terrain must reach beyond them [m], e.g. half the vehicle's length plus a wheel's radius

    Raises
    ------
    InputError
        If a place with its margin lies beside the height field; if the path is no list of finite places.

    Verified by tests/unit/test_terrain_cover.py.
    """
    places = np.asarray(path, dtype=np.float64)
    if places.ndim != 2 or places.shape[1] != 2 or not len(places) or not np.all(np.isfinite(places)):
        raise InputError("path", f"shape {places.shape}", "must be (n, 2) finite numbers", "give x and y in metres")
    low, high = extent(terrain)
    beside = np.any((places < low + margin - 1e-9) | (places > high - margin + 1e-9), axis=1)
    if beside.any():
        x, y = places[beside][0]
        (left, right), (near, far) = ((f"{end:.9g}" for end in ends) for ends in zip(low, high, strict=True))
        rule = f"must lie {margin:g} m inside the terrain, x {left}..{right} m, y {near}..{far} m"
        raise InputError("path", f"x, y = {x:g}, {y:g} m", rule, "give a larger field or another start")


def extent(terrain: Terrain) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners (2,) [m] of smallest and largest x and y of a terrain's height field; infinite without one."""
    pieces = terrain.pieces()
    for row in pieces.rows[pieces.rows[:, 0] == PieceKind.HEIGHT_FIELD]:
        return row[1:3], row[1:3] + row[3:5] * (np.array(pieces.knots.shape) - 3)
    return np.full(2, -np.inf), np.full(2, np.inf)
