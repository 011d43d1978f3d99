"""Matrices of three unknowns a node: all of them or the upper triangle, against dense ones."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from reference_fe.cells.block_matrix import (
    BlockRows,
    add_block,
    add_csr,
    block_places,
    block_rows,
    hold,
    place_of,
    product,
    scalar_csr,
)
from reference_fe.dolfinx_api import PETSc, triangular_matrix

NODES = 7
CELLS = np.array([[4, 0, 2], [2, 5, 4], [6, 2, 1]], dtype=np.int32)
COUPLED = (CELLS, np.array([1, 3], dtype=np.int32))

Array = NDArray[np.float64]


def made(*, upper: bool) -> tuple[BlockRows, Array, Array]:
    """A pattern, values of random symmetric cells, and the dense matrix they mean."""
    rows = block_rows(NODES, COUPLED, upper=upper)
    values, dense = np.zeros(rows.entries), np.zeros((3 * NODES, 3 * NODES))
    places, rng = block_places(CELLS, rows), np.random.default_rng(2)
    for cell, place in zip(CELLS, places, strict=True):
        K = rng.standard_normal((9, 9))
        K += K.T
        dofs = (3 * cell[:, None] + np.arange(3)).ravel()
        dense[np.ix_(dofs, dofs)] += K
        for a, b in np.argwhere(place >= 0):
            add_block(rows, cell[a], place[a, b], K[3 * a : 3 * a + 3, 3 * b : 3 * b + 3], values)
    return rows, values, dense


def spread(rows: BlockRows, values: Array) -> Array:
    """The dense matrix of the values, below the diagonal zero for an upper triangle."""
    indptr, columns = scalar_csr(rows, np.zeros(0, dtype=np.int32))
    out = np.zeros((3 * NODES, 3 * NODES))
    out[np.repeat(np.arange(3 * NODES), np.diff(indptr)), columns] = values
    return out


@pytest.mark.parametrize("upper", [True, False])
def test_values_lie_where_the_pattern_says(upper: bool) -> None:
    rows, values, dense = made(upper=upper)
    np.testing.assert_allclose(spread(rows, values), np.triu(dense) if upper else dense, atol=1e-15)
    _, columns = scalar_csr(rows, np.zeros(0, dtype=np.int32))
    assert rows.entries == len(columns)
    assert rows.nodes[rows.starts[1] + place_of(rows, 1, 3)] == 3
    assert (place_of(rows, 3, 1) == -1) == upper
    assert place_of(rows, 0, 6) == -1


@pytest.mark.parametrize("upper", [True, False])
def test_product(upper: bool) -> None:
    rows, values, dense = made(upper=upper)
    x = np.random.default_rng(3).standard_normal(3 * NODES)
    np.testing.assert_allclose(product(rows, values, x), dense @ x, atol=1e-14)


@pytest.mark.parametrize("upper", [True, False])
def test_held_unknowns(upper: bool) -> None:
    """Unit rows, zero columns; of unknowns that belong to a neighbour not even the one."""
    rows, values, dense = made(upper=upper)
    held = np.zeros(3 * NODES, dtype=bool)
    held[[2, 7, 20]] = True
    hold(rows, held, 15, values)
    dense[held], dense[:, held] = 0.0, 0.0
    dense[[2, 7], [2, 7]] = 1.0
    np.testing.assert_allclose(spread(rows, values), np.triu(dense) if upper else dense, atol=1e-15)


@pytest.mark.parametrize("upper", [True, False])
def test_a_matrix_of_single_unknowns_is_added(upper: bool) -> None:
    rows, values, dense = made(upper=upper)
    added = np.zeros_like(dense)
    added[6:9, 12:15] = np.arange(9.0).reshape(3, 3)
    added += added.T
    row, column = np.nonzero(added + np.eye(21))
    indptr = np.searchsorted(row, np.arange(22)).astype(np.int32)
    add_csr(rows, indptr, column.astype(np.int32), added[row, column], values)
    np.testing.assert_allclose(spread(rows, values), np.triu(dense + added) if upper else dense + added, atol=1e-15)


def test_petsc_sees_what_is_written() -> None:
    rows, values, dense = made(upper=True)
    matrix, shared = triangular_matrix(*scalar_csr(rows, np.zeros(0, dtype=PETSc.IntType)))
    shared[:] = values
    matrix.stateIncrease()
    x, b = matrix.createVecs()
    x.array[:] = np.arange(3.0 * NODES)
    matrix.mult(x, b)
    np.testing.assert_allclose(b.array, dense @ x.array, atol=1e-13)
    assert matrix.norm() == pytest.approx(np.linalg.norm(dense), rel=1e-14)
