"""Shape functions of thesis eq. 2.13: interpolation, completeness and derivatives."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.plates.shape_functions import gauss_points, plate_shape, plate_shape_gradient

DIMENSIONS = np.array([0.2, 0.12, 0.025])
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
RANDOM_XI = np.random.default_rng(1).uniform([0, 0, -0.5], [1, 1, 0.5], size=(20, 3))


def test_nodal_coordinates_are_position_and_gradients_at_the_nodes() -> None:
    value = plate_shape(CORNERS, DIMENSIONS).reshape(4, 1, 16)
    gradient = plate_shape_gradient(CORNERS, DIMENSIONS)
    np.testing.assert_allclose(np.concatenate([value, gradient], axis=1).reshape(16, 16), np.eye(16), atol=1e-14)


def test_linear_fields_are_reproduced() -> None:
    rng = np.random.default_rng(2)
    offset, slope = rng.normal(size=3), rng.normal(size=(3, 3))
    e = np.concatenate([np.vstack([offset + slope @ (c * DIMENSIONS), slope.T]) for c in CORNERS])
    expected = offset + (RANDOM_XI * DIMENSIONS) @ slope.T
    np.testing.assert_allclose(plate_shape(RANDOM_XI, DIMENSIONS) @ e, expected, atol=1e-13)
    gradient = np.einsum("gka,ai->gik", plate_shape_gradient(RANDOM_XI, DIMENSIONS), e)
    np.testing.assert_allclose(gradient, np.repeat(slope[None], len(RANDOM_XI), axis=0), atol=1e-12)


def test_positions_form_a_partition_of_unity() -> None:
    np.testing.assert_allclose(plate_shape(RANDOM_XI, DIMENSIONS)[:, ::4].sum(axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(plate_shape_gradient(RANDOM_XI, DIMENSIONS)[:, :, ::4].sum(axis=2), 0.0, atol=1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_gradient_is_the_derivative(axis: int) -> None:
    step = np.zeros(3)
    step[axis] = 1e-6
    difference = plate_shape(RANDOM_XI + step, DIMENSIONS) - plate_shape(RANDOM_XI - step, DIMENSIONS)
    expected = difference / (2e-6 * DIMENSIONS[axis])
    np.testing.assert_allclose(plate_shape_gradient(RANDOM_XI, DIMENSIONS)[:, axis], expected, atol=1e-8)


def test_gauss_rule_integrates_its_degree() -> None:
    xi, weights = gauss_points((3, 2, 2))
    assert weights.sum() == pytest.approx(1.0, abs=1e-14)
    integral = weights @ (xi[:, 0] ** 5 * xi[:, 1] ** 3 * xi[:, 2] ** 2)
    assert integral == pytest.approx(1 / 6 * 1 / 4 * 1 / 12, rel=1e-12)
