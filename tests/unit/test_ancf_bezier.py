"""The map between plate coordinates and Bezier control points, against thesis eq. 2.13; what the plate cannot hold."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.plates.bezier import bezier_to_plate, coons_residual, elevated, plate_to_bezier
from ancf_reduced.plates.shape_functions import plate_shape
from geometry.spline_surface import bernstein

RNG = np.random.default_rng(1)
UNIT = np.ones(3)


def _value(control_points: np.ndarray, xi: np.ndarray) -> np.ndarray:
    return np.einsum("ki,kj,ijx->kx", bernstein(xi[:, 0]), bernstein(xi[:, 1]), control_points)


@pytest.mark.parametrize("zeta", [-0.5, 0.0, 0.5])
def test_a_plate_is_its_bezier_patch(zeta: float) -> None:
    """Eq. 2.13 evaluated as printed, against the patch, at random points and coordinates."""
    e = RNG.normal(size=(16, 3))
    xi = np.column_stack([RNG.uniform(size=(50, 2)), np.full(50, zeta)])
    np.testing.assert_allclose(_value(plate_to_bezier(e, zeta), xi), plate_shape(xi, UNIT) @ e, atol=1e-13)


def test_there_and_back_is_exact() -> None:
    """Both ways to 1e-12, many plates at once."""
    e = RNG.normal(size=(5, 16, 3))
    middle = plate_to_bezier(e)
    director = (plate_to_bezier(e, 0.5) - plate_to_bezier(e, -0.5))[:, ::3, ::3]
    np.testing.assert_allclose(bezier_to_plate(middle, director), e, atol=1e-12)
    np.testing.assert_allclose(plate_to_bezier(bezier_to_plate(middle, director)), middle, atol=1e-12)
    assert coons_residual(middle).max() < 1e-14


def test_the_space_has_twelve_terms() -> None:
    """xi^i eta^j is in it if and only if i <= 1 or j <= 1."""
    line = np.linspace(0.0, 1.0, 4)
    to_bezier = np.linalg.inv(bernstein(line))
    for i in range(4):
        for j in range(4):
            values = np.multiply.outer(line**i, line**j)[..., None] * np.array([0.0, 0.0, 1.0])
            patch = np.einsum("ik,jl,klx->ijx", to_bezier, to_bezier, values)
            assert (coons_residual(patch) < 1e-14) == (i <= 1 or j <= 1)


def test_the_residual_bounds_the_distance_and_is_reached() -> None:
    """All four inner points moved by 1 mm: 9/16 mm at the centre. Moved at random: never above the bound."""
    xi = np.stack(np.meshgrid(*2 * [np.linspace(0, 1, 21)], indexing="ij"), axis=-1).reshape(-1, 2)
    for k in range(10):
        patch = plate_to_bezier(RNG.normal(size=(16, 3)))
        moved = patch.copy()
        moved[1:3, 1:3] += 1e-3 * (np.array([0.0, 0.0, 1.0]) if k == 0 else RNG.normal(size=(2, 2, 3)))
        distance = np.linalg.norm(_value(moved - patch, xi), axis=1).max()
        assert distance <= coons_residual(moved) * (1.0 + 1e-9)
        if k == 0:
            assert distance == pytest.approx(9e-3 / 16.0, rel=1e-9) == coons_residual(moved)


@pytest.mark.parametrize("point", [(0, 0), (1, 0), (3, 2), (1, 1)])
def test_negative_control_a_moved_control_point_is_seen(point: tuple[int, int]) -> None:
    e = RNG.normal(size=(16, 3))
    moved = plate_to_bezier(e)
    moved[point] += 1e-6
    assert coons_residual(moved) > 1e-8
    back = bezier_to_plate(moved, np.zeros((2, 2, 3)))
    changed = np.abs(back - bezier_to_plate(plate_to_bezier(e), np.zeros((2, 2, 3)))).max()
    assert (changed > 1e-7) == (point != (1, 1))  # an inner point is lost, a boundary point is a coordinate


def test_elevation_keeps_a_bilinear_surface() -> None:
    corners = RNG.normal(size=(2, 2, 3))
    xi = RNG.uniform(size=(9, 2))
    u, v = xi.T[..., None]
    bilinear = (1 - u) * ((1 - v) * corners[0, 0] + v * corners[0, 1]) + u * (
        (1 - v) * corners[1, 0] + v * corners[1, 1]
    )
    np.testing.assert_allclose(_value(elevated(corners), xi), bilinear, atol=1e-14)
