"""On ANCF tires the rover is at rest before it moves: on level ground, on rocks and on slopes; or it says why not.

Claim: at the start found by `rover_dynamics.flexible.quasi_static` forces balance with every damper and the scenario's
own contact law in place, and the wheels carry the weight; where no equilibrium exists the message has the load asked
for, the largest one found, and the plate.
Source: equations of motion of `flexible_system` at zero velocities, which the way to rest does not use; thesis Table I.
Tolerance: without friction 1e-3 of gravity, twice what the search leaves, as accelerations of joints; loads 1e-3 of
the weight. Friction is what a creep makes it and none at zero velocity: with it the settling that follows must keep
every load within 2 % (10 % on rocks), and a slope's normal load is right within 1 %.
Negative control: undeformed tires pressed 15 mm into the ground, as the rover started before, are a hundred times
further from balance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import ConvergenceError
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.quasi_static import unbalanced
from rover_dynamics.rover.planets import gravity_named
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_terrain, rocks_on_the_way
from rover_dynamics.rover.scenarios.parking import parked
from rover_dynamics.rover.scenarios.scenario import Scenario, run_scenario
from workbench.questions.rover.tires import AncfRide, contact_law, on_ancf_tires

DESIGN = read_rover()
TOLERANCE = 1e-3


def straight(law: ContactLaw | None = None) -> Scenario:
    return on_ancf_tires(replace(SCENARIOS["straight"], settles=1.0, lasts=0.2, every=0.1), law=law)


def at_rest(scenario: Scenario, design: RoverDesign = DESIGN) -> tuple[FlexibleSystem, Instant]:
    """The start and the equations of the parked rover with the scenario's own law, damping and all."""
    ride = scenario.ride
    assert isinstance(ride, AncfRide)
    place = ride.standing(scenario, design, -1.0)
    vehicle, _ = ride.on_tires(parked(scenario).vehicle(design), ride.on_ground(scenario))
    return FlexibleSystem(vehicle), place


def missing(system: FlexibleSystem, place: Instant) -> float:
    """Of balance, as accelerations of the joints over gravity, from the equations of motion without velocities."""
    there = system.accelerated(place.q, np.zeros_like(place.v), (place.z, np.zeros_like(place.z)), system.known(-1.0))
    return unbalanced(system, there.a, np.zeros_like(there.z_acceleration))


def test_level_ground_is_balanced_and_pressed_tires_are_not() -> None:
    smooth = straight(law=replace(contact_law(thesis_preset()), friction=0.0))
    system, place = at_rest(smooth)
    assert missing(system, place) < TOLERANCE
    load = system.tires.contacts(*system.whole(place)).load
    assert load.sum() == pytest.approx(6.0 * DESIGN.static_load, rel=TOLERANCE)
    assert np.ptp(load) < 0.01 * DESIGN.static_load
    pressed = replace(smooth, height=-0.015)
    vehicle, _ = smooth.ride.on_tires(parked(pressed).vehicle(DESIGN), smooth.ride.law)  # type: ignore[attr-defined]
    other = FlexibleSystem(vehicle)
    assert missing(other, other.at_rest(-1.0)) > 100.0 * TOLERANCE


def test_on_rocks_the_rover_comes_to_rest_and_stays() -> None:
    """Seed 2, on which a tire folded under 587 N while the rover settled."""
    scenario = straight()
    rocks = on_terrain(scenario, DESIGN, rocks_on_the_way(scenario, DESIGN, 2), "rocks")
    system, place = at_rest(rocks)
    load = system.tires.contacts(*system.whole(place)).load
    assert load.max() < 1.4 * DESIGN.static_load
    run = run_scenario(rocks, DESIGN)
    assert run.stopped is None
    np.testing.assert_allclose(run.loads[0], load, rtol=0.1)


def test_with_friction_the_settling_keeps_the_loads() -> None:
    system, place = at_rest(straight())
    load = system.tires.contacts(*system.whole(place)).load
    np.testing.assert_allclose(run_scenario(straight(), DESIGN).loads[0], load, rtol=0.02)


@pytest.mark.parametrize("name", ["slope_up", "slope_across"])
def test_on_ten_degrees_the_rover_stands_still(name: str) -> None:
    """25 degrees are more than these tires carry."""
    slope = SCENARIOS[name]
    tilted = replace(slope, tilt=replace(slope.tilt, angle=np.radians(10.0)), settles=1.0, lasts=0.2, every=0.1)
    scenario = on_ancf_tires(tilted)
    system, place = at_rest(scenario)
    load = system.tires.contacts(*system.whole(place)).load
    assert load.sum() == pytest.approx(6.0 * DESIGN.static_load * np.cos(np.radians(10.0)), rel=0.01)
    assert np.linalg.norm(system.gravity[:2]) > 0.1 * DESIGN.gravity
    run = run_scenario(scenario, DESIGN)
    np.testing.assert_allclose(run.loads[0], load, rtol=0.02)


def test_where_there_is_no_equilibrium_the_message_says_so() -> None:
    """On Earth: 522 N a wheel, more than twice what the thesis' tire carries; negative control: on Mars it stands."""
    with pytest.raises(ConvergenceError, match="the rover does not stand: no equilibrium: asked for") as caught:
        run_scenario(straight(), replace(DESIGN, gravity=gravity_named("earth")))
    said = str(caught.value)
    assert "mean wheel load of 523 N, found up to 2" in said
    assert "(spoke, volume ratio" in said
    assert "deg of the wheel) of wheel" in said
