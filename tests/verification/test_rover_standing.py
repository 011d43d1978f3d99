"""Every wheel of the standing rover lies on its tire's own static curve.

Claim: the rover at rest on six ANCF tires, each turned to another orientation, bears its weight, and each wheel's load
is that of `ancf_reduced.tire.static` (hub held, ground pushed up, no vehicle) at the same orientation and deflection,
for each mean load of a sweep begun from the equilibrium before.
Source: both are the statics of thesis eq. 2.22; they share the plates' and contact forces and no solver.
Tolerance: 0.5 % of the load; wheels tilt by up to 0.4 degrees with their bogies, which the static tire does not.
Negative controls: the curve of an orientation 20 degrees further, or tires with weight, miss by three times as much.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_tire
from ancf_reduced.tire.wheel_set import WheelSet, wheel_set
from contracts.errors import InputError
from contracts.terrain import Plane
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.standing import Standing, stand_under_loads

DESIGN = read_rover()
TIRE = build_tire(replace(thesis_preset(), quadrature=(3, 3, 2)))
ORIENTATIONS = np.radians([0.0, 10.0, 25.0, 45.0, 60.0, 80.0])
LOADS = (197.9, 185.0, 205.0)
TOLERANCE = 5e-3


def tires(*, weighing: bool = False) -> WheelSet:
    law = ContactLaw(stiffness=TIRE.preset.contact_stiffness, damping=10.0, friction=0.0)
    made = wheel_set(TIRE, Plane(), 6, law=law)
    return made if weighing else replace(made, weight=np.zeros_like(made.weight))


def static_loads(rest: Standing, further: float = 0.0) -> np.ndarray:
    pairs = zip((ORIENTATIONS + further).tolist(), rest.deflection.tolist(), strict=True)
    return np.array([solve_tire(TIRE, phi, [0.5 * d, d]).load[-1] for phi, d in pairs])


@pytest.fixture(scope="module")
def rests() -> list[Standing]:
    return stand_under_loads(DESIGN, tires(), ORIENTATIONS, LOADS)


def test_the_wheels_bear_the_weight(rests: list[Standing]) -> None:
    for rest, load in zip(rests, LOADS, strict=True):
        assert rest.load.mean() == pytest.approx(load, rel=1e-4)
        assert np.degrees(np.abs(rest.orientation - ORIENTATIONS)).max() < 0.5


def test_each_wheel_lies_on_its_tires_curve(rests: list[Standing]) -> None:
    for rest in rests:
        np.testing.assert_allclose(rest.load, static_loads(rest), rtol=TOLERANCE)


def test_negative_control_another_orientation_is_noticed(rests: list[Standing]) -> None:
    assert np.abs(static_loads(rests[0], np.radians(20.0)) / rests[0].load - 1.0).max() > 3.0 * TOLERANCE


def test_negative_control_tires_with_weight_are_noticed() -> None:
    (rest,) = stand_under_loads(DESIGN, tires(weighing=True), ORIENTATIONS, LOADS[:1])
    assert np.abs(static_loads(rest) / rest.load - 1.0).max() > 3.0 * TOLERANCE


def test_a_load_of_zero_is_refused() -> None:
    with pytest.raises(InputError, match="mean wheel loads"):
        stand_under_loads(DESIGN, tires(), ORIENTATIONS, (0.0,))
