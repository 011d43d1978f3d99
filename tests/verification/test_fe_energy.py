"""Claim: the work of the ground is stored in the wheel; what friction takes on a rough ground is dissipated.

Source: conservation of energy; elastic material, frictionless springs. The stored energy comes from the
energy function in UFL, the load from the contact pressure, the equilibrium from the hand-written loops: three things
that have nothing in common but the model. Tolerance: what the trapezoid rule errs by, estimated by leaving out every
other point (1e-3 with 4 steps, a quarter with 8), plus what the contact penalty stores, at most half the load times
the largest penetration (1.7e-3 of the work). The rough case is a planar wheel that slides off a half-round rock beside
its lowest point and loses 1.4 % of the work. Negative controls: an energy or a load that is 1 % off is caught, and a
rough wheel without its dissipation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact.obstacles import HalfRoundRock
from reference_fe.wheel.pressed import WheelLoadCase, solve_wheel
from reference_fe.wheel.section import solve_section
from workbench.questions.numerics.energy import energy_error, quadrature_error

STEPS = 8
END = 0.004


@pytest.fixture(scope="module")
def curve() -> StiffnessCurve:
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    deflections = tuple(float(d) for d in END * np.arange(1, STEPS + 1) / STEPS)
    case = WheelLoadCase(orientation_deg=0.0, deflections=deflections)
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case).curve


def _allowed(curve: StiffnessCurve) -> float:
    """Error of the rule plus the penalty's share [-]."""
    penalty = 0.5 * curve.load[-1] * curve.columns["penetration_m"][-1]
    return quadrature_error(curve) + float(penalty / np.trapezoid(curve.load, curve.deflection))


def test_work_is_stored(curve: StiffnessCurve) -> None:
    assert _allowed(curve) < 2.5e-3
    assert energy_error(curve) < _allowed(curve)


def test_a_force_or_an_energy_that_is_off_is_caught(curve: StiffnessCurve) -> None:
    assert energy_error(replace(curve, load=1.01 * curve.load)) > 2.0 * _allowed(curve)
    columns = {**curve.columns, "stored_energy_J": 0.99 * curve.columns["stored_energy_J"]}
    assert energy_error(replace(curve, columns=columns)) > 2.0 * _allowed(curve)


@pytest.fixture(scope="module")
def rough() -> StiffnessCurve:
    """Planar wheel on a rock of 30 mm radius, 60 mm from its middle; friction low enough that it slides."""
    case = WheelLoadCase(
        orientation_deg=15.0,
        deflections=tuple(float(d) for d in 0.02 * np.arange(1, 21) / 20),
        obstacle=HalfRoundRock(radius=0.03, position=0.06),
        friction=0.1,
        contact_stiffness=1e12,
    )
    return solve_section(build_planar_mesh(exomars_hoops(), element_size=14e-3), exomars_hoops(), case).curve


def test_work_of_a_rough_ground_is_stored_or_dissipated(rough: StiffnessCurve) -> None:
    assert _allowed(rough) < 2.5e-3
    assert energy_error(rough) < _allowed(rough)
    assert np.all(np.diff(rough.columns["friction_dissipation_J"]) >= 0.0)


def test_lost_dissipation_is_caught(rough: StiffnessCurve) -> None:
    bare = {name: values for name, values in rough.columns.items() if name != "friction_dissipation_J"}
    assert energy_error(replace(rough, columns=bare)) > 2.0 * _allowed(rough)
