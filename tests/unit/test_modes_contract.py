"""Modes as a record: what follows from eigenvalues and participation, groups of one frequency, and arrays refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.modes import Modes, rigid_motions


def some_modes() -> Modes:
    values = np.array([1e-9, -4.0, 100.0, 100.01, 400.0])
    return Modes(
        eigenvalue=values,
        shape=np.zeros((5, 2, 3)),
        points=np.zeros((2, 3)),
        weight=np.ones(2),
        participation=np.arange(30.0).reshape(5, 6),
        moving=np.ones(6),
        whole=np.ones(6),
        rigid=np.array([True, False, False, False, False]),
        parity=np.zeros(5, dtype=np.int64),
    )


def test_frequency_growth_and_effective_mass() -> None:
    modes = some_modes()
    np.testing.assert_allclose(2.0 * np.pi * modes.frequency, [0.0, 0.0, 10.0, 10.0005, 20.0], rtol=1e-6)
    np.testing.assert_allclose(modes.growth, [0.0, 2.0, 0.0, 0.0, 0.0])
    assert modes.unstable == 1
    assert modes.effective_mass[1, 2] == 64.0
    assert [group.tolist() for group in modes.clusters()] == [[0], [1], [2, 3], [4]]


def test_no_pair_is_cut() -> None:
    """Besides the rigid one: the second and third share their frequency, the fourth has its own."""
    counts = {asked: len(some_modes().whole_pairs(asked).eigenvalue) - 1 for asked in (1, 2, 3, 4, 9)}
    assert counts == {1: 1, 2: 3, 3: 3, 4: 4, 9: 4}


def test_arrays_that_do_not_belong_together_are_refused() -> None:
    with pytest.raises(InputError, match="weight"):
        replace(some_modes(), weight=np.ones(3))


def test_rigid_motions_turn_about_the_origin() -> None:
    points = np.array([[1.0, 2.0, 3.0]])
    found = rigid_motions(points)[:, 0]
    np.testing.assert_allclose(found[:3], np.eye(3))
    np.testing.assert_allclose(found[3:], [[0.0, -3.0, 2.0], [3.0, 0.0, -1.0], [-2.0, 1.0, 0.0]])
