"""Solids a picture is made of: boxes, bars and tubes as quadrangles, each in the frame of the body that carries it.

Verified by tests/unit/test_workbench_solids.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["WORLD", "Deforming", "Solid", "bar", "box", "joined", "tube"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Quads = tuple[FloatArray, IntArray]
"""Points (n, 3) float [m] and quadrangles (m, 4) int, corners counter-clockwise seen from outside."""

WORLD = -1
"""In place of a body: fixed in the world."""
_BOX = np.array([(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Solid:
    """Something drawn in one piece.

    Attributes
    ----------
    body : number of the body it is fixed to, or `WORLD`
    points : (n, 3) float [m], in the body's frame
    quads : (m, 4) int, corners of its faces
    colours : a colour such as ``"#0072b2"``, or (m, 3) uint8 for each face
    """

    body: int
    points: FloatArray
    quads: IntArray
    colours: str | NDArray[np.uint8]

    def placed(self, positions: FloatArray, rotations: FloatArray) -> FloatArray:
        """Its points in the world, (n, 3) float [m]; positions (n_b, 3) [m] and rotations (n_b, 3, 3) of all bodies."""
        if self.body == WORLD:
            return self.points
        return np.asarray(positions[self.body] + self.points @ rotations[self.body].T)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deforming:
    """A surface that changes its shape.

    Attributes
    ----------
    points : (n, n_points, 3) float [m], world, in each frame
    quads : (m, 4) int, corners of its faces
    colours : (n, m, 3) uint8, of each face in each frame
    """

    points: FloatArray
    quads: IntArray
    colours: NDArray[np.uint8]


def box(centre: ArrayLike, size: ArrayLike) -> Quads:
    """Box along the axes; size [m] along x, y, z."""
    x, y = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
    corners = np.column_stack([np.tile(x, 2), np.tile(y, 2), np.repeat([-1, 1], 4)])
    return np.asarray(centre, dtype=np.float64) + 0.5 * corners * np.asarray(size, dtype=np.float64), _BOX


def bar(start: ArrayLike, end: ArrayLike, width: float) -> Quads:
    """Square bar between two points [m]; it reaches half its width beyond them, so that bars meet."""
    a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    length = float(np.linalg.norm(b - a))
    along = (b - a) / length if length > 0.0 else np.array([1.0, 0.0, 0.0])
    aside = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    aside /= np.linalg.norm(aside)
    points, quads = box((0.0, 0.0, 0.0), (length + width, width, width))
    return 0.5 * (a + b) + points @ np.array([along, aside, np.cross(along, aside)]), quads


def tube(centre: ArrayLike, radii: tuple[float, float], width: float, sides: int = 48) -> Quads:
    """Ring about the axis y; inner and outer radius, width [m]."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angle), 0.0 * angle, np.sin(angle)])
    half = np.array([0.0, 0.5 * width, 0.0])
    inner, outer = radii
    section = [outer * circle - half, outer * circle + half, inner * circle + half, inner * circle - half]
    here = np.arange(sides)
    there = np.roll(here, -1)
    strips = [(k * sides, (k + 1) % 4 * sides) for k in range(4)]
    quads = [np.column_stack([here + a, here + b, there + b, there + a]) for a, b in strips]
    return np.asarray(centre, dtype=np.float64) + np.concatenate(section), np.concatenate(quads)


def joined(pieces: Sequence[Quads]) -> Quads:
    """Several in one."""
    first = np.cumsum([0, *(len(points) for points, _ in pieces[:-1])])
    quads = [quads + start for (_, quads), start in zip(pieces, first, strict=True)]
    return np.concatenate([points for points, _ in pieces]), np.concatenate(quads)
