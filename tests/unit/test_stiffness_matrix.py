"""A stiffness matrix from six travels: every column where it belongs, with its sign; what is missing is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.stiffness_matrix import MOTIONS, stiffness_matrix, write_matrix
from contracts.travel_curve import WRENCH, TravelCurve

HUB = {
    Way.FORE_AFT: (1, 0, 0, 0, 0, 0),
    Way.LATERAL: (0, 1, 0, 0, 0, 0),
    Way.RADIAL: (0, 0, -1, 0, 0, 0),
    Way.LEANING: (0, 0, 0, 1, 0, 0),
    Way.WIND_UP: (0, 0, 0, 0, 1, 0),
    Way.TURNING: (0, 0, 0, 0, 0, 1),
}
"""Motion of the hub, by hand from the words of `Way`."""


def spring(K: np.ndarray, way: Way) -> TravelCurve:
    """The way of a hub on a linear spring that presses it with 200 N."""
    travel = np.array([0.0, 1e-3, 2e-3])
    wrench = np.eye(6)[2] * 200.0 - travel[:, None] * (K @ np.array(HUB[way], dtype=float))
    columns = {name: wrench[:, WRENCH.index(name)] for name in WRENCH}
    return TravelCurve(
        model="fe", way=way, orientation_deg=15.0, deflection=0.02, travel=travel, columns=columns, source="a spring"
    )


@pytest.fixture
def K() -> np.ndarray:
    return np.random.default_rng(7).standard_normal((6, 6)) + 5.0 * np.eye(6)


def test_a_springs_matrix_is_found_again(K: np.ndarray, tmp_path: Path) -> None:
    found = stiffness_matrix([spring(K, way) for way in Way])
    np.testing.assert_allclose(found.values, K, rtol=1e-9, atol=1e-9)
    assert (found.load, found.deflection, found.orientation_deg) == (200.0, 0.02, 15.0)
    write_matrix(found, tmp_path / "a" / "matrix.csv")
    lines = (tmp_path / "a" / "matrix.csv").read_text().splitlines()
    assert lines[1] == ",".join(MOTIONS)
    np.testing.assert_allclose(np.loadtxt(lines[2:], delimiter=","), K, rtol=1e-9)


def test_asymmetry_by_hand_and_whatever_the_unit_of_length() -> None:
    """K_12 = 1, K_21 = 0 beside 2 on the diagonal: sqrt(2) / 5, turns scaled to 2."""
    K = 2.0 * np.eye(6)
    assert stiffness_matrix([spring(K, way) for way in Way]).asymmetry == pytest.approx(0.0, abs=1e-9)
    K[0, 1] = 1.0
    assert stiffness_matrix([spring(K, way) for way in Way]).asymmetry == pytest.approx(np.sqrt(2.0) / 5.0, rel=1e-9)
    mm = np.diag([1.0, 1.0, 1.0, 1e3, 1e3, 1e3])
    scaled = stiffness_matrix([spring(mm @ K @ mm, way) for way in Way])
    assert scaled.asymmetry == pytest.approx(np.sqrt(2.0) / 5.0, rel=1e-9)


def test_a_way_that_ended_before_its_first_step_is_named(K: np.ndarray) -> None:
    with pytest.raises(InputError, match="lateral"):
        stiffness_matrix([spring(K, way) for way in Way if way is not Way.LATERAL])
