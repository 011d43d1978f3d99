"""Solves with the factors of a nearby matrix: exact, and as few as the change has rows."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from reference_fe.solver.nearby import NearbySolver

Array = NDArray[np.float64]
SIZE, TOUCHED = 40, (3, 17, 18, 31)


class Counted:
    """K^-1 for a symmetric indefinite K, with a count of the solves."""

    def __init__(self) -> None:
        rng = np.random.default_rng(3)
        basis = np.linalg.qr(rng.standard_normal((SIZE, SIZE)))[0]
        self.matrix = basis @ np.diag([-0.5, *np.linspace(1.0, 9.0, SIZE - 1)]) @ basis.T
        self.solves = 0

    def __call__(self, b: Array) -> Array:
        self.solves += 1
        return np.linalg.solve(self.matrix, b)


def penalty(*stiffness: float) -> Array:
    """A change of stiffness at the touched unknowns, coupled."""
    out = np.zeros((SIZE, SIZE))
    for k, (i, j) in zip(stiffness, pairwise(TOUCHED), strict=False):
        out[np.ix_([i, j], [i, j])] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return out


def times(matrix: Array) -> Callable[[Array], Array]:
    return lambda x: matrix @ x


def at_touched(seed: int) -> Array:
    b = np.zeros(SIZE)
    b[list(TOUCHED)] = np.random.default_rng(seed).standard_normal(len(TOUCHED))
    return b


def test_several_changes_share_the_solves_of_one_space() -> None:
    factors = Counted()
    nearby = NearbySolver(factors, SIZE)
    for seed, change in enumerate((penalty(1e6), penalty(1e6, 1e4, 2e5), penalty(-0.3, 1e6, 7.0))):
        b = at_touched(seed)
        x, left = nearby.solve(b, times(change), 1e-8)
        np.testing.assert_allclose((factors.matrix + change) @ x, b, atol=2e-8)
        assert np.linalg.norm(left) <= 1e-8
    assert factors.solves <= len(TOUCHED) + 1  # one for the round-off of stiffnesses that differ by 1e6


def test_residual_left_is_that_of_the_solution() -> None:
    factors, change = Counted(), penalty(20.0, 3.0, 5.0)
    b = np.random.default_rng(8).standard_normal(SIZE)
    x, left = NearbySolver(factors, SIZE).solve(b, times(change), 0.1)
    np.testing.assert_allclose(left, b - (factors.matrix + change) @ x, atol=1e-10)
    assert 0.0 < np.linalg.norm(left) <= 0.1


def test_asymmetric_change() -> None:
    factors, change = Counted(), penalty(20.0, 3.0)
    change[3, 31] += 50.0
    b = at_touched(1)
    x, _ = NearbySolver(factors, SIZE).solve(b, times(change), 1e-11)
    np.testing.assert_allclose((factors.matrix + change) @ x, b, atol=1e-9)


def test_full_solver_leaves_what_it_cannot_reach() -> None:
    factors, change = Counted(), penalty(20.0, 30.0, 5.0)
    nearby = NearbySolver(factors, 2)
    x, left = nearby.solve(at_touched(4), times(change), 1e-12)
    assert nearby.full
    assert factors.solves == 2
    assert np.linalg.norm(left) > 1e-6
    np.testing.assert_allclose(left, at_touched(4) - (factors.matrix + change) @ x, atol=1e-10)


def test_singular_change_ends_without_a_division_by_zero() -> None:
    factors = Counted()
    x, left = NearbySolver(factors, SIZE).solve(at_touched(2), times(-factors.matrix), 1e-12)
    assert np.linalg.norm(x) < 1e3
    assert np.linalg.norm(left) > 0.1
    assert factors.solves == 1
