"""Claim: the force of a wheel dropped from 10 mm on Mars, with both damper laws of the brush tire.

Source: theory, a mass m falls from h with v = sqrt(2 g h) = 0.272 m/s onto k d + c d_dot (thesis section 3.3, scenario
drop; Table II). As printed, the force at first touch is c v = 2.22 kN within one step, and the motion is that of the
damped oscillator, in closed form while the force is not negative. A damper that builds up starts from zero force. Both
come to rest at m g / k = 24 mm. Tolerances: 0.1 % on the force at touch, 1e-6 m on the closed form, 1e-5 m on the
rest. Negative control: the damper that builds up fails the first two.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw
from tests.brush_rig import RADIUS, STIFFNESS, Rig

FloatArray = NDArray[np.float64]
MARS, MASS, DAMPING, HEIGHT = 3.711, 320.0 / 6.0, 8140.0, 0.010
SPEED = np.sqrt(2.0 * MARS * HEIGHT)


def drop(law: DamperLaw, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deflection [m] and load [N] at times from the first touch."""
    rig = Rig(settings=BrushSettings(damper_law=law))
    start = rig.start((0.0, 0.0, RADIUS))
    start[5] = -SPEED
    y = rig.run(start, times)
    return RADIUS - y[:, 2], np.array([rig.response(row).output[0, 1] for row in y])


def oscillator(t: FloatArray) -> FloatArray:
    """m d'' + c d' + k d = m g from d = 0, d' = v."""
    first, second = np.sort(np.roots([MASS, DAMPING, STIFFNESS]).real)
    rest = MASS * MARS / STIFFNESS
    b = (SPEED + first * rest) / (second - first)
    return rest + (-rest - b) * np.exp(first * t) + b * np.exp(second * t)


TIMES = np.concatenate([np.linspace(0.0, 0.05, 51), [0.5, 1.0, 20.0]])


def test_as_printed_jumps_to_the_dampers_force_and_is_the_damped_oscillator() -> None:
    deflection, load = drop(DamperLaw.AS_PRINTED, np.concatenate([[0.0, 1e-7], TIMES[1:]]))
    assert load[0] == 0.0
    assert load[1] == pytest.approx(DAMPING * SPEED, rel=1e-3)
    np.testing.assert_allclose(deflection[2:], oscillator(TIMES[1:]), rtol=0, atol=1e-6)


def test_builds_up_without_a_jump() -> None:
    _, load = drop(DamperLaw.BUILDS_UP, np.linspace(0.0, 0.05, 501))
    assert np.abs(np.diff(load)).max() < 30.0  # in 0.1 ms
    assert 300.0 < load.max() < 0.5 * DAMPING * SPEED


@pytest.mark.parametrize("law", list(DamperLaw))
def test_both_come_to_rest_at_the_static_deflection(law: DamperLaw) -> None:
    deflection, load = drop(law, TIMES)
    assert deflection[-1] == pytest.approx(MASS * MARS / STIFFNESS, abs=1e-5)
    assert load.min() >= 0.0


def test_negative_control_the_other_law_is_no_damped_oscillator() -> None:
    deflection, load = drop(DamperLaw.BUILDS_UP, np.concatenate([[0.0, 1e-7], TIMES[1:]]))
    assert load[1] < 1.0
    assert np.abs(deflection[2:] - oscillator(TIMES[1:])).max() > 1e-3
