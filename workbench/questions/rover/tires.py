"""The rover on six ANCF tires: the one place where the vehicle and the tires meet.

Verified by tests/unit/test_workbench_rover_tires.py and tests/end_to_end/test_rover.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.preset import TirePreset, thesis_preset
from ancf_reduced.tire.wheel_set import THESIS_LAW, WheelSet, wheel_set
from contracts.errors import ConvergenceError, InputError
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle, on_flexible_tires
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.flexible.quasi_static import brought_to_rest
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.parking import parked
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion
from workbench.questions.rover.tire_shapes import TRY, TireShapes, Watch

__all__ = [
    "DAMPING_RATIO",
    "LAW",
    "AncfRide",
    "contact_law",
    "on_ancf_tires",
    "resuming",
    "tire_of",
    "watching",
]

DAMPING_RATIO = 0.05
"""Of the first mode of a tire on a held hub, see `ancf_reduced.tire.wheel_rig.damped_model`; the thesis gives none
[-]."""
LAW = replace(THESIS_LAW, damping_depth=1e-3)
"""The thesis' contact, its damping built up over a millimetre of penetration: at the speeds of traction points arrive
so fast that the force of eq. 2.22, which is there at once, ends every Newton iteration."""
DISSIPATION = 0.5
"""Of Hunt and Crossley's damping [s/m]: after a fall of 10 mm on Mars, 0.27 m/s, a point keeps 0.91 of its speed."""
STEPS = EvenSteps(shortest=1e-5)
"""On level ground and slopes a motion that needs shorter ones is one in which a tire folds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfRide:
    """Motion of a scenario on six flexible tires, see `on_ancf_tires`.

    Attributes
    ----------
    tire, steps, law, turned : as there
    checkpoint : file that a long motion is kept in, or None; see `rover_dynamics.flexible.motion_checkpoint`
    watched : makes of the equations what sees each step's end from time zero on, or None
    """

    tire: Tire
    steps: EvenSteps
    law: ContactLaw
    turned: float
    checkpoint: Path | None = None
    watched: Callable[[FlexibleSystem], Watch] | None = None

    def on_ground(self, scenario: Scenario) -> ContactLaw:
        """The law with the friction that the scenario asks for, if it does."""
        return self.law if scenario.friction is None else replace(self.law, friction=scenario.friction)

    def __call__(self, scenario: Scenario, design: RoverDesign) -> VehicleMotion:
        """The motion at the scenario's times.

        Raises
        ------
        ConvergenceError
            If the rover does not stand; if a tire folds or no step converges, with the motion up to there.
        """
        _check_size(self.tire, design)
        begins = float(scenario.times()[0])
        return self.moved(scenario, design, self.standing(scenario, design, begins) if begins < 0.0 else None)

    def moved(self, scenario: Scenario, design: RoverDesign, start: Instant | None) -> FlexibleMotion:
        """As a call, from another motion's end, at rest, or without one from undeformed tires."""
        vehicle, tires = self.on_tires(scenario.vehicle(design), self.on_ground(scenario))
        system = FlexibleSystem(vehicle)
        watched = _from_zero(self.watched(system)) if self.watched else None
        shapes = TireShapes(system, tires, vehicle.vehicle.wheels, watched)
        try:
            return drive_on_flexible_tires(
                vehicle,
                scenario.times(),
                self.steps,
                settles_until=0.0,
                watch=shapes.watch,
                start=start,
                checkpoint=self.checkpoint,
            )
        except ConvergenceError as error:
            raise shapes.explained(error) from error

    def standing(self, scenario: Scenario, design: RoverDesign, t: float) -> Instant:
        """The rover at rest at a time t [s] before it moves, brakes on; contact without damping, of no use at rest.

        Raises
        ------
        ConvergenceError
            If it does not stand on these tires: load asked for, largest one found, and the plate that gives way.
        """
        law = self.on_ground(scenario).undamped()
        vehicle, tires = self.on_tires(parked(scenario).vehicle(design), law)
        shapes = TireShapes(FlexibleSystem(vehicle), tires, vehicle.vehicle.wheels)
        try:
            return brought_to_rest(vehicle, t, shapes.faults)
        except ConvergenceError as error:
            raise ConvergenceError(f"the rover does not stand: {error}; {TRY}", error.history) from error

    def on_tires(self, vehicle: Vehicle, law: ContactLaw) -> tuple[FlexibleVehicle, WheelSet]:
        n = len(vehicle.wheels)
        tires = wheel_set(self.tire, vehicle.terrain, n, law=law, damping_ratio=DAMPING_RATIO)
        return on_flexible_tires(vehicle, tires, np.full(n, self.turned)), tires


def contact_law(preset: TirePreset) -> ContactLaw:
    """What each contact point of a tire feels under the rover.

    Stiffness and kind of damping are the tire's, friction is that of `LAW`. As printed, damping is in proportion to the
    stiffness, the thesis' c / k = 0.1 s, so that a finer grid of as much stiffness has as much damping; that of Hunt
    and Crossley is so by itself.
    """
    k = preset.contact_stiffness
    if preset.contact_damping == "as_printed":
        return replace(LAW, stiffness=k, damping=LAW.damping * (k / LAW.stiffness))
    chi = DISSIPATION if preset.contact_damping == "hunt_crossley" else 0.0
    return replace(LAW.undamped(), stiffness=k, dissipation=chi)


def _from_zero(watch: Watch) -> Watch:
    """Sees no settling."""

    def seen(t: float, now: Instant) -> None:
        if t >= 0.0:
            watch(t, now)

    return seen


def on_ancf_tires(
    scenario: Scenario,
    tire: Tire | None = None,
    *,
    steps: EvenSteps = STEPS,
    law: ContactLaw | None = None,
    turned: float = 0.0,
) -> Scenario:
    """The same on six flexible tires; the rover comes to rest first, see `rover_dynamics.flexible.quasi_static`.

    From there strongly damped implicit steps lead to time zero, in which wheels that nothing holds roll to where they
    stand by themselves.

    What is searched beside the run is left out, its bisections would take many minutes; a motion in which a tire folds
    ends before it. Friction is that of the scenario, so that all tires slip alike there; of one that asks for none it
    is the law's, the thesis' 0.6.

    Parameters
    ----------
    scenario : with wheels of the tire's radius
    tire : all six of them; the thesis' if left out
    steps : how they are chosen
    law : contact of each point; `contact_law` if left out
    turned : angle of each tire on its wheel about the axle, positive rolls forward [rad]
    """
    tire = tire or build_tire(thesis_preset())
    ride = AncfRide(
        tire=tire,
        steps=steps,
        law=law or contact_law(tire.preset),
        turned=turned,
    )
    height = scenario.height or 0.0
    return replace(scenario, ride=ride, height=height, tire_model="ancf", has_closed_forms=False, search=None)


def tire_of(scenario: Scenario) -> Tire | None:
    """The ANCF tire a scenario drives on; None on others."""
    return scenario.ride.tire if isinstance(scenario.ride, AncfRide) else None


def resuming(scenario: Scenario, checkpoint: Path | None) -> Scenario:
    """A scenario on ANCF tires that keeps its motion in a file and goes on from what it finds there; others as is."""
    if not isinstance(scenario.ride, AncfRide):
        return scenario
    return replace(scenario, ride=replace(scenario.ride, checkpoint=checkpoint))


def watching(scenario: Scenario, watched: Callable[[FlexibleSystem], Watch]) -> Scenario:
    """A scenario on ANCF tires whose steps are seen from time zero on, see `AncfRide`."""
    assert isinstance(scenario.ride, AncfRide)
    return replace(scenario, ride=replace(scenario.ride, watched=watched))


def _check_size(tire: Tire, design: RoverDesign) -> None:
    """The undeformed wheel of the rover must be the tire's."""
    radius = tire.preset.zero_radius
    if abs(design.wheel_radius - radius) > 1e-9:
        rule = f"is not that of the ANCF tire, {1e3 * radius:g} mm"
        raise InputError("wheel radius of the rover", f"{1e3 * design.wheel_radius:g} mm", rule, "use --tire brush")
