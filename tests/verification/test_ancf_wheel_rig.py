"""Claim: one ANCF wheel on the ground: a 10 mm drop and a ride over a half-round, with both integrators, energy closed.

Thesis preset (4 x 4 x 2 points), 25 kg on its hub, Mars gravity. Source: none published; held against itself. Both
integrators agree to 2 % of the deflection; the energy account (kinetic, strain, weight, contact, damping, friction,
drive) closes to 1 %; a wheel that has come to rest carries its weight to 1e-3 and stands as deep as the static solver
says, to 1e-4 m. The longest stable step, 0.87 ms at any damping, is enough for both, unless the motion starts with a
blow. Negative controls: an account without one of its parts stays open; a step above the stable one stops.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.motion.energy_account import EnergyAccount
from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.implicit import ImplicitSettings, integrate_implicit
from ancf_reduced.motion.plate_system import HubMass
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.plates.mass import flexible_mass
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_tire
from ancf_reduced.tire.wheel_rig import MARS_GRAVITY, WheelRig, damped_model, wheel_rig
from contracts.errors import ConvergenceError, InputError
from contracts.terrain import Plane, TerrainUnion
from contracts.terrain_ridges import HalfRound

PRESET = replace(thesis_preset(), quadrature=(4, 4, 2))
HUB = HubMass(mass=25.0, inertia=np.diag([0.1, 0.1, 0.1]))
RADIUS, DROP, SPEED = PRESET.outer_radius, 0.010, 0.5
ROUND = 0.020


@functools.cache
def dropped() -> tuple[WheelRig, list[MotionState], EnergyAccount]:
    """10 mm above the ground, let go, 0.3 s."""
    rig = wheel_rig(build_tire(PRESET), Plane(), hub=HUB, damping_ratio=0.05)
    start, account = rig.start(np.array([0.0, 0.0, RADIUS + DROP]), np.zeros(3)), EnergyAccount(rig.system)
    account.watch(start)
    times = np.linspace(0.0, 0.3, 61)[1:]
    return (
        rig,
        list(integrate_explicit(rig.system, start, times, stable_step(rig.system, start.z), account.watch)),
        account,
    )


@functools.cache
def ridden(
    *, rock: bool = True, depth: float = 0.011, part: float = 0.35
) -> tuple[WheelRig, list[MotionState], EnergyAccount]:
    """Rolls over a half-round of 20 mm radius, or past where it would be, driven, with friction.

    It starts undeformed and pressed in by a depth [m], which is a blow; steps are a part of the longest stable one.
    """
    half_round = [HalfRound(radius=ROUND, position=0.25)] if rock else []
    law = ContactLaw(stiffness=PRESET.contact_stiffness, damping=2.0, friction=0.6, slip_velocity=0.1)
    ground = TerrainUnion(parts=(Plane(), *half_round))
    rig = wheel_rig(build_tire(PRESET), ground, hub=HUB, law=law, damping_ratio=0.05, drive=(SPEED / RADIUS, 20.0))
    start = rig.start(np.array([0.0, 0.0, RADIUS - depth]), np.array([SPEED, 0.0, 0.0]), SPEED / RADIUS)
    account = EnergyAccount(rig.system)
    account.watch(start)
    times, step = np.linspace(0.0, 1.0, 101)[1:], part * stable_step(rig.system, start.z)
    return rig, list(integrate_explicit(rig.system, start, times, step, account.watch)), account


def test_dropped_wheel_touches_when_it_must_and_bounces() -> None:
    rig, states, _ = dropped()
    loads, times = np.array([rig.load(s)[2] for s in states]), np.array([s.time for s in states])
    touch = np.sqrt(2.0 * DROP / MARS_GRAVITY)  # free fall: 73 ms
    assert times[loads > 0.0].min() == pytest.approx(touch, abs=6e-3)
    lowest = min(rig.hub(s.z)[2] for s in states)
    assert RADIUS - lowest > 0.015
    assert loads.max() > 1.5 * (HUB.mass + flexible_mass(rig.tire.model)) * MARS_GRAVITY


def test_both_integrators_give_the_same_drop() -> None:
    rig, states, _ = dropped()
    start = rig.start(np.array([0.0, 0.0, RADIUS + DROP]), np.zeros(3))
    times = np.array([s.time for s in states])
    implicit = list(integrate_implicit(rig.system, start, times, ImplicitSettings(tolerance=2e-7)))
    heights = np.array([[rig.hub(a.z)[2], rig.hub(b.z)[2]] for a, b in zip(states, implicit, strict=True)])
    assert np.abs(heights[:, 0] - heights[:, 1]).max() < 0.02 * (RADIUS - heights.min())


@pytest.mark.parametrize("run", [dropped, ridden], ids=["drop", "ride"])
def test_energy_account_closes(
    run: functools._lru_cache_wrapper[tuple[WheelRig, list[MotionState], EnergyAccount]],
) -> None:
    _, _, account = run()
    assert account.closure() < 0.01
    last = account.rows[-1]
    assert last.damping > 0.0
    if run is ridden:
        assert last.friction > 0.0
        assert last.contact_damping > 0.0
        assert abs(last.drive) > 0.0


def test_the_longest_stable_step_is_accurate_enough() -> None:
    """The ride from first touch, at 5 % damping: hub within 1e-5 m of steps an eighth as long, account to 1e-3."""
    rig, states, account = ridden(depth=0.0, part=1.0)
    fine = ridden(depth=0.0, part=0.125)[1]
    heights = np.array([[rig.hub(a.z)[2], rig.hub(b.z)[2]] for a, b in zip(states, fine, strict=True)])
    assert np.abs(heights[:, 0] - heights[:, 1]).max() < 1e-5
    assert np.ptp(heights[:, 1]) > 0.01
    assert account.closure() < 1e-3


@pytest.mark.parametrize("part", ["damping", "contact"])
def test_an_account_without_a_part_stays_open(part: str) -> None:
    """Negative control."""
    _, _, account = dropped()
    open_account = EnergyAccount(account.system, [replace(row, **{part: 0.0}) for row in account.rows])
    assert open_account.closure() > 0.05


def test_an_account_of_nothing() -> None:
    """A wheel that has not moved yet is closed; without a state there is no account."""
    rig, _, account = dropped()
    with pytest.raises(InputError, match="energy account"):
        EnergyAccount(rig.system).closure()
    assert EnergyAccount(rig.system, account.rows[:1]).closure() == 0.0


def test_ride_climbs_the_half_round() -> None:
    """Beside the same ride on level ground: nothing before the rock, lifted on it by less than its height."""
    rig, states, _ = ridden()
    hubs = np.array([rig.hub(s.z) for s in states])
    level = np.array([rig.hub(s.z) for s in ridden(rock=False)[1]])
    assert np.abs(hubs - level)[hubs[:, 0] < 0.15].max() < 1e-9
    on_rock = np.abs(hubs[:, 0] - 0.25) < 0.05
    lifted = hubs[on_rock, 2] - np.interp(hubs[on_rock, 0], level[:, 0], level[:, 2])
    assert 0.003 < lifted.max() < ROUND + 0.005  # the tire swallows part of the obstacle
    assert hubs[-1, 0] > 0.45
    assert np.abs(hubs[:, 1]).max() < 1e-9  # symmetric: it stays on its line


def test_a_wheel_at_rest_carries_its_weight_at_the_static_deflection() -> None:
    rig = wheel_rig(build_tire(PRESET), Plane(), hub=HUB, damping_ratio=0.6)
    weight = (HUB.mass + flexible_mass(rig.tire.model)) * MARS_GRAVITY
    start = rig.start(np.array([0.0, 0.0, RADIUS - 0.012]), np.zeros(3))
    (end,) = integrate_implicit(
        rig.system, start, np.array([3.0]), ImplicitSettings(spectral_radius=0.5, tolerance=1e-5)
    )
    assert rig.load(end)[2] == pytest.approx(weight, rel=1e-3)
    deflections = np.linspace(0.005, 0.02, 16)
    static = solve_tire(rig.tire, 0.0, deflections)
    hub_load = rig.load(end)[2] - flexible_mass(rig.tire.model) * MARS_GRAVITY
    expected = np.interp([hub_load, weight], static.load, deflections)
    assert expected[0] - 1e-4 < RADIUS - rig.hub(end.z)[2] < expected[1] + 1e-4  # the plates' own weight lies between


def test_damping_is_that_of_the_first_mode() -> None:
    """Twice the ratio is twice the viscosity; none is none; out of range is refused."""
    tire = dropped()[0].tire
    assert damped_model(tire, 0.1).viscosity[1] == pytest.approx(2.0 * damped_model(tire, 0.05).viscosity[1])
    assert damped_model(tire, 0.0) is tire.model
    with pytest.raises(InputError, match="damping ratio"):
        damped_model(tire, 1.0)


def test_a_step_above_the_stable_one_stops_with_a_message() -> None:
    """Negative control of `stable_step`: three times as long."""
    rig, _, _ = dropped()
    start = rig.start(np.array([0.0, 0.0, RADIUS]), np.zeros(3))
    step = 3.0 * stable_step(rig.system, start.z, safety=1.0)
    with pytest.raises(ConvergenceError, match="step"):
        list(integrate_explicit(rig.system, start, np.array([1.0]), step))


def test_plates_that_fold_stop_the_run_with_a_message() -> None:
    """A sixth of the rover is too much for the thesis' tire: it ends where plates turn inside out, and says so."""
    hub = HubMass(mass=48.9, inertia=0.1 * np.eye(3))
    rig = wheel_rig(build_tire(PRESET), Plane(), hub=hub, damping_ratio=0.05)
    start = rig.start(np.array([0.0, 0.0, RADIUS + DROP]), np.zeros(3))
    with pytest.raises(ConvergenceError, match="plates fold"):
        list(integrate_explicit(rig.system, start, np.linspace(0.01, 0.6, 60), 0.7 * stable_step(rig.system, start.z)))
