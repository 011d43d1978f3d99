"""Rigid terrain shared by every tire: shapes as numbers, their heights and slopes, and the pieces a kernel reads.

World frame: z up, any units of length in metres. A terrain is a union of pieces of solid. A point has one normal gap to
each piece and one contact condition for each, so the union needs no blend: at a re-entrant corner both pieces press.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = [
    "PieceKind",
    "Plane",
    "Terrain",
    "TerrainPieces",
    "TerrainUnion",
    "check_finite",
    "inclined_plane",
    "normals",
    "terrain_pieces",
]

FloatArray = NDArray[np.float64]
PIECE_SIZE = 7


class PieceKind(IntEnum):
    """The first number of a piece's row, and what follows; c, s are cosine and sine of the yaw, s0 a place along s."""

    PLANE = 0
    """n_x, n_y, n_z, d: solid where n . r < d."""
    CORNER = 1
    """c, s, s0, z0, radius: solid beyond s0 and below z0, its edge rounded."""
    HALF_ROUND = 2
    """c, s, s0, z0, radius: axis at right angles to s, at the height z0; below it upright sides."""
    SINUSOID = 3
    """c, s, s0, z0, amplitude, wave number: solid below z0 + amplitude sin(wave number (s - s0))."""
    HEIGHT_FIELD = 4
    """x0, y0, dx, dy: solid below the interpolated heights."""
    CLEAT = 5
    """c, s, s0, z0, radius, half width: solid within it of s0 and below z0, both edges rounded."""


class TerrainPieces(NamedTuple):
    """A terrain as arrays, the form compiled loops read.

    Attributes
    ----------
    rows : (n_pieces, 7) float, kind and parameters as `PieceKind` lists them [m, 1/m, -]
    knots : (n_x + 2, n_y + 2) float [m], heights of the height field with one row more on each side; else (0, 0)
    ceilings : (n, m) float [m], upper bound of the height field over each tile of cells; else (0, 0)
    """

    rows: FloatArray
    knots: FloatArray
    ceilings: FloatArray


class Terrain(Protocol):
    """What every terrain offers. Heights and slopes are those of its upper surface, seen from above."""

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height h(x, y) [m], broadcast."""

    def gradient(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Slopes (..., 2) float [-], dh/dx and dh/dy."""

    def pieces(self) -> TerrainPieces:
        """The same terrain for compiled loops."""


def normals(terrain: Terrain, x: FloatArray, y: FloatArray) -> FloatArray:
    """Unit normals of the upper surface, out of the ground, (..., 3) float [-].

    Verified by tests/unit/test_terrain.py.
    """
    slope = terrain.gradient(x, y)
    n = np.concatenate([-slope, np.ones((*slope.shape[:-1], 1))], axis=-1)
    return np.asarray(n / np.linalg.norm(n, axis=-1, keepdims=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class Plane:
    """Half space n . r < offset.

    Attributes
    ----------
    normal : unit vector out of the ground [-]; only with a component upwards has the plane a height
    offset : n . r on the surface [m]

    Raises
    ------
    InputError
        If the normal's length is not 1.

    Verified by tests/unit/test_terrain.py.
    """

    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)
    offset: float = 0.0

    def __post_init__(self) -> None:
        if not abs(math.hypot(*self.normal) - 1.0) < 1e-12:
            raise InputError("plane normal", self.normal, "must have length 1", "divide it by its length")
        check_finite("plane offset", self.offset)

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height (...) [m] at x, y [m], see `Terrain`; InputError for a vertical or overhanging plane."""
        slope = self.gradient(x, y)
        return np.asarray(self.offset / self.normal[2] + slope[..., 0] * x + slope[..., 1] * y)

    def gradient(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Slopes (..., 2) [-], see `Terrain`; InputError for a vertical or overhanging plane."""
        a, b, c = self.normal
        if c <= 0.0:
            raise InputError("plane normal", self.normal, "must point upwards to have a height", "turn the plane")
        shape = np.broadcast(x, y).shape
        return np.broadcast_to(np.array([-a / c, -b / c]), (*shape, 2))

    def pieces(self) -> TerrainPieces:
        """One half space."""
        return terrain_pieces([PieceKind.PLANE, *self.normal, self.offset])


def inclined_plane(slope: float, heading: float = 0.0, height: float = 0.0) -> Plane:
    """Plane that rises at an angle ``slope`` towards ``heading``, at ``height`` above the origin.

    Parameters
    ----------
    slope : angle of the steepest ascent [rad], in 0..pi/2
    heading : direction of the ascent from +x about +z [rad]
    height : z above x = y = 0 [m]
    """
    if not 0.0 <= slope < 0.5 * math.pi:
        raise InputError("slope", f"{slope:g} rad", "must lie in [0, pi/2)", "give e.g. 0.436 rad for 25 degrees")
    rise, flat = math.sin(slope), math.cos(slope)
    normal = (-rise * math.cos(heading), -rise * math.sin(heading), flat)
    length = math.hypot(*normal)
    return Plane(normal=(normal[0] / length, normal[1] / length, normal[2] / length), offset=height * flat)


@dataclass(frozen=True, slots=True, kw_only=True)
class TerrainUnion:
    """Several terrains in one; pieces that two of them share (the ground below two steps) count once.

    Attributes
    ----------
    parts : one terrain or more, at most one of them a height field

    Verified by tests/unit/test_terrain.py.
    """

    parts: tuple[Terrain, ...]

    def __post_init__(self) -> None:
        fields = sum(part.pieces().knots.size > 0 for part in self.parts)
        if not self.parts or fields > 1:
            value = f"{len(self.parts)} parts, {fields} height fields"
            raise InputError("terrain", value, "needs a part, and at most one height field", "add the heights up")

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the highest part [m] at x, y [m]."""
        return np.asarray(np.max([part.height(x, y) for part in self.parts], axis=0))

    def gradient(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Slopes (..., 2) of the highest part [-] at x, y (...) [m]."""
        highest = np.argmax([part.height(x, y) for part in self.parts], axis=0)
        slopes = np.array([part.gradient(x, y) for part in self.parts])
        return np.asarray(np.take_along_axis(slopes, highest[None, ..., None], axis=0)[0])

    def pieces(self) -> TerrainPieces:
        """All different pieces."""
        parts = [part.pieces() for part in self.parts]
        field = max(parts, key=lambda part: part.knots.size)
        rows = np.unique(np.concatenate([part.rows for part in parts]), axis=0)
        return TerrainPieces(rows, field.knots, field.ceilings)


def terrain_pieces(*rows: list[float]) -> TerrainPieces:
    """Rows filled up with zeros, (n, PIECE_SIZE), and no height field."""
    filled = np.array([[*row, *[0.0] * (PIECE_SIZE - len(row))] for row in rows], dtype=np.float64)
    return TerrainPieces(filled, np.empty((0, 0)), np.empty((0, 0)))


def check_finite(what: str, *values: float) -> None:
    """Raise InputError, naming ``what``, unless all values are finite."""
    if not all(math.isfinite(value) for value in values):
        raise InputError(what, values, "must be finite", "give numbers")
