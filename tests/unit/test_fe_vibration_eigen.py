"""Lowest eigenvalues of matrices whose spectrum is known: none left out, pairs included, negative ones too."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from contracts.errors import ConvergenceError
from reference_fe.vibration import eigen
from reference_fe.vibration.eigen import count_below, lowest_modes

VALUES = np.array([-40.0, 0.0, 0.0, 0.0, 3.0, 3.0, 7.0, *np.linspace(20.0, 900.0, 53)])


def matrices() -> tuple[csr_array, csr_array]:
    """K and M with these eigenvalues, coupled by a shear of the coordinates."""
    n = len(VALUES)
    turn = csr_array(diags_array([np.ones(n), 0.3 * np.ones(n - 1)], offsets=[0, 1]))
    order = np.random.default_rng(1).permutation(n)
    K = csr_array(turn.T @ diags_array(VALUES[order]) @ turn)
    return K, csr_array(turn.T @ turn)


@pytest.mark.parametrize("count", [1, 2, 5, 6, 12])
def test_lowest_values_and_vectors_of_unit_mass(count: int) -> None:
    K, M = matrices()
    values, vectors = lowest_modes(K, M, count, -1.0)
    np.testing.assert_allclose(values, VALUES[:count], atol=1e-9)
    np.testing.assert_allclose(vectors.T @ M @ vectors, np.eye(count), atol=1e-9)
    np.testing.assert_allclose(K @ vectors, M @ vectors * values, atol=1e-7)


def test_counting_is_sylvesters() -> None:
    K, M = matrices()
    assert [count_below(K, M, level) for level in (-50.0, -1.0, 1.0, 5.0, 10.0)] == [0, 1, 4, 6, 7]


def test_negative_control_a_value_that_is_left_out_is_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    K, M = matrices()
    found = eigen.eigsh
    monkeypatch.setattr(eigen, "eigsh", lambda *a, **k: tuple(np.delete(x, 2, axis=-1) for x in found(*a, **k)))
    with pytest.raises(ConvergenceError, match="not complete"):
        lowest_modes(K, M, 6, -1.0)
