"""Normalised shape functions at the integration points."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.compiled import LANES
from ancf_reduced.plates.shape_functions import plate_shape, plate_shape_gradient
from ancf_reduced.plates.tables import in_blocks, plate_tables
from contracts.errors import InputError


def test_lengths_drop_out_of_the_shape_functions() -> None:
    """Shape functions of a plate of any size = the normalised ones times its lengths, at the same points."""
    tables, lengths = plate_tables((4, 4, 2)), np.array([0.3, 0.7, 0.02])
    by_length = np.tile([1.0, *lengths], 4)
    np.testing.assert_allclose(plate_shape(tables.points, lengths), tables.shape * by_length, atol=1e-15)
    D = np.moveaxis(tables.at_points(np.moveaxis(tables.gradient, 0, -2)), -1, 0)
    expected = plate_shape_gradient(tables.points, lengths) * lengths[:, None]
    np.testing.assert_allclose(expected, D * by_length, atol=1e-14)


@pytest.mark.parametrize("quadrature", [(2, 2, 1), (4, 4, 2), (5, 5, 3)])
def test_blocks_hold_every_point_once_and_are_filled_up_with_zeros(quadrature: tuple[int, int, int]) -> None:
    tables = plate_tables(quadrature)
    n_points = int(np.prod(quadrature))
    assert tables.gradient.shape == (-(-n_points // LANES), 3, 16, LANES)
    values = np.random.default_rng(1).normal(size=(2, n_points))
    blocks = in_blocks(values)
    np.testing.assert_array_equal(tables.at_points(blocks), values)
    assert blocks.sum() == pytest.approx(values.sum())
    assert tables.gauss_weight.sum() == pytest.approx(1.0)


def test_a_rule_without_points_is_refused() -> None:
    with pytest.raises(InputError, match="quadrature"):
        plate_tables((0, 5, 3))
