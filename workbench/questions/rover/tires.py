"""The rover on six ANCF tires: the one place where the vehicle and the tires meet.

Verified by tests/unit/test_workbench_rover_tires.py and tests/end_to_end/test_rover.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.preset import TirePreset, thesis_preset
from ancf_reduced.tire.wheel_set import THESIS_LAW, WheelSet, wheel_set
from contracts.errors import ConvergenceError, InputError
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle, on_flexible_tires
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion
from workbench.questions.rover.tire_shapes import TireShapes, Watch

__all__ = [
    "DAMPING_RATIO",
    "LAW",
    "START_HEIGHT",
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
STEPS = EvenSteps(shortest=1e-5)
"""On level ground and slopes a motion that needs shorter ones is one in which a tire folds."""
START_HEIGHT = -0.015
"""Lowest points of the undeformed wheels over the ground at the start of the settling [m]: from there the tires sink by
themselves, while from the ground up the fall takes them beyond what they carry."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfRide:
    """Motion of a scenario on six flexible tires, see `on_ancf_tires`.

    Attributes
    ----------
    tire, steps, law, turned, settling_damping : as there
    checkpoint : file that a long motion is kept in, or None; see `rover_dynamics.flexible.motion_checkpoint`
    watched : makes of the equations what sees each step's end from time zero on, or None
    """

    tire: Tire
    steps: EvenSteps
    law: ContactLaw
    turned: float
    settling_damping: float | None = None
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
            If a tire folds or no step converges; with the motion up to there.
        """
        _check_size(self.tire, design)
        law = self.on_ground(scenario)
        vehicle, times, start = scenario.vehicle(design), scenario.times(), None
        if self.settling_damping is not None and times[0] < 0.0:
            quieter = self._on_tires(vehicle, replace(law, damping=self.settling_damping))
            start = self._driven(quieter, np.array([times[0], 0.0]), None)[1]
        ride = self._on_tires(vehicle, law)
        return self._driven(ride, times, start, checkpoint=self.checkpoint, watched=self.watched)[0]

    def _on_tires(self, vehicle: Vehicle, law: ContactLaw) -> tuple[FlexibleVehicle, WheelSet]:
        n = len(vehicle.wheels)
        tires = wheel_set(self.tire, vehicle.terrain, n, law=law, damping_ratio=DAMPING_RATIO)
        return on_flexible_tires(vehicle, tires, np.full(n, self.turned)), tires

    def _driven(
        self,
        ride: tuple[FlexibleVehicle, WheelSet],
        times: NDArray[np.float64],
        start: Instant | None,
        *,
        checkpoint: Path | None = None,
        watched: Callable[[FlexibleSystem], Watch] | None = None,
    ) -> tuple[FlexibleMotion, Instant]:
        """The motion, and the state at its end."""
        vehicle, tires = ride
        system = FlexibleSystem(vehicle)
        shapes = TireShapes(system, tires, vehicle.vehicle.wheels, _from_zero(watched(system)) if watched else None)
        try:
            motion = drive_on_flexible_tires(
                vehicle,
                times,
                self.steps,
                settles_until=0.0,
                watch=shapes.watch,
                start=start,
                checkpoint=checkpoint,
            )
        except ConvergenceError as error:
            raise shapes.explained(error) from error
        assert shapes.seen is not None or checkpoint is not None  # a resumed motion may have no step left
        return motion, shapes.seen[1] if shapes.seen is not None else system.at_rest(float(times[0]))


def contact_law(preset: TirePreset) -> ContactLaw:
    """What each contact point of a tire feels under the rover.

    Stiffness is the tire's. Damping, its depth and friction are no numbers of a tire but the rover's, those of `LAW`;
    the damping is in proportion to the stiffness, the thesis' c / k = 0.1 s, so that a finer grid of as much stiffness
    has as much damping.
    """
    damping = LAW.damping * (preset.contact_stiffness / LAW.stiffness)
    return replace(LAW, stiffness=preset.contact_stiffness, damping=damping)


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
    settling_damping: float | None = None,
) -> Scenario:
    """The same on six flexible tires; they settle by strongly damped implicit steps until time zero.

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
    settling_damping : of each contact point while the rover first comes to rest, after which it starts again from
        there [N s/m]: on slopes it otherwise overshoots; None: that of the law, and one settling
    """
    tire = tire or build_tire(thesis_preset())
    ride = AncfRide(
        tire=tire,
        steps=steps,
        law=law or contact_law(tire.preset),
        turned=turned,
        settling_damping=settling_damping,
    )
    height = START_HEIGHT if scenario.height is None else scenario.height
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
