"""The rover on six ANCF tires: the one place where the vehicle and the tires meet.

Verified by tests/unit/test_workbench_rover_tires.py and tests/end_to_end/test_rover.py.
"""

from __future__ import annotations

from dataclasses import replace

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

__all__ = ["DAMPING_RATIO", "LAW", "START_HEIGHT", "on_ancf_tires", "unfolded"]

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
    fitted = tire or build_tire(thesis_preset())

    def ride(scenario: Scenario, design: RoverDesign) -> VehicleMotion:
        _check_size(fitted, design)
        vehicle = scenario.vehicle(design)
        n, friction = len(vehicle.wheels), scenario.tire.friction_max
        slides = law if friction == THESIS_BRUSH.friction_max else replace(law, friction=friction)
        tires = wheel_set(fitted, vehicle.terrain, n, law=slides, damping_ratio=DAMPING_RATIO)
        flexible = on_flexible_tires(vehicle, tires, np.full(n, turned))
        return unfolded(drive_on_flexible_tires(flexible, scenario.times(), steps, settles_until=0.0), tires)

    height = START_HEIGHT if scenario.height is None else scenario.height
    return replace(scenario, ride=ride, height=height, tire_model="ancf", has_closed_forms=False, search=None)


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
