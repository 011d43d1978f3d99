"""How the undisturbed ground lies below a wheel: the plane nearest to its heights over the footprint.

The wheel's sinkage, heading and angles are told from this plane; what a cell lies higher or lower than it is added to
the cell's depth. Level soil is the plane z = 0. A slope of the ground is then the same as a tilt of gravity, and ground
that bends or is rough within a footprint is told to first order.

Verified by tests/unit/test_rover_soil_terrain.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import Terrain
from rover_dynamics.multibody.compiled import inlined
from rover_dynamics.soil.field import SoilField
from rover_dynamics.tires.brush_compiled import Vector, compiled

__all__ = ["Lie", "footprint_plane", "lie_below", "lies_higher"]

FloatArray = NDArray[np.float64]
type Lie = tuple[Vector, float, Vector]
"""Normal out of the ground; height of the hub over the plane along it [m]; slopes along x and y [-], height above."""
SPOTS = 2
"""Heights looked at to each side of the hub along x and y, besides its own."""
REACH = 0.5
"""How far from the hub the outermost lie, over the wheel's radius."""


@compiled
def lie_below(p: Vector, radius: float, field: SoilField) -> Lie:
    """The plane below a hub at p [m]; its slopes with the height of the hub straight above it [m] as third."""
    if field.surface.shape[0] == 0:
        return (0.0, 0.0, 1.0), p[2], (0.0, 0.0, p[2])
    spacing, mean, along_x, along_y, square = REACH * radius / SPOTS, 0.0, 0.0, 0.0, 0.0
    for i in range(-SPOTS, SPOTS + 1):
        square += (2 * SPOTS + 1) * (i * spacing) ** 2
        for k in range(-SPOTS, SPOTS + 1):
            h = _height(p[0] + i * spacing, p[1] + k * spacing, field)
            mean += h / (2 * SPOTS + 1) ** 2
            along_x += h * i * spacing
            along_y += h * k * spacing
    x, y, above = along_x / square, along_y / square, p[2] - mean
    over = 1.0 / math.sqrt(1.0 + x * x + y * y)
    return (-x * over, -y * over, over), above * over, (x, y, above)


@inlined
def lies_higher(row: int, column: int, place: Vector, lie: Lie, p: Vector, field: SoilField) -> float:
    """How much a cell's undisturbed ground lies over the plane, along its normal [m]; ``place`` from the hub."""
    if field.surface.shape[0] == 0:
        return 0.0
    return float((field.surface[row, column] - p[2] - place[2]) * lie[0][2])


@compiled
def _height(x: float, y: float, field: SoilField) -> float:
    """Of the undisturbed ground between four cells; beyond the field as at its edge."""
    rows, columns = field.surface.shape
    u = min(max((x - field.x) / field.cell, 0.0), rows - 1.0)
    v = min(max((y - field.y) / field.cell, 0.0), columns - 1.0)
    i, k = min(int(u), rows - 2), min(int(v), columns - 2)
    u, v = u - i, v - k
    h = field.surface
    near = h[i, k] + u * (h[i + 1, k] - h[i, k])
    far = h[i, k + 1] + u * (h[i + 1, k + 1] - h[i, k + 1])
    return float(near + v * (far - near))


def footprint_plane(terrain: Terrain, x: FloatArray, y: FloatArray, radius: float) -> tuple[FloatArray, FloatArray]:
    """Heights (n,) [m] at x, y (n,) [m] and unit normals (n, 3) of the planes that `lie_below` finds on a terrain."""
    spots = REACH * radius / SPOTS * np.arange(-SPOTS, SPOTS + 1)
    h = terrain.height(x[:, None, None] + spots[:, None] + 0.0 * spots, y[:, None, None] + 0.0 * spots[:, None] + spots)
    square = len(spots) * float(spots @ spots)
    slopes = np.stack([np.einsum("nik,i->n", h, spots), np.einsum("nik,k->n", h, spots)], axis=-1) / square
    normals = np.concatenate([-slopes, np.ones((len(x), 1))], axis=-1)
    return h.mean(axis=(1, 2)), normals / np.linalg.norm(normals, axis=-1, keepdims=True)
