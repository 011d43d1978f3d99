"""Claim: modes of the ANCF wheel, its hub held or free, are complete and carry the wheel's mass.

Sources: a wheel that moves on a hub of a thousand tons is one whose hub is held; rigid motions carry all of a free
body's mass; the first mode as `wheel_motion.rolling` finds it on half a wheel. Tolerances: the hub's mass over the
plates' (1e-6); round-off of the lowest eigenvalue, 1e-14 of the highest (1e-6).
Negative control: a light hub has other modes.
"""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround
from ancf_reduced.wheel.vibration import standing_under, wheel_modes
from ancf_reduced.wheel_motion.rolling import Hub, RollingWheel
from contracts.errors import InputError
from geometry.wheel import exomars_hoops

COARSE = {"element_size": 40e-3, "axial_size": 60e-3}
HUB = np.diag([0.4, 0.4, 0.4, 1.5e-3, 2e-3, 1.5e-3])


def on_ground(*, half_width: bool = False) -> WheelOnGround:
    return WheelOnGround(build_ancf_wheel(exomars_hoops(), half_width=half_width, **COARSE), 0.0)


def test_held_free_and_standing() -> None:
    problem = on_ground()
    held, shapes = wheel_modes(problem, 6)
    mass = problem.wheel.plates.mass()
    flat = shapes.reshape(6, -1)
    np.testing.assert_allclose(flat @ (mass @ flat.T), np.eye(6), atol=1e-8)
    rolling = RollingWheel(on_ground(half_width=True), Hub(mass=1.0, inertia=1.0), 0.0)
    first_even = held.frequency[held.parity == 1][0]
    assert first_even == pytest.approx(rolling.first_frequency() / (2.0 * np.pi), rel=1e-6)
    heavy, _ = wheel_modes(problem, 6, hub=1e6 * np.eye(6))
    np.testing.assert_allclose(heavy.frequency[6:], held.frequency, rtol=1e-5)
    free, _ = wheel_modes(problem, 6, hub=HUB)
    assert abs(free.frequency[6] / held.frequency[0] - 1.0) > 0.1  # negative control
    np.testing.assert_allclose(free.effective_mass[:6] / free.whole, np.eye(6), atol=1e-8)
    np.testing.assert_allclose(free.effective_mass[6:] / free.whole, 0.0, atol=1e-8)
    plates = float(held.whole[0])
    np.testing.assert_allclose(free.whole[:3], plates + 0.4, rtol=1e-10)
    state = standing_under(problem, 30.0)
    assert state.load == pytest.approx(30.0, rel=1e-4)
    stands, _ = wheel_modes(problem, 6, state=state)
    assert stands.unstable == state.negative == 0
    grips, _ = wheel_modes(problem, 6, state=state, grip=True)
    assert grips.frequency[0] > 1.2 * stands.frequency[0]  # the rim turns about the axle: along the ground
    up = [one.frequency[one.effective_mass[:, 2].argmax()] for one in (stands, grips)]
    assert up[0] == pytest.approx(up[1], rel=1e-3)  # across it nothing changes
    pairs, split = ([len(g) for g in one.clusters()].count(2) for one in (held, stands))
    assert pairs >= 2 > split  # the ground ends the wheel's symmetry


def test_what_has_no_modes_is_refused() -> None:
    with pytest.raises(InputError, match="full width"):
        wheel_modes(on_ground(half_width=True), 4)
    with pytest.raises(InputError, match="load"):
        standing_under(on_ground(), -1.0)
