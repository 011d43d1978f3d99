"""Claim: a falling plate pendulum follows an independent computation to 1e-5 m; without damping it keeps its energy.

Source: contracts/published/ancf_plate_pendulum_4x2_nu0.3.csv, exact quadrature and DOP853; the model is
ancf_reduced/verification/pendulum.py, 5 x 5 x 3 points, exact to 3e-10, and RATTLE. Tolerances: 1e-5 m on the free
corner over 0.4 s; energy to 1e-6 of the largest kinetic energy, at an eighth of the stable step, its error falling with
the step squared. Negative control: 4 x 4 x 2 points leave the path by 2.6e-4 m.
"""

from __future__ import annotations

import functools

import pytest

from ancf_reduced.verification.pendulum import pendulum_fall

fall = functools.cache(pendulum_fall)


def test_corner_follows_the_published_path() -> None:
    found = fall((5, 5, 3), 0.125)
    assert found.time[-1] == pytest.approx(0.4)
    assert found.error < 1e-5


def test_energy_is_kept_and_its_error_falls_with_the_square_of_the_step() -> None:
    coarse, fine = fall((5, 5, 3), 0.5).energy_spread, fall((5, 5, 3), 0.125).energy_spread
    assert fine < 1e-6
    assert coarse / fine == pytest.approx(16.0, rel=0.5)


def test_fewer_points_leave_the_path() -> None:
    """Negative control, and the published remark: 4 x 4 x 2 points differ by some 1e-4 m (4e-4 there)."""
    assert 1e-4 < fall((4, 4, 2), 0.125).error < 1e-3
