"""Claim: a driven slider-crank moves as its closed form says, and its drive does the work that its energy takes.

Source: x = r cos a + sqrt(l^2 - r^2 sin^2 a). Tolerances: 1e-10 m and 1e-9 m/s, as the positions follow from the
constraints alone; effort against power by central differences to 1e-5 N m. A free slider-crank started on its slider
passes its dead centres, as its independent velocity is chosen anew, and keeps its energy to 1e-8. Negative control: a
crank longer by 0.1 % is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.motion import StepControl, integrate
from rover_dynamics.multibody.motion_law import SpeedTrapezoid
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import constraint_defects, mechanical_energy, slider_crank

LAW = SpeedTrapezoid(speed=10.0, accelerates=0.2)
TIMES = np.linspace(0.0, 1.0, 11)
Make = type[AbsoluteCoordinates] | type[TreeCoordinates]
FORMULATIONS = [AbsoluteCoordinates, PartitionedCoordinates, TreeCoordinates]


def piston(angle: float, rate: float, r: float = 0.1, rod: float = 0.3) -> tuple[float, float]:
    root = np.sqrt(rod**2 - (r * np.sin(angle)) ** 2)
    return r * np.cos(angle) + root, -r * np.sin(angle) * rate * (1.0 + r * np.cos(angle) / root)


def distances(make: Make, r: float) -> tuple[float, float]:
    """Largest difference of the piston's position and velocity from the closed form."""
    motion = integrate(make(slider_crank(LAW)), TIMES, StepControl())
    expected = np.array([piston(*LAW.at(t)[:2], r=r) for t in TIMES])
    found = np.array([(state.positions[2, 0], state.velocities[2, 0]) for state in motion.states])
    away = np.max(np.abs(found - expected), axis=0)
    return float(away[0]), float(away[1])


@pytest.mark.parametrize("make", FORMULATIONS)
def test_piston_follows_the_closed_form(make: Make) -> None:
    position, velocity = distances(make, 0.1)
    assert position < 1e-10
    assert velocity < 1e-9


def test_a_longer_crank_is_seen() -> None:
    """Negative control."""
    assert distances(TreeCoordinates, 0.1001)[0] > 1e-5


@pytest.mark.parametrize("make", FORMULATIONS)
def test_the_drive_gives_the_power_that_the_energy_takes(make: Make) -> None:
    model = slider_crank(LAW)
    formulation, t, h = make(model), 0.437, 1e-4
    motion = integrate(formulation, np.array([0.0, t - h, t, t + h]), StepControl())
    before, _, after = (mechanical_energy(model, state) for state in motion.states[1:])
    effort = formulation.reactions(t, motion.coordinates[2]).efforts[0]
    assert effort * LAW.at(t)[1] == pytest.approx((after - before) / (2 * h), abs=1e-4)
    assert abs(effort) > 0.1


@pytest.mark.parametrize("make", [PartitionedCoordinates, TreeCoordinates])
def test_dead_centres_are_passed_by_choosing_anew(make: Make) -> None:
    """The crank is flung round: the slider's velocity vanishes twice a turn."""
    model = slider_crank(gravity=(0.0, 0.0, 0.0))
    crank = replace(model.bodies[0], angular_velocity=np.array([0.0, 0.0, 8.0]), velocity=np.array([0.0, 0.4, 0.0]))
    model = replace(model, bodies=(crank, *model.bodies[1:]))
    motion = integrate(make(model), np.linspace(0.0, 1.5, 16), StepControl(relative=1e-10, absolute=1e-11))
    energies = [mechanical_energy(model, state) for state in motion.states]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-8)
    assert min(state.velocities[0, 5] for state in motion.states) > 0.1
    assert max(max(constraint_defects(model, 0.0, state)) for state in motion.states) < 1e-10
