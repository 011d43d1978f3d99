"""The rover on six ANCF tires: the one place where the vehicle and the tires meet.

Verified by tests/unit/test_workbench_rover_tires.py and tests/end_to_end/test_rover.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ancf_reduced.contact_law import ContactLaw
from ancf_reduced.tire_mesh import Tire, build_tire
from ancf_reduced.tire_preset import thesis_preset
from ancf_reduced.wheel_set import THESIS_LAW, WheelSet, wheel_set
from contracts.errors import ConvergenceError, IncrementRecord, InputError
from rover_dynamics.brush_tire import THESIS_BRUSH
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, on_flexible_tires
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.scenario import Scenario, sampled
from rover_dynamics.vehicle.vehicle import VehicleMotion

__all__ = ["DAMPING_RATIO", "LAW", "START_HEIGHT", "AncfRide", "on_ancf_tires", "resuming", "unfolded"]

DAMPING_RATIO = 0.05
"""Of the first mode of a tire on a held hub, see `ancf_reduced.wheel_rig.damped_model`; the thesis gives none [-]."""
LAW = replace(THESIS_LAW, damping_depth=1e-3)
"""The thesis' contact, its damping built up over a millimetre of penetration: at the speeds of traction points arrive
so fast that the force of eq. 2.22, which is there at once, ends every Newton iteration."""
STEPS = EvenSteps(shortest=1e-5)
"""A motion that needs shorter ones is one in which a tire folds."""
START_HEIGHT = -0.015
"""Lowest points of the undeformed wheels over the ground at the start of the settling [m]: from there the tires sink by
themselves, while from the ground up the fall takes them beyond what they carry."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfRide:
    """Motion of a scenario on six flexible tires, see `on_ancf_tires`.

    Attributes
    ----------
    tire, steps, law, turned : as there
    checkpoint : file that a long motion is kept in, or None; see `rover_dynamics.flexible.motion_checkpoint`
    """

    tire: Tire
    steps: EvenSteps
    law: ContactLaw
    turned: float
    checkpoint: Path | None = None

    def __call__(self, scenario: Scenario, design: RoverDesign) -> VehicleMotion:
        """The motion at the scenario's times."""
        _check_size(self.tire, design)
        vehicle = scenario.vehicle(design)
        n, friction = len(vehicle.wheels), scenario.tire.friction_max
        law = self.law if friction == THESIS_BRUSH.friction_max else replace(self.law, friction=friction)
        tires = wheel_set(self.tire, vehicle.terrain, n, law=law, damping_ratio=DAMPING_RATIO)
        flexible = on_flexible_tires(vehicle, tires, np.full(n, self.turned))
        motion = drive_on_flexible_tires(
            flexible, scenario.times(), self.steps, settles_until=0.0, checkpoint=self.checkpoint
        )
        return unfolded(motion, tires)


def on_ancf_tires(
    scenario: Scenario,
    tire: Tire | None = None,
    *,
    steps: EvenSteps = STEPS,
    law: ContactLaw = LAW,
    turned: float = 0.0,
) -> Scenario:
    """The same on six flexible tires; they settle by implicit Euler steps until time zero.

    What is searched beside the run is left out, its bisections would take many minutes; a motion in which a tire folds
    ends before it. Friction is the thesis' 0.6 unless the scenario's brush tires have one of their own, so that both
    slip alike there.

    Parameters
    ----------
    scenario : with wheels of the tire's radius
    tire : all six of them; the thesis' if left out
    steps : how they are chosen
    law : contact of each point
    turned : angle of each tire on its wheel about the axle, positive rolls forward [rad]
    """
    ride = AncfRide(tire=tire or build_tire(thesis_preset()), steps=steps, law=law, turned=turned)
    height = START_HEIGHT if scenario.height is None else scenario.height
    return replace(scenario, ride=ride, height=height, tire_model="ancf", has_closed_forms=False, search=None)


def resuming(scenario: Scenario, checkpoint: Path | None) -> Scenario:
    """A scenario on ANCF tires that keeps its motion in a file and goes on from what it finds there; others as is."""
    if not isinstance(scenario.ride, AncfRide):
        return scenario
    return replace(scenario, ride=replace(scenario.ride, checkpoint=checkpoint))


def _check_size(tire: Tire, design: RoverDesign) -> None:
    """The undeformed wheel of the rover must be the tire's."""
    radius = tire.preset.outer_radius
    if abs(design.wheel_radius - radius) > 1e-9:
        rule = f"is not that of the ANCF tire, {1e3 * radius:g} mm"
        raise InputError("wheel radius of the rover", f"{1e3 * design.wheel_radius:g} mm", rule, "use --tire brush")


def unfolded(motion: FlexibleMotion, tires: WheelSet) -> FlexibleMotion:
    """The motion, if no plate is inverted in it; else raises with what comes before."""
    for k, z in enumerate(motion.vectors):
        if float(tires.system.model.volume_ratio(tires.node_coordinates(z)).min()) <= 0.0:
            before, t = {name: rows[:k] for name, rows in sampled(motion).items()}, motion.times[k]
            message = (
                f"a tire folds at t = {t:g} s: a plate is inverted; lower the load, fall less far, or stiffen the tire"
            )
            record = IncrementRecord(target=float(t), step=0.0, converged=False, residuals=())
            raise ConvergenceError(message, [record], replace(motion, **before) if k else None)
    return motion
