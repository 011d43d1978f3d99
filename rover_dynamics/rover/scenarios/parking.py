"""The rover of a scenario with its brakes on: drives held where they are, as it stands before it moves.

Verified by tests/unit/test_rover_parking.py.
"""

from __future__ import annotations

from dataclasses import replace

from rover_dynamics.multibody.motion_law import Hold, MotionLaw
from rover_dynamics.rover.rover import Actuators
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.scenario import Scenario

__all__ = ["parked"]


def parked(scenario: Scenario) -> Scenario:
    """The same with every drive held at zero; deployment and steering as they are."""

    def actuators(design: RoverDesign) -> Actuators:
        own, drives = scenario.actuators(design), {f"drive_{leg.name}" for leg in design.legs}
        laws: dict[str, MotionLaw] = {**own.laws, **{name: Hold() for name in drives}}
        torques = {name: torque for name, torque in own.torques.items() if name not in drives}
        return Actuators(laws=laws, torques=torques, free=own.free - drives)

    return replace(scenario, actuators=actuators)
