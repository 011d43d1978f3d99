"""Reference nodes as constrained coordinates and eliminated onto the wheels' bodies give the same motion.

Claim: equation 2.26 of the thesis with absolute coordinates of all bodies, Cholesky coordinates of all tires and twelve
equations for each reference node, and the form in joint coordinates with reference nodes eliminated, have the same
accelerations at one state and the same motion to 1e-8 m, integrated with error control as the thesis does (section
2.5.3). The fast generalised-alpha method follows them to the error it is allowed.
Source: thesis eqs 2.20, 2.24 to 2.26; both forms are of the same equations.
Tolerance: 1e-8 of the largest acceleration; 1e-8 m and (gradients) 1e-8 over 8 ms, 4e-10 is found; constraints 1e-10
at position and velocity level. 2e-6 m between the fast method at an error of 1e-6 m allowed in a step and the others
over 30 ms, a fifth of it at 1e-8 m.
Negative controls: a tire mounted at another angle violates the constraints; without their quadratic terms accelerations
differ.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from rover_dynamics.flexible import constrained_coordinates
from rover_dynamics.flexible.constrained_coordinates import ConstrainedCoordinates
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.flexible.independent_coordinates import IndependentCoordinates
from rover_dynamics.flexible.node_constraints import NodeConstraints, node_constraints
from rover_dynamics.multibody.motion import StepControl, integrate
from tests.verification.flexible_cart import cart

FloatArray = NDArray[np.float64]
SAME, FOLLOWS = 1e-8, 2e-6


def spinning(form: IndependentCoordinates) -> FloatArray:
    """The start with joint velocities at random: all quadratic terms count."""
    y, (q_end, v_end) = form.start(), np.cumsum([form.system.tree.q_at[-1], form.system.tree.v_at[-1]])
    y[q_end:v_end] += 0.3 * np.random.default_rng(7).normal(size=v_end - q_end)
    return y


def accelerations_apart(vehicle: FlexibleVehicle) -> float:
    """Largest difference of the tires' accelerations between the forms, over the largest acceleration."""
    eliminated, constrained = IndependentCoordinates(vehicle), ConstrainedCoordinates(vehicle)
    y = spinning(eliminated)
    now = eliminated.instant(0.05, y)
    other = constrained.with_tires(eliminated.state(0.05, y), *eliminated.system.whole(now))
    state, (p, p_rate) = constrained.state(0.05, other), constrained.cholesky(other)
    found = constrained.from_cholesky(constrained.accelerations(0.05, state, p, p_rate)[1])
    expected = np.concatenate([now.z_acceleration, now.hub.a], axis=1)
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def test_both_have_the_same_accelerations() -> None:
    vehicle = cart(height=-0.002, ratio=0.02)
    assert accelerations_apart(vehicle) < SAME


def test_a_tire_mounted_otherwise_breaks_the_constraints() -> None:
    """Negative control."""
    vehicle = cart()
    turned = ConstrainedCoordinates(replace(vehicle, mounts=vehicle.mounts[::-1]))
    start = ConstrainedCoordinates(vehicle).start()
    assert turned.defects(0.0, start)[0] > 0.1
    assert ConstrainedCoordinates(vehicle).defects(0.0, start)[0] < 1e-12


def test_constraints_without_quadratic_terms_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: Q_c of eq. 2.25 left out."""

    def without(*arguments: object) -> NodeConstraints:
        found = node_constraints(*arguments)  # type: ignore[arg-type]
        return replace(found, accelerations=np.zeros_like(found.accelerations))

    vehicle = cart(height=-0.002, ratio=0.02)
    monkeypatch.setattr(constrained_coordinates, "node_constraints", without)
    assert accelerations_apart(vehicle) > SAME


def test_both_move_alike() -> None:
    vehicle, times = cart(height=-0.001), np.array([0.0, 0.004, 0.008])
    forms = IndependentCoordinates(vehicle), ConstrainedCoordinates(vehicle)
    control = StepControl(relative=1e-9, absolute=1e-11)
    motions = [integrate(form, times, control) for form in forms]
    places = [np.array([state.positions for state in motion.states]) for motion in motions]
    tires = [form.vectors(0.008, motion.coordinates[-1]) for form, motion in zip(forms, motions, strict=True)]
    apart = np.abs(places[0] - places[1]).max(), np.abs(tires[0] - tires[1]).max()
    print(f"\nbodies {apart[0]:.1e} m, tires {apart[1]:.1e}")
    assert max(apart) < SAME
    assert np.ptp(tires[0] - forms[0].vectors(0.0, forms[0].start())) > 1e-4
    position, velocity = forms[1].defects(0.008, motions[1].coordinates[-1])
    assert position < 1e-10
    assert velocity < 1e-10


def test_the_fast_method_follows_the_thesis_way() -> None:
    vehicle, times = cart(height=-0.001), np.linspace(0.0, 0.03, 4)
    form = IndependentCoordinates(vehicle)
    exact = integrate(form, times, StepControl(relative=1e-6, absolute=1e-8))
    places = np.array([state.positions for state in exact.states])
    apart = {}
    for tolerance in (1e-6, 1e-8):
        steps = EvenSteps(tolerance=tolerance, first=1e-4, spectral_radius=0.9)
        apart[tolerance] = np.abs(drive_on_flexible_tires(vehicle, times, steps).positions - places).max()
    print(f"\n{apart}")
    assert apart[1e-6] < FOLLOWS
    assert apart[1e-8] < 0.2 * FOLLOWS
