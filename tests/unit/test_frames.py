"""The wheel frame: which point of the tire faces the ground at which orientation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contracts.frames import ground_direction_h


@pytest.mark.parametrize(
    ("phi_deg", "expected"),
    [(0.0, [0, 0, -1]), (90.0, [1, 0, 0]), (180.0, [0, 0, 1]), (-90.0, [-1, 0, 0]), (30.0, [0.5, 0, -np.sqrt(0.75)])],
)
def test_known_directions(phi_deg: float, expected: list[float]) -> None:
    np.testing.assert_allclose(ground_direction_h(np.deg2rad(phi_deg)), expected, atol=1e-15)


@given(st.floats(-10.0, 10.0))
def test_unit_length_and_in_the_wheel_plane(phi: float) -> None:
    direction = ground_direction_h(phi)
    assert np.linalg.norm(direction) == pytest.approx(1.0, rel=1e-14)
    assert direction[1] == 0.0


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_orientation_is_a_rotation_about_minus_y(phi: float, turn: float) -> None:
    """From -z towards +x is a negative turn about +y in the right-handed sense: R_y(-turn) d(phi) = d(phi + turn)."""
    c, s = np.cos(-turn), np.sin(-turn)
    R_y = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    np.testing.assert_allclose(R_y @ ground_direction_h(phi), ground_direction_h(phi + turn), atol=1e-14)
