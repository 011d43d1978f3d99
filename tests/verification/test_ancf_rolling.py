"""An ANCF wheel that falls, rolls and climbs: momentum, energy, statics on the way; see ancf_reduced/wheel_motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import Mixed, WheelOnGround
from ancf_reduced.wheel_motion.friction import Friction
from ancf_reduced.wheel_motion.rest import above, standing
from ancf_reduced.wheel_motion.rolling import ABOUT_AXLE, Hub, Linearised, Motion, RollingWheel
from ancf_reduced.wheel_motion.travel import Account, TravelSettings, travel
from contracts.errors import InputError
from contracts.terrain import Plane, TerrainUnion
from contracts.terrain_ridges import HalfRound
from geometry.wheel import exomars

Array = NDArray[np.float64]
WHEEL = build_ancf_wheel(exomars(), element_size=40e-3, axial_size=60e-3)
WHOLE = build_ancf_wheel(exomars(), element_size=40e-3, axial_size=60e-3, half_width=False)
GRAVITY = 3.711
HUB = Hub(mass=52.6, inertia=0.05)
ROLLS = Hub(mass=52.6, inertia=0.05, speed=70.0 / 3600.0 / 0.1425, gain=500.0)
"""70 m/h."""


class WithoutCoriolis(RollingWheel):
    """The control: the acceleration 2 theta' E p' forgotten."""

    def linearised(self, motion: Motion, mixed: Mixed, damping: csc_array, pull: Array | None = None) -> Linearised:
        found = super().linearised(motion, mixed, damping, pull)
        own = slice(0, self.basis.shape[1])
        coriolis = 2.0 * motion.v[-1] * (self._mass @ (self._turn @ (self.basis @ motion.v[own])))
        residual = found.residual.copy()
        residual[own] -= self.basis.T @ coriolis
        p = self.problem.wheel.coordinates(motion.y[own]).ravel()
        ahead, up = self._axes(float(motion.y[-1]))
        residual[-3:] -= [ahead @ coriolis, up @ coriolis, (self._turn @ p) @ coriolis]
        return replace(found, residual=residual)


@pytest.mark.long
@pytest.mark.parametrize(("kind", "holds"), [(RollingWheel, True), (WithoutCoriolis, False)])
def test_a_spinning_wheel_let_go_in_space_keeps_momentum_and_energy(kind: type[RollingWheel], *, holds: bool) -> None:
    """As flat as on the ground, then free, at 40 rad/s: momenta are summed in the world, from places and velocities."""
    flat = standing(RollingWheel(WheelOnGround(WHEEL, 0.0), HUB, GRAVITY))
    wheel = kind(WheelOnGround(WHEEL, 0.0), replace(HUB, mass=0.5, inertia=1e-3), 0.0)
    y, v = flat.y.copy(), np.zeros(wheel.size)
    y[-2], v[-3:] = 10.0, [0.3, -0.2, 40.0]
    start = Motion(time=0.0, y=y, v=v, a=0.0 * v, pressed=0.0 * flat.pressed)
    account = Account()
    settings = TravelSettings(spectral_radius=1.0, largest_step=2e-4)
    (end,) = travel(wheel, start, [8e-4], settings, account)
    before, after = momenta(wheel, start), momenta(wheel, end)
    lost = np.abs(after - before) / np.abs(before)
    assert (lost.max() < 1e-5 and account.closure() < 1e-3) if holds else lost.max() > 1e-2


def momenta(wheel: RollingWheel, motion: Motion) -> Array:
    """Along world x and z and about the axle through the world's origin, of half the wheel, (3,)."""
    c, s = np.cos(motion.y[-1]), np.sin(motion.y[-1])
    to_world = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    hub, speed = np.array([motion.y[-3], 0.0, motion.y[-2]]), np.array([motion.v[-3], 0.0, motion.v[-2]])
    p = wheel.problem.wheel.coordinates(motion.y[:-3])
    rate = (wheel.basis @ motion.v[:-3]).reshape(p.shape)
    mass = wheel.problem.wheel.plates.mass()
    at, u = p @ to_world.T, (rate + motion.v[-1] * p @ ABOUT_AXLE.T) @ to_world.T
    at[:, 0], u[:, 0] = at[:, 0] + hub, u[:, 0] + speed
    heavy = (mass @ u.ravel()).reshape(p.shape)
    linear = heavy[:, 0].sum(axis=0) + 0.5 * wheel.hub.mass * speed
    about = (at @ ABOUT_AXLE.T * heavy).sum() + 0.5 * wheel.hub.inertia * motion.v[-1]
    about += 0.5 * wheel.hub.mass * (ABOUT_AXLE @ hub) @ speed
    return np.array([linear[0], linear[2], about])


def test_a_wheel_that_stands_bears_its_weight_and_stays() -> None:
    """Its axle braked: free to turn, the bent leaves would unwind and roll it off."""
    braked = replace(HUB, gain=1e5)
    wheels = [RollingWheel(WheelOnGround(WHEEL, at), braked, GRAVITY, Friction(coefficient=0.6)) for at in (0.0, 0.4)]
    starts = [standing(wheel) for wheel in wheels]
    for wheel, start in zip(wheels, starts, strict=True):
        np.testing.assert_allclose(wheel.load(start), [0.0, wheel.mass * GRAVITY], atol=1e-6 * wheel.mass * GRAVITY)
    for wheel, start in zip(wheels, starts, strict=True):
        (end,) = travel(wheel, start, [0.05])
        assert np.abs(end.y[-3:] - start.y[-3:]).max() < 2e-6
        assert wheel.load(end)[1] == pytest.approx(wheel.mass * GRAVITY, rel=1e-4)


def test_a_drop_of_10_mm_is_free_until_it_touches_and_keeps_account_of_energy() -> None:
    wheel = RollingWheel(WheelOnGround(WHEEL, 0.0), replace(HUB, mass=18.0), GRAVITY, damping_ratio=0.05)
    start, account = above(wheel, 10e-3), Account()
    loads = list[float]()
    settings = TravelSettings(tolerance=1e-5)
    falls, lands = travel(wheel, start, [0.07, 0.15], settings, account, lambda m: loads.append(wheel.load(m)[1]))
    assert falls.y[-2] - start.y[-2] == pytest.approx(-0.5 * GRAVITY * 0.07**2, rel=1e-6)
    assert np.abs(falls.y[:-3]).max() < 1e-5  # what Newton's tolerance leaves of places, slopes, twists
    assert lands.y[-2] < start.y[-2] - 15e-3
    assert max(loads) > 1.5 * wheel.mass * GRAVITY
    assert account.closure() < 0.01
    damping = np.array(account.rows)[-1, 5]
    assert damping > 0.0
    assert np.ptp(account.totals - np.array(account.rows)[:, 5]) > 5.0 * np.ptp(account.totals)  # the control


class DampedAsAtRest(RollingWheel):
    """The control: the reference's stiffness brakes strips that only turn, as the rim does in its soft leaves."""

    def damping(self, y: Array) -> csc_array:
        return csc_array(self._viscosity * self.stiffness)


@pytest.mark.long
@pytest.mark.parametrize(("kind", "holds"), [(RollingWheel, True), (DampedAsAtRest, False)])
def test_turning_slowly_on_ice_is_standing_on_one_orientation_after_another(
    kind: type[RollingWheel], *, holds: bool
) -> None:
    """Without friction the hub is as high as statics find it on the orientation that it then has, but for its bounce.

    With friction it need not be: the ground holds the rim on a grouser, and the rim turns in its soft leaves.
    """
    wheel = kind(WheelOnGround(WHEEL, 0.0), ROLLS, GRAVITY, damping_ratio=0.5)
    account, start = Account(), standing(wheel)
    (end,) = travel(wheel, start, [1.5], TravelSettings(tolerance=1e-5, largest_step=0.1), account)
    there = standing(RollingWheel(WheelOnGround(WHEEL, float(end.y[-1])), ROLLS, GRAVITY))
    assert end.y[-1] > 0.15
    assert abs(end.y[-3]) < 1e-3
    assert (abs(end.y[-2] - there.y[-2]) < 0.12e-3) == holds
    assert abs(end.y[-2] - there.y[-2]) > 0.5e-3 or holds
    assert account.closure() < 0.01


@pytest.mark.long
def test_over_a_half_round_energy_is_kept_and_the_hub_rises() -> None:
    """10 mm high, the ground around it level: 0.45 s at 70 m/h from where the wheel first touches it."""
    terrain = TerrainUnion(parts=(Plane(), HalfRound(radius=10e-3, position=64e-3)))
    wheel = build_ancf_wheel(exomars(), element_size=40e-3, axial_size=60e-3, ground_spacing=1e-3)
    rolling = RollingWheel(WheelOnGround(wheel, 0.0, terrain=terrain), ROLLS, GRAVITY, Friction(coefficient=0.6), 0.05)
    account, highest = Account(), list[float]()
    start = standing(rolling)
    settings = TravelSettings(tolerance=1e-5, largest_step=0.1)
    (end,) = travel(rolling, start, [0.45], settings, account, lambda m: highest.append(float(rolling.load(m)[0])))
    assert end.y[-2] > start.y[-2] + 1e-3
    assert min(highest) < -1.0  # it is held back while it climbs
    assert account.closure() < 0.01


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"damping_ratio": 1.0}, "damping ratio"),
        ({"gravity": np.nan}, "gravity"),
        ({"problem": WheelOnGround(WHOLE, 0.0, camber=0.1)}, "camber"),
    ],
)
def test_what_cannot_roll_is_refused(changes: dict[str, object], match: str) -> None:
    asked = {"problem": WheelOnGround(WHEEL, 0.0), "hub": HUB, "gravity": GRAVITY} | changes
    with pytest.raises(InputError, match=match):
        RollingWheel(**asked)  # type: ignore[arg-type]


def test_where_a_motion_cannot_begin_is_told() -> None:
    wheel = RollingWheel(WheelOnGround(WHEEL, 0.0), HUB, 0.0)
    with pytest.raises(InputError, match="gravity"):
        standing(wheel)
    with pytest.raises(InputError, match="height"):
        above(wheel, -1.0)
    with pytest.raises(InputError, match="times"):
        next(travel(wheel, above(wheel, 0.0), [0.0]))
