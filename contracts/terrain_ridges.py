"""Terrain that varies along one horizontal axis: step, cleat, crevasse, half-round, sinusoid.

Each has a yaw, the angle from +x to its axis s about +z. World frame: z up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import PieceKind, TerrainPieces, check_finite, terrain_pieces

__all__ = ["Cleat", "Crevasse", "HalfRound", "Sinusoid", "Step"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Ridge:
    """Shapes that vary along s only: heights and slopes from those of their profile.

    Attributes
    ----------
    position, yaw : place of the shape's own origin along s [m] and the direction of s [rad]
    base : height of the ground beside it [m]
    """

    position: float = 0.0
    yaw: float = 0.0
    base: float = 0.0

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height over the base [m] and slope [-] at s from the shape's own origin."""
        raise NotImplementedError

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height (...) [m] at x, y [m] in the world frame, see `Terrain`."""
        return self.base + self.profile(self._along(x, y))[0]

    def gradient(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Slopes (..., 2) [-] along x and y of the world frame, see `Terrain`."""
        slope = self.profile(self._along(x, y))[1]
        return np.stack([math.cos(self.yaw) * slope, math.sin(self.yaw) * slope], axis=-1)

    def _along(self, x: FloatArray, y: FloatArray) -> FloatArray:
        return np.asarray(math.cos(self.yaw) * np.asarray(x) + math.sin(self.yaw) * np.asarray(y) - self.position)

    def _row(self, kind: PieceKind, *numbers: float) -> list[float]:
        return [kind, math.cos(self.yaw), math.sin(self.yaw), self.position, *numbers]

    def _level(self, depth: float = 0.0) -> list[float]:
        """Level ground at the base, or below it [m]."""
        return [PieceKind.PLANE, 0.0, 0.0, 1.0, self.base - depth]

    def _check(self, shape: str, **lengths: float) -> None:
        """Refuse lengths that are not above zero, and a place that is not finite."""
        for name, value in lengths.items():
            if not (math.isfinite(value) and value > 0.0):
                what = f"{shape} {name.replace('_', ' ')}"
                raise InputError(what, f"{value:g} m", "must be finite and > 0", "give a length in metres")
        check_finite(f"{shape} position, yaw, base", self.position, self.yaw, self.base)


@dataclass(frozen=True, slots=True, kw_only=True)
class Step(_Ridge):
    """A block's corner on level ground: the block fills s > 0 up to base + rise.

    Attributes
    ----------
    rise : height of the step [m]; points deeper than this below its top are pressed by the lower ground too
    edge_radius : radius of its edge [m], at most the rise; penetration must stay below it, since deeper points are
        pushed out of the nearer face
    position, yaw, base : of the step's face, of the lower ground

    Verified by tests/unit/test_terrain.py.
    """

    rise: float
    edge_radius: float

    def __post_init__(self) -> None:
        self._check("step", rise=self.rise, edge_radius=self.edge_radius)
        if self.edge_radius > self.rise:
            raise InputError("step edge radius", f"{self.edge_radius:g} m", "must not exceed the rise", "lower it")

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height [m] and slope [-] at s [m]: level ground, a quarter circle, the block's top."""
        r = self.edge_radius
        height, slope = _arc(np.clip(s - r, -r, 0.0), r)
        return np.where(s > 0.0, self.rise - r + height, 0.0), np.where(s > 0.0, slope, 0.0)

    def pieces(self) -> TerrainPieces:
        """Rounded corner and lower ground."""
        return terrain_pieces(
            self._row(PieceKind.CORNER, self.base + self.rise, self.edge_radius),
            self._level(),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Cleat(_Ridge):
    """A bar across level ground, upright at its sides, with rounded edges.

    Attributes
    ----------
    rise : of its top over the ground [m]; points deeper than this below it are pressed by the ground too
    width : from side to side along s [m]
    edge_radius : of both edges [m], at most the rise and half the width; penetration must stay below it, as for `Step`
    position, yaw, base : of its middle, of the ground

    Verified by tests/unit/test_terrain.py.
    """

    rise: float
    width: float
    edge_radius: float

    def __post_init__(self) -> None:
        self._check("cleat", rise=self.rise, width=self.width, edge_radius=self.edge_radius)
        if self.edge_radius > min(self.rise, 0.5 * self.width):
            rule = "must not exceed the rise and half the width"
            raise InputError("cleat edge radius", f"{self.edge_radius:g} m", rule, "lower it")

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height [m] and slope [-] at s [m]: ground, a quarter circle, the top, a quarter circle, ground."""
        r, inside = self.edge_radius, 0.5 * self.width - np.abs(s)
        height, slope = _arc(np.clip(inside - r, -r, 0.0), r)
        solid = inside > 0.0
        return np.where(solid, self.rise - r + height, 0.0), np.where(solid, np.where(s > 0.0, -slope, slope), 0.0)

    def pieces(self) -> TerrainPieces:
        """The bar and the ground."""
        top = self.base + self.rise
        return terrain_pieces(self._row(PieceKind.CLEAT, top, self.edge_radius, 0.5 * self.width), self._level())


@dataclass(frozen=True, slots=True, kw_only=True)
class Crevasse(_Ridge):
    """A trench with upright walls and rounded edges in level ground.

    Attributes
    ----------
    width : from wall to wall along s [m]
    depth : of its floor below the ground [m]
    edge_radius : radius of both edges [m], at most the depth; penetration must stay below it, as for `Step`
    position, yaw, base : of its first wall, of the ground

    Verified by tests/unit/test_terrain.py.
    """

    width: float
    depth: float
    edge_radius: float

    def __post_init__(self) -> None:
        self._check("crevasse", width=self.width, depth=self.depth, edge_radius=self.edge_radius)
        if self.edge_radius > self.depth:
            raise InputError("crevasse edge radius", f"{self.edge_radius:g} m", "must not exceed the depth", "lower it")

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height [m] and slope [-] at s [m]: ground, a quarter circle, the floor, a quarter circle, ground."""
        r, inside = self.edge_radius, np.maximum(-s, s - self.width)
        height, slope = _arc(np.clip(inside - r, -r, 0.0), r)
        solid = inside > 0.0
        return (
            np.where(solid, height - r, -self.depth),
            np.where(solid, np.where(s > 0.0, slope, -slope), 0.0),
        )

    def pieces(self) -> TerrainPieces:
        """Two rounded corners and the floor."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return terrain_pieces(
            [PieceKind.CORNER, -c, -s, -self.position, self.base, self.edge_radius],
            [PieceKind.CORNER, c, s, self.position + self.width, self.base, self.edge_radius],
            self._level(self.depth),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfRound(_Ridge):
    """Half a cylinder that lies on level ground, its axis at right angles to s.

    Attributes
    ----------
    radius : of the cylinder, and its height over the ground [m]
    position, yaw, base : of its axis, of the ground

    Verified by tests/unit/test_terrain.py.
    """

    radius: float

    def __post_init__(self) -> None:
        self._check("half-round", radius=self.radius)

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height [m] and slope [-] at s [m]: a circle over level ground."""
        return _arc(s, self.radius)

    def pieces(self) -> TerrainPieces:
        """Cylinder and ground."""
        return terrain_pieces(self._row(PieceKind.HALF_ROUND, self.base, self.radius), self._level())


@dataclass(frozen=True, slots=True, kw_only=True)
class Sinusoid(_Ridge):
    """Waves h = base + amplitude sin(2 pi (s - position) / wavelength).

    Attributes
    ----------
    amplitude, wavelength : [m]; penetration must stay below the crests' radius (wavelength / 2 pi)^2 / amplitude
    position, yaw, base : of a rising zero, mean height

    Verified by tests/unit/test_terrain.py.
    """

    amplitude: float
    wavelength: float

    def __post_init__(self) -> None:
        self._check("sinusoid", amplitude=self.amplitude, wavelength=self.wavelength)

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height [m] and slope [-] at s [m]: a sine and its derivative."""
        k = 2.0 * math.pi / self.wavelength
        return self.amplitude * np.sin(k * s), self.amplitude * k * np.cos(k * s)

    def pieces(self) -> TerrainPieces:
        """One sinusoid."""
        return terrain_pieces(self._row(PieceKind.SINUSOID, self.base, self.amplitude, 2.0 * math.pi / self.wavelength))


def _arc(s: FloatArray, radius: float) -> tuple[FloatArray, FloatArray]:
    """Upper half of a circle about s = 0: height and slope, zero beside it and where it is upright."""
    height = np.sqrt(np.maximum(radius * radius - s * s, 0.0))
    return height, np.divide(-s, height, out=np.zeros_like(height), where=height > 0.0)
