"""The mission's point turn: steering to the tangents first, then all wheels driven.

The rover turns about the centroid of its wheels' contact points, by a quarter turn to the left; the outermost wheels
roll at 70 m/h. It may lag by 5 %, and its centre may wander by 20 mm. Both bounds are choices: the mission
asks for a point turn, no more.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.motion_law import SpeedTrapezoid, Turn
from rover_dynamics.rover.rover import Actuators
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.level_ground import SPEED
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.readings import stated
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun

__all__ = ["POINT_TURN", "tangents", "turn_actuators"]

FloatArray = NDArray[np.float64]
ANGLE = 0.5 * math.pi
STEERS, PAUSES, RAMP = 10.0, 2.0, 5.0
"""Durations of steering, of standing behind it, of each change of speed [s]."""
ALLOWED_LAG, ALLOWED_WANDER = 0.05, 0.02
"""Of the angle [-]; of the centre [m]."""


def _centre(design: RoverDesign) -> tuple[float, float]:
    places = np.array([leg.drive[:2] for leg in design.legs])
    return float(places[:, 0].mean()), float(places[:, 1].mean())


def tangents(design: RoverDesign) -> dict[str, tuple[float, float]]:
    """Leg -> steering angle in -pi/2..pi/2 [rad] and signed distance from the centre [m], positive rolling forwards.

    Raises
    ------
    InputError
        For a wheel at the centre itself.
    """
    found, centre = {}, _centre(design)
    for leg in design.legs:
        x, y = leg.drive[0] - centre[0], leg.drive[1] - centre[1]
        sign = -1.0 if y > 0.0 else 1.0
        if math.hypot(x, y) < design.wheel_radius:
            rule = "lies at the centre of the turn"
            raise InputError(f"wheel {leg.name}", f"{math.hypot(x, y):g} m", rule, "this rover cannot turn on the spot")
        found[leg.name] = (math.atan2(sign * x, -sign * y), sign * math.hypot(x, y))
    return found


def _rate(design: RoverDesign) -> float:
    """Of the turn [rad/s]."""
    return SPEED / max(abs(distance) for _, distance in tangents(design).values())


def turn_actuators(design: RoverDesign) -> Actuators:
    """Steering to the tangents, then the drives."""
    begins, rate = STEERS + PAUSES, _rate(design)
    ends = begins + RAMP + ANGLE / rate
    laws: dict[str, Turn | SpeedTrapezoid] = {}
    for leg, (angle, distance) in tangents(design).items():
        laws[f"steer_{leg}"] = Turn(end=angle, lasts=STEERS)
        speed = rate * distance / design.wheel_radius
        laws[f"drive_{leg}"] = SpeedTrapezoid(speed=speed, begins=begins, accelerates=RAMP, decelerates=RAMP, ends=ends)
    return Actuators(laws=laws)


def _circle(design: RoverDesign) -> FloatArray:
    """Corners of the square about the circle of the outermost wheels."""
    reach = max(abs(distance) for _, distance in tangents(design).values())
    return np.array(_centre(design)) + reach * np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])


def _judge(run: ScenarioRun) -> tuple[Outcome, ...]:
    R = run.motion.rotations[:, 0]
    yaw = np.unwrap(np.arctan2(R[:, 1, 0], R[:, 0, 0]))
    arm = np.array([*_centre(run.design), 0.0]) - run.design.bodies[0].position
    centre = (run.place + R @ arm)[:, :2]
    wander = float(np.linalg.norm(centre - centre[0], axis=1).max())
    turned, asked = math.degrees(yaw[-1] - yaw[0]), math.degrees(ANGLE)
    return (
        Outcome(quantity="angle turned", value=turned, unit="deg", reference=asked, limit=(1.0 - ALLOWED_LAG) * asked),
        Outcome(quantity="wander of the centre", value=wander, unit="m", limit=ALLOWED_WANDER, at_least=False),
        *stated(run),
    )


POINT_TURN = Scenario(
    name="point_turn",
    title="quarter turn on the spot: steering to the tangents, then all wheels driven",
    source="mission requirements, section 1",
    lasts=100.0,
    every=0.2,
    actuators=turn_actuators,
    path=_circle,
    judge=_judge,
)
