"""Claim: two MPI processes yield what one does where three laws meet, one with a history and one with a pressure.

Source and tolerance as in tests/verification/test_fe_ranks.py: 1e-8 relative to the largest entry. Negative control: a
modulus of the rubber off by 1e-6.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.end_to_end.small_study import ROOT, environment
from workbench.execution.ranks import mpiexec


def _solve(folder: Path, ranks: int, factor: float = 1.0) -> dict[str, np.ndarray]:
    command = [sys.executable, "-m", "tests.verification.laws_process", folder / "out.npz", str(factor)]
    launcher = [mpiexec(), "-n", str(ranks)] if ranks > 1 else []
    subprocess.run([*launcher, *command], cwd=ROOT, env=environment(), check=True)
    with np.load(folder / "out.npz", allow_pickle=False) as archive:
        return dict(archive)


@pytest.fixture(scope="module")
def one(tmp_path_factory: pytest.TempPathFactory) -> dict[str, np.ndarray]:
    """What one process finds."""
    return _solve(tmp_path_factory.mktemp("one"), 1)


def _assert_equal(found: dict[str, np.ndarray], expected: dict[str, np.ndarray]) -> None:
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=0.0, atol=1e-8 * np.abs(values).max(), err_msg=name)


def test_two_processes_find_what_one_does(one: dict[str, np.ndarray], tmp_path: Path) -> None:
    assert one["plastic"][0] > 0.01
    assert one["energy"][1] > 0.1 * one["energy"][0]
    assert np.unique(one["largest"]).size == 3
    _assert_equal(_solve(tmp_path, 2), one)


def test_the_comparison_sees_a_millionth(one: dict[str, np.ndarray], tmp_path: Path) -> None:
    with pytest.raises(AssertionError):
        _assert_equal(_solve(tmp_path, 1, 1.0 + 1e-6), one)
