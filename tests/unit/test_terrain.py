"""Terrain shapes: heights and slopes against closed forms and finite differences, unions, bad input."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import PieceKind, Plane, Terrain, TerrainUnion, inclined_plane, normals
from contracts.terrain_ridges import Cleat, Crevasse, HalfRound, Sinusoid, Step

STEP = Step(rise=0.1, edge_radius=0.02, position=0.3, yaw=np.pi / 2, base=0.05)
SHAPES: list[Terrain] = [
    inclined_plane(0.4, 0.7, 0.1),
    STEP,
    Crevasse(width=0.15, depth=0.4, edge_radius=0.02, position=0.1, yaw=0.3, base=0.05),
    HalfRound(radius=0.05, position=0.02, yaw=0.4),
    Cleat(rise=0.05, width=0.3, edge_radius=0.02, position=0.02, yaw=0.4, base=0.01),
    Sinusoid(amplitude=0.03, wavelength=0.4, position=0.1, yaw=-0.5, base=0.2),
    TerrainUnion(parts=(HalfRound(radius=0.05), HalfRound(radius=0.03, position=0.2), inclined_plane(0.1))),
]


def at(terrain: Terrain, x: float, y: float) -> float:
    return float(terrain.height(np.array(x), np.array(y)))


def test_slope_rises_by_its_tangent_towards_its_heading() -> None:
    plane = inclined_plane(np.radians(25.0), np.pi / 2, 0.1)
    assert at(plane, 5.0, 2.0) == pytest.approx(0.1 + 2.0 * np.tan(np.radians(25.0)), abs=1e-14)
    n = normals(plane, np.array(1.0), np.array(2.0))
    np.testing.assert_allclose(n, [0.0, -np.sin(np.radians(25.0)), np.cos(np.radians(25.0))], atol=1e-15)


def test_step_goes_from_base_over_a_quarter_circle_to_its_top() -> None:
    assert at(STEP, 9.0, 0.2999) == 0.05
    assert at(STEP, 9.0, 0.3 + 0.02 * (1 - np.sqrt(0.5))) == pytest.approx(0.15 - 0.02 * (1 - np.sqrt(0.5)), abs=1e-12)
    assert at(STEP, -9.0, 0.321) == pytest.approx(0.15, abs=1e-15)


def test_half_round_is_a_circle_on_its_base() -> None:
    rock = HalfRound(radius=0.05, position=0.2, base=-0.01)
    assert [at(rock, x, 3.0) for x in (0.1, 0.2, 0.23)] == pytest.approx([-0.01, 0.04, 0.03], abs=1e-14)


def test_cleat_has_two_sides_and_a_top() -> None:
    bar = Cleat(rise=0.02, width=0.1, edge_radius=0.01, position=0.2, base=-0.02)
    quarter = -0.01 * (1.0 - np.sqrt(0.75))
    assert [at(bar, x, 3.0) for x in (0.149, 0.155, 0.2, 0.245, 0.251)] == pytest.approx(
        [-0.02, quarter, 0.0, quarter, -0.02], abs=1e-14
    )
    with pytest.raises(InputError, match="half the width"):
        Cleat(rise=0.02, width=0.01, edge_radius=0.006)


def test_union_is_the_highest_and_shares_the_ground() -> None:
    both = TerrainUnion(parts=(HalfRound(radius=0.05), Step(rise=0.2, edge_radius=0.01, position=1.0)))
    assert (at(both, 0.0, 0.0), at(both, 2.0, 0.0), at(both, 0.5, 0.0)) == (0.05, pytest.approx(0.2), 0.0)
    kinds = sorted(both.pieces().rows[:, 0].astype(int))
    assert kinds == [PieceKind.PLANE, PieceKind.CORNER, PieceKind.HALF_ROUND]  # one ground, not two


@pytest.mark.parametrize("terrain", SHAPES, ids=lambda t: type(t).__name__)
def test_gradient_is_the_derivative_of_the_height(terrain: Terrain) -> None:
    x, y = np.random.default_rng(1).uniform(-0.5, 0.5, (2, 200))
    h, expected = 1e-7, terrain.gradient(x, y)
    by_x = (terrain.height(x + h, y) - terrain.height(x - h, y)) / (2 * h)
    by_y = (terrain.height(x, y + h) - terrain.height(x, y - h)) / (2 * h)
    gentle = np.hypot(*expected.T) < 3.0  # the finite difference fails where an edge becomes upright
    assert gentle.sum() > 180
    np.testing.assert_allclose(np.stack([by_x, by_y], axis=-1)[gentle], expected[gentle], rtol=0, atol=1e-5)


def test_bad_shapes_are_refused() -> None:
    with pytest.raises(InputError, match="length 1"):
        Plane(normal=(0.0, 0.0, 2.0))
    with pytest.raises(InputError, match="slope"):
        inclined_plane(np.pi / 2)
    with pytest.raises(InputError, match="upwards"):
        at(Plane(normal=(1.0, 0.0, 0.0)), 0.0, 0.0)
    with pytest.raises(InputError, match="edge radius"):
        Step(rise=0.01, edge_radius=0.02)
    with pytest.raises(InputError, match="half-round radius"):
        HalfRound(radius=-0.02)
    with pytest.raises(InputError, match="wavelength"):
        Sinusoid(amplitude=0.01, wavelength=0.0)
    with pytest.raises(InputError, match="finite"):
        Step(rise=0.1, edge_radius=0.02, yaw=np.nan)
    field = HeightField(heights=np.zeros((4, 4)), spacing=(1.0, 1.0))
    with pytest.raises(InputError, match="at most one height field"):
        TerrainUnion(parts=(field, field))


TRENCH = Crevasse(width=0.15, depth=0.4, edge_radius=0.02, position=0.1, yaw=0.3, base=0.05)


def test_crevasse_is_level_then_round_then_deep_and_the_same_from_both_sides() -> None:
    level = Crevasse(width=0.15, depth=0.4, edge_radius=0.02, position=0.1, base=0.05)
    x = np.array([-1.0, 0.08, 0.0901, 0.1001, 0.175, 0.2499, 0.2599, 0.27, 1.0])
    z = level.height(x, np.zeros(9))
    np.testing.assert_allclose(z, z[::-1], atol=1e-12)
    np.testing.assert_allclose(z[[0, 1, 3, 4, 5]], [0.05, 0.05, -0.35, -0.35, -0.35], atol=1e-12)
    assert 0.03 < z[2] < 0.05
    kinds = [PieceKind(int(kind)) for kind in TRENCH.pieces().rows[:, 0]]
    assert kinds == [PieceKind.CORNER, PieceKind.CORNER, PieceKind.PLANE]


def test_corners_of_a_crevasse_are_its_walls() -> None:
    first, second, floor = TRENCH.pieces().rows
    np.testing.assert_allclose(first[1:3], -second[1:3])
    assert (first[3], second[3], floor[4]) == (-0.1, 0.25, pytest.approx(-0.35))


def test_bad_crevasses_are_refused() -> None:
    with pytest.raises(InputError, match="crevasse width"):
        Crevasse(width=0.0, depth=0.4, edge_radius=0.02)
    with pytest.raises(InputError, match="crevasse edge radius"):
        Crevasse(width=0.15, depth=0.01, edge_radius=0.02)
    with pytest.raises(InputError, match="crevasse position"):
        Crevasse(width=0.15, depth=0.4, edge_radius=0.02, position=np.inf)
