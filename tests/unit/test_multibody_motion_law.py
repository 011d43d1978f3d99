"""Motion laws: rate and acceleration are derivatives of the value; ends and durations are those asked for."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.multibody.motion_law import Hold, MotionLaw, SpeedTrapezoid, Turn, UserLaw

LAWS: list[MotionLaw] = [
    Hold(value=0.3),
    Turn(start=-0.2, end=1.0, begins=0.1, lasts=0.7),
    SpeedTrapezoid(speed=2.0, begins=0.2, accelerates=0.3, decelerates=0.2, ends=0.9),
    SpeedTrapezoid(speed=-2.0, accelerates=0.5, start=1.0),
    UserLaw(function=lambda t: (np.sin(t), np.cos(t), -np.sin(t))),
]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("t", [0.05, 0.25, 0.4, 0.6, 0.75, 0.95])
def test_derivatives(law: MotionLaw, t: float) -> None:
    h = 1e-5
    before, now, after = (law.at(t + k * h) for k in (-1, 0, 1))
    assert now[1] == pytest.approx((after[0] - before[0]) / (2 * h), abs=1e-7)
    assert now[2] == pytest.approx((after[1] - before[1]) / (2 * h), abs=1e-7)


def test_ends() -> None:
    assert LAWS[1].at(0.0) == (-0.2, 0.0, 0.0)
    np.testing.assert_allclose(LAWS[1].at(5.0), (1.0, 0.0, 0.0), atol=1e-14)
    assert LAWS[2].at(5.0)[0] == pytest.approx(2.0 * (0.7 - 0.15 - 0.1))
    assert LAWS[2].at(5.0)[1:] == (0.0, 0.0)
    assert LAWS[3].at(10.0)[1] == -2.0


def test_impossible_times_are_refused() -> None:
    with pytest.raises(InputError, match="duration of a turn = 0 s"):
        Turn(end=1.0, lasts=0.0)
    with pytest.raises(InputError, match="must leave time"):
        SpeedTrapezoid(speed=1.0, accelerates=1.0, decelerates=1.0, ends=1.5)
