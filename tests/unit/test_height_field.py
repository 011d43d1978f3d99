"""Height fields: exact for quadratics, third order, bounded by their tiles, refused beside the grid."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.height_field import TILE, HeightField, cubic_weights, sampled_terrain
from contracts.terrain_ridges import Sinusoid

ROUGH = HeightField(
    heights=0.02 * np.random.default_rng(2).normal(size=(21, 30)).cumsum(axis=0),
    spacing=(0.05, 0.03),
    origin=(-0.5, 1.0),
)


def test_surface_passes_through_the_heights() -> None:
    x, y = np.meshgrid(-0.5 + 0.05 * np.arange(21), 1.0 + 0.03 * np.arange(30), indexing="ij")
    np.testing.assert_allclose(ROUGH.height(x, y), ROUGH.heights, atol=1e-12)


def test_quadratic_is_exact_up_to_the_edge() -> None:
    def h(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray(0.3 + 0.1 * x - 0.2 * y + 0.5 * x * x + x * y - 0.7 * y * y)

    grid = np.meshgrid(np.linspace(0.0, 1.0, 6), np.linspace(0.0, 1.0, 6), indexing="ij")
    field = HeightField(heights=h(*grid), spacing=(0.2, 0.2))
    x, y = np.random.default_rng(3).uniform(0.0, 1.0, (2, 100))
    np.testing.assert_allclose(field.height(x, y), h(x, y), atol=1e-13)


def test_error_falls_with_the_third_power_of_the_spacing() -> None:
    wave = Sinusoid(amplitude=0.02, wavelength=0.3, yaw=0.4)
    x, y = np.random.default_rng(4).uniform(-0.4, 0.4, (2, 2000))
    lines = [np.linspace(-0.5, 0.5, n) for n in (41, 81, 161)]
    error = [np.abs(sampled_terrain(wave, s, s).height(x, y) - wave.height(x, y)).max() for s in lines]
    order = np.log2(np.divide(error[:-1], error[1:]))
    assert np.all(order > 2.8), order


def test_gradient_is_the_derivative_of_the_height() -> None:
    x, y = np.random.default_rng(5).uniform([[-0.4], [1.1]], [[0.4], [1.8]], (2, 50))
    h, expected = 1e-6, ROUGH.gradient(x, y)
    by_x = (ROUGH.height(x + h, y) - ROUGH.height(x - h, y)) / (2 * h)
    by_y = (ROUGH.height(x, y + h) - ROUGH.height(x, y - h)) / (2 * h)
    np.testing.assert_allclose(np.stack([by_x, by_y], axis=-1), expected, rtol=0, atol=1e-4 * np.abs(expected).max())


def test_weights_are_a_partition_of_unity() -> None:
    t = np.linspace(0.0, 1.0, 7)
    np.testing.assert_allclose(cubic_weights(t).sum(axis=-1), 1.0, atol=1e-15)
    np.testing.assert_allclose(cubic_weights(t, 1).sum(axis=-1), 0.0, atol=1e-15)


def _slack(field: HeightField, n: int = 401) -> tuple[np.ndarray, np.ndarray]:
    """Ceiling less surface on a fine grid, and the tile of each point."""
    ceilings, cells = field.pieces().ceilings, np.array(field.heights.shape) - 1
    u, v = np.meshgrid(*(np.linspace(0.0, m, n) for m in cells), indexing="ij")
    surface = field.height(field.origin[0] + u * field.spacing[0], field.origin[1] + v * field.spacing[1])
    tile = (np.minimum(u, cells[0] - 1) // TILE).astype(int), (np.minimum(v, cells[1] - 1) // TILE).astype(int)
    return ceilings[tile] - surface, tile[0] * ceilings.shape[1] + tile[1]


def test_ceilings_bound_the_surface() -> None:
    assert ROUGH.pieces().ceilings.shape == (3, 4)
    assert _slack(ROUGH)[0].min() > -1e-12


def test_ceilings_of_a_smooth_surface_are_tight() -> None:
    wave = Sinusoid(amplitude=0.02, wavelength=0.3, yaw=0.4)
    slack, tile = _slack(sampled_terrain(wave, np.linspace(0.0, 0.4, 41), np.linspace(0.0, 0.3, 31)))
    assert slack.min() > -1e-12
    assert max(slack[tile == k].min() for k in range(tile.max() + 1)) < 0.05 * 0.02  # 5 % of the amplitude


def test_bad_fields_and_places_outside_are_refused() -> None:
    with pytest.raises(InputError, match="4 x 4"):
        HeightField(heights=np.zeros((3, 9)), spacing=(1.0, 1.0))
    with pytest.raises(InputError, match="gaps"):
        HeightField(heights=np.full((4, 4), np.nan), spacing=(1.0, 1.0))
    with pytest.raises(InputError, match="spacing"):
        HeightField(heights=np.zeros((4, 4)), spacing=(1.0, 0.0))
    with pytest.raises(InputError, match="must lie in the height field"):
        ROUGH.height(np.array(0.51), np.array(1.2))


@pytest.mark.parametrize(
    ("heights", "spacing", "words"),
    [(1e12, 0.5, "must not exceed 100000 m"), (1.0, 1e-9, "must lie between"), (1.0, 1e12, "must lie between")],
)
def test_ground_that_no_planet_has_is_refused(heights: float, spacing: float, words: str) -> None:
    with pytest.raises(InputError, match=words):
        HeightField(heights=np.full((4, 4), heights), spacing=(0.5, spacing))
