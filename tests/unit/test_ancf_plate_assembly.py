"""Matrices of the mesh from those of the plates, full and sparse."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.plates.assembly import dense_matrix, plate_rows, sparse_matrix
from ancf_reduced.plates.mass import mass_blocks
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset

MODEL = build_tire(thesis_preset()).model


@pytest.mark.parametrize("components", [1, 3])
def test_sparse_and_full_are_the_same(components: int) -> None:
    blocks = np.random.default_rng(2).normal(size=(len(MODEL.mesh.elements), 16 * components, 16 * components))
    np.testing.assert_allclose(
        sparse_matrix(MODEL.mesh, blocks).toarray(), dense_matrix(MODEL.mesh, blocks), atol=1e-13
    )


def test_rows_follow_the_nodes() -> None:
    rows = plate_rows(MODEL.mesh)
    node = MODEL.mesh.elements[3, 2]
    np.testing.assert_array_equal(rows[3, 24:36], 12 * node + np.arange(12))


def test_quadratic_form_is_the_sum_over_plates() -> None:
    v = np.random.default_rng(3).normal(size=4 * len(MODEL.mesh.points))
    blocks = mass_blocks(MODEL)
    expected = sum(v[row] @ block @ v[row] for row, block in zip(plate_rows(MODEL.mesh, 1), blocks, strict=True))
    assert v @ (sparse_matrix(MODEL.mesh, blocks) @ v) == pytest.approx(expected, rel=1e-12)
