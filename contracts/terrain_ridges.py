"""Terrain that varies along one horizontal axis: step, crevasse, half-round, sinusoid.

Each has a yaw, the angle from +x to its axis s about +z. World frame: z up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import PieceKind, TerrainPieces, check_finite, terrain_pieces

__all__ = ["Crevasse", "HalfRound", "Sinusoid", "Step"]

FloatArray = NDArray[np.float64]


class _Ridge:
    """Shapes that vary along s only: heights and slopes from those of their profile."""

    __slots__ = ()
    position: float
    yaw: float

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height [m] and slope [-] at s from the shape's own origin."""
        raise NotImplementedError

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """See `Terrain`."""
        return self.profile(self._along(x, y))[0]

    def gradient(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """See `Terrain`."""
        slope = self.profile(self._along(x, y))[1]
        return np.stack([math.cos(self.yaw) * slope, math.sin(self.yaw) * slope], axis=-1)

    def _along(self, x: FloatArray, y: FloatArray) -> FloatArray:
        return np.asarray(math.cos(self.yaw) * np.asarray(x) + math.sin(self.yaw) * np.asarray(y) - self.position)

    def _row(self, kind: PieceKind, *numbers: float) -> list[float]:
        return [kind, math.cos(self.yaw), math.sin(self.yaw), self.position, *numbers]


@dataclass(frozen=True, slots=True, kw_only=True)
class Step(_Ridge):
    """A block's corner on level ground: the block fills s > position up to base + rise.

    Attributes
    ----------
    rise : height of the step [m]; points deeper than this below its top are pressed by the lower ground too
    edge_radius : radius of its edge [m], at most the rise; penetration must stay below it, since deeper points are
        pushed out of the nearer face
    position, yaw : place of the step's face along s [m] and the direction of s [rad]
    base : height of the lower ground [m]

    Verified by tests/unit/test_terrain.py.
    """

    rise: float
    edge_radius: float
    position: float = 0.0
    yaw: float = 0.0
    base: float = 0.0

    def __post_init__(self) -> None:
        _positive("step rise", self.rise)
        _positive("step edge radius", self.edge_radius)
        check_finite("step position, yaw, base", self.position, self.yaw, self.base)
        if self.edge_radius > self.rise:
            raise InputError("step edge radius", f"{self.edge_radius:g} m", "must not exceed the rise", "lower it")

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Level ground, a quarter circle, the block's top."""
        r, top = self.edge_radius, self.base + self.rise
        t = np.clip(r - s, 0.0, r)
        depth = np.sqrt(r * r - t * t)
        on_edge = (t > 0.0) & (depth > 0.0)
        slope = np.divide(t, depth, out=np.zeros_like(t), where=on_edge)
        return np.where(s > 0.0, top - r + depth, self.base), np.where(s > 0.0, slope, 0.0)

    def pieces(self) -> TerrainPieces:
        """Rounded corner and lower ground."""
        return terrain_pieces(
            self._row(PieceKind.CORNER, self.base + self.rise, self.edge_radius),
            [PieceKind.PLANE, 0.0, 0.0, 1.0, self.base],
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Crevasse(_Ridge):
    """A trench with upright walls and rounded edges in level ground.

    Attributes
    ----------
    width : from wall to wall along s [m]
    depth : of its floor below the ground [m]
    edge_radius : radius of both edges [m], at most the depth; penetration must stay below it, as for `Step`
    position, yaw : place of its first wall along s [m] and the direction of s [rad]
    base : height of the ground [m]

    Verified by tests/unit/test_terrain.py.
    """

    width: float
    depth: float
    edge_radius: float
    position: float = 0.0
    yaw: float = 0.0
    base: float = 0.0

    def __post_init__(self) -> None:
        _positive("crevasse width", self.width)
        _positive("crevasse depth", self.depth)
        _positive("crevasse edge radius", self.edge_radius)
        check_finite("crevasse position, yaw, base", self.position, self.yaw, self.base)
        if self.edge_radius > self.depth:
            raise InputError("crevasse edge radius", f"{self.edge_radius:g} m", "must not exceed the depth", "lower it")

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Ground, a quarter circle, the floor, a quarter circle, ground."""
        r, inside = self.edge_radius, np.maximum(-s, s - self.width)
        t = np.clip(r - inside, 0.0, r)
        height = np.sqrt(r * r - t * t)
        slope = np.divide(t, height, out=np.zeros_like(t), where=(t > 0.0) & (height > 0.0))
        solid = inside > 0.0
        return (
            np.where(solid, self.base - r + height, self.base - self.depth),
            np.where(solid, np.where(s > 0.0, slope, -slope), 0.0),
        )

    def pieces(self) -> TerrainPieces:
        """Two rounded corners and the floor."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return terrain_pieces(
            [PieceKind.CORNER, -c, -s, -self.position, self.base, self.edge_radius],
            [PieceKind.CORNER, c, s, self.position + self.width, self.base, self.edge_radius],
            [PieceKind.PLANE, 0.0, 0.0, 1.0, self.base - self.depth],
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfRound(_Ridge):
    """Half a cylinder that lies on level ground, its axis at right angles to s.

    Attributes
    ----------
    radius : of the cylinder, and its height over the ground [m]
    position, yaw : place of its axis along s [m] and the direction of s [rad]
    base : height of the ground [m]

    Verified by tests/unit/test_terrain.py.
    """

    radius: float
    position: float = 0.0
    yaw: float = 0.0
    base: float = 0.0

    def __post_init__(self) -> None:
        _positive("half-round radius", self.radius)
        check_finite("half-round position, yaw, base", self.position, self.yaw, self.base)

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Circle over level ground."""
        rise = np.sqrt(np.maximum(self.radius**2 - s * s, 0.0))
        slope = np.divide(-s, rise, out=np.zeros_like(rise), where=rise > 0.0)
        return self.base + rise, slope

    def pieces(self) -> TerrainPieces:
        """Cylinder and ground."""
        return terrain_pieces(
            self._row(PieceKind.HALF_ROUND, self.base, self.radius), [PieceKind.PLANE, 0.0, 0.0, 1.0, self.base]
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Sinusoid(_Ridge):
    """Waves h = base + amplitude sin(2 pi (s - position) / wavelength).

    Attributes
    ----------
    amplitude, wavelength : [m]; penetration must stay below the crests' radius (wavelength / 2 pi)^2 / amplitude
    position, yaw : a rising zero along s [m] and the direction of s [rad]
    base : mean height [m]

    Verified by tests/unit/test_terrain.py.
    """

    amplitude: float
    wavelength: float
    position: float = 0.0
    yaw: float = 0.0
    base: float = 0.0

    def __post_init__(self) -> None:
        _positive("sinusoid amplitude", self.amplitude)
        _positive("sinusoid wavelength", self.wavelength)
        check_finite("sinusoid position, yaw, base", self.position, self.yaw, self.base)

    def profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Sine and its derivative."""
        k = 2.0 * math.pi / self.wavelength
        return self.base + self.amplitude * np.sin(k * s), self.amplitude * k * np.cos(k * s)

    def pieces(self) -> TerrainPieces:
        """One sinusoid."""
        return terrain_pieces(self._row(PieceKind.SINUSOID, self.base, self.amplitude, 2.0 * math.pi / self.wavelength))


def _positive(what: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(what, f"{value:g} m", "must be finite and > 0", "give a length in metres")
