"""A terrain of heights on a rectangular grid, interpolated by cubic convolution.

Keys' cubic convolution (1981, eq. 4 with a = -1/2; boundary rows by his eq. 19): the surface passes through all heights
with continuous slopes, needs 4 x 4 heights a point and is of third order. Bilinear patches would have an edge at every
grid line, where the normal jumps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import PIECE_SIZE, PieceKind, Terrain, TerrainPieces

__all__ = ["TILE", "HeightField", "sampled_terrain"]

FloatArray = NDArray[np.float64]
_HIGHEST = 1e5
"""Four times Olympus Mons [m]."""
_SPACING = (1e-4, 1e5)
"""Between the grains of sand and the maps of a planet [m]."""
TILE = 8
"""Cells along each side of a tile that has one upper bound."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeightField:
    """Heights at x = origin[0] + i spacing[0], y = origin[1] + j spacing[1].

    Attributes
    ----------
    heights : (n_x, n_y) float [m], 4 or more each way
    spacing : distance of the grid lines along x and y [m]
    origin : x, y of the first height [m]

    Raises
    ------
    InputError
        For fewer heights, heights that are not finite or that no planet has, or a spacing no ground has; by `height`
        and `gradient` for a place outside the grid.

    Verified by tests/unit/test_height_field.py.
    """

    heights: FloatArray
    spacing: tuple[float, float]
    origin: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if self.heights.ndim != 2 or min(self.heights.shape) < 4:
            raise InputError("height field", self.heights.shape, "needs 4 x 4 heights or more", "give a finer grid")
        if not np.all(np.isfinite(self.heights)):
            raise InputError("height field", "NaN or infinity", "must be finite", "fill gaps of the data first")
        if not (np.all(np.isfinite([*self.spacing, *self.origin])) and min(self.spacing) > 0.0):
            value = f"{self.spacing} m, {self.origin} m"
            raise InputError("height field spacing, origin", value, "must be finite, spacing > 0", "give metres")
        if np.max(np.abs(self.heights)) > _HIGHEST:
            value = f"{np.max(np.abs(self.heights)):g} m"
            raise InputError("height field", value, f"must not exceed {_HIGHEST:g} m", "check its unit, give metres")
        if min(self.spacing) < _SPACING[0] or max(self.spacing) > _SPACING[1]:
            rule = f"must lie between {_SPACING[0]:g} m and {_SPACING[1]:g} m"
            raise InputError("height field spacing", f"{self.spacing} m", rule, "check its unit, give metres")

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height (...) [m] at x, y [m], see `contracts.terrain.Terrain`."""
        return self._interpolated(x, y, 0, 0)

    def gradient(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Slopes (..., 2) [-] at x, y [m], see `contracts.terrain.Terrain`."""
        return np.stack([self._interpolated(x, y, 1, 0), self._interpolated(x, y, 0, 1)], axis=-1)

    def pieces(self) -> TerrainPieces:
        """One height field with the bounds of its tiles."""
        row = [PieceKind.HEIGHT_FIELD, *self.origin, *self.spacing]
        rows = np.array([[*row, *[0.0] * (PIECE_SIZE - len(row))]])
        knots = self._knots()
        return TerrainPieces(rows, knots, _ceilings(knots))

    def _knots(self) -> FloatArray:
        """Heights with a row more on each side, so that the end cells are of third order too."""
        grown = _grown(_grown(self.heights).T).T
        return np.ascontiguousarray(grown, dtype=np.float64)

    def _interpolated(self, x: FloatArray, y: FloatArray, by_x: int, by_y: int) -> FloatArray:
        """Derivative of the given orders."""
        i, along = self._weights(x, 0, by_x)
        j, across = self._weights(y, 1, by_y)
        four = np.arange(4)
        stencil = self._knots()[i[..., None, None] + four[:, None], j[..., None, None] + four]
        return np.asarray(np.einsum("...a,...ab,...b->...", along, stencil, across))

    def _weights(self, place: FloatArray, axis: int, order: int) -> tuple[NDArray[np.int64], FloatArray]:
        """First knot and the four weights along one axis."""
        u = (np.asarray(place, dtype=np.float64) - self.origin[axis]) / self.spacing[axis]
        last = self.heights.shape[axis] - 1
        if np.any((u < -1e-9) | (u > last + 1e-9)):
            low = self.origin[axis]
            rule = f"must lie in the height field, {low:g}..{low + last * self.spacing[axis]:g} m"
            raise InputError("xy"[axis], f"{np.min(place):g}..{np.max(place):g} m", rule, "give a larger field")
        cell = np.clip(np.floor(u).astype(np.int64), 0, last - 1)
        return cell, cubic_weights(u - cell, order) / self.spacing[axis] ** order


def cubic_weights(t: FloatArray, order: int = 0) -> FloatArray:
    """Weights (..., 4) [-] of the heights at -1, 0, 1, 2 for places t (...) in 0..1 [-], or their derivative by t."""
    coefficients = 0.5 * np.array([[0, -1, 2, -1], [2, 0, -5, 3], [0, 1, 4, -3], [0, 0, -1, 1]], dtype=np.float64)
    powers = [t**0, t, t**2, t**3] if order == 0 else [0.0 * t, t**0, 2 * t, 3 * t**2]
    return np.asarray(np.stack(powers, axis=-1) @ coefficients.T)


def _grown(h: FloatArray) -> FloatArray:
    """One row more before and behind."""
    return np.concatenate([[3 * h[0] - 3 * h[1] + h[2]], h, [3 * h[-1] - 3 * h[-2] + h[-3]]])


def _ceilings(knots: FloatArray) -> FloatArray:
    """Largest Bezier ordinate over each tile, an upper bound of the surface there."""
    bound = _ordinates(np.moveaxis(_ordinates(knots), 2, 0)).max(axis=(0, 2)).T
    tiles = [-(-n // TILE) for n in bound.shape]
    padding = [(0, TILE * m - n) for m, n in zip(tiles, bound.shape, strict=True)]
    filled = np.pad(bound, padding, constant_values=-np.inf).reshape(tiles[0], TILE, tiles[1], TILE)
    return np.ascontiguousarray(filled.max(axis=(1, 3)))


def _ordinates(knots: FloatArray) -> FloatArray:
    """Four Bezier ordinates of each cell along the first axis, (4, n - 3, ...)."""
    before, left, right, behind = knots[:-3], knots[1:-2], knots[2:-1], knots[3:]
    return np.array([left, left + (right - before) / 6.0, right - (behind - left) / 6.0, right])


def sampled_terrain(terrain: Terrain, x: FloatArray, y: FloatArray) -> HeightField:
    """Height field through a terrain's heights at equidistant grid lines x (n_x,) and y (n_y,) [m].

    Verified by tests/unit/test_height_field.py (third order).
    """
    heights = terrain.height(*np.meshgrid(x, y, indexing="ij"))
    spacing = (float(x[1] - x[0]), float(y[1] - y[0]))
    return HeightField(heights=heights, spacing=spacing, origin=(float(x[0]), float(y[0])))
