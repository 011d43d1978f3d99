"""Solids of pictures are closed, turned outwards and of the size asked for.

Claim: the divergence theorem over a solid's quadrangles gives the volume of the shape; it is zero or negative if a face
is missing or turned inwards. Negative control: a box with one face turned.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from workbench.charts.solids import WORLD, Solid, bar, box, joined, tube

Quads = tuple[NDArray[np.float64], NDArray[np.int64]]


def volume(shape: Quads) -> float:
    """Enclosed by faces turned outwards [m^3]."""
    a, b, c, d = np.moveaxis(shape[0][shape[1]], 1, 0)
    return float(np.sum(a * (np.cross(b, c) + np.cross(c, d))) / 6.0)


def test_a_box_has_its_volume_and_place() -> None:
    shape = box((1.0, -2.0, 3.0), (0.2, 0.3, 0.4))
    assert volume(shape) == pytest.approx(0.024, rel=1e-12)
    assert shape[0].min(axis=0) == pytest.approx([0.9, -2.15, 2.8])


@pytest.mark.parametrize("end", [(1.0, 0.0, 0.0), (0.0, 0.0, -2.0), (0.3, -0.4, 1.2)])
def test_a_bar_reaches_half_its_width_beyond_its_ends(end: tuple[float, float, float]) -> None:
    shape = bar((0.0, 0.0, 0.0), end, 0.1)
    length = float(np.linalg.norm(end))
    along = shape[0] @ np.array(end) / length
    assert volume(shape) == pytest.approx(0.01 * (length + 0.1), rel=1e-12)
    assert (along.min(), along.max()) == pytest.approx((-0.05, length + 0.05))


def test_a_bar_between_equal_points_is_a_cube() -> None:
    assert volume(bar((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), 0.1)) == pytest.approx(1e-3)


def test_a_tube_has_the_volume_of_its_polygon() -> None:
    sides = 48
    area = 0.5 * sides * np.sin(2.0 * np.pi / sides) * (0.3**2 - 0.2**2)
    assert volume(tube((0.5, 0.5, 0.5), (0.2, 0.3), 0.4, sides)) == pytest.approx(0.4 * area, rel=1e-12)


def test_joined_solids_keep_their_volumes() -> None:
    pieces = [box((0, 0, 0), (1, 1, 1)), tube((3, 0, 0), (0.0, 1.0), 1.0, 4), box((9, 0, 0), (1, 1, 2))]
    assert volume(joined(pieces)) == pytest.approx(1.0 + 2.0 + 2.0)


def test_a_solid_moves_with_its_body_and_the_world_does_not() -> None:
    points, quads = box((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    positions = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 5.0]])
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    rotations = np.array([np.eye(3), quarter])
    moved = Solid(body=1, points=points, quads=quads, colours="#000000").placed(positions, rotations)
    fixed = Solid(body=WORLD, points=points, quads=quads, colours="#000000").placed(positions, rotations)
    assert moved == pytest.approx(np.tile([0.0, 1.0, 5.0], (8, 1)))
    assert fixed == pytest.approx(points)


def test_negative_control_a_turned_face_is_seen() -> None:
    points, quads = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    quads = quads.copy()
    quads[2] = quads[2, ::-1]
    assert volume((points, quads)) != pytest.approx(1.0, rel=1e-3)
