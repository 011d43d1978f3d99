"""Drives with limits: motors on hinges, whose torque follows a speed as far as their line and their current allow.

At the output of its gear a direct-current motor gives, at full voltage, a torque that falls in a line from stall to the
speed without load, T_s (1 - v / v_0); its current limit bounds the torque by T_l. In between a controller asks for

    T = k (v_c - v),    -min(T_l, T_s (1 + v / v_0)) <= T <= min(T_l, T_s (1 - v / v_0)),

with the speed v_c that the joint's law gives at that time, lowered or raised by what `drive_control` makes of what it
saw at the end of the last step. A drive that is asked to stand is held by a brake: gain `BRAKE`, no limit.

A motor of constant k_t and resistance R has T_s / v_0 = k_t^2 / R at its own shaft, so that it takes the electrical
power T (v + v_0 T / T_s): what it gives and what its windings lose. An efficiency of the gear counts in both
directions of the power. Friction and inertia of the motor's rotor are left out.

Source: the line and the losses are those of the direct-current motor of textbooks (from memory).
Verified by tests/verification/test_motor_drives.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.motion_law import MotionLaw

__all__ = ["ASKED", "BRAKE", "BRAKED", "GAIN", "JointMotor", "Motor", "electrical_power"]

FloatArray = NDArray[np.float64]
BRAKE = 1e5
"""Gain of a drive that stands [N m s/rad]: on 25 degrees it creeps by a hundredth of a millimetre a second."""
ASKED, GAIN, BRAKED = 0, 1, 2
"""Columns of what is asked of motors: speed [rad/s], gain [N m s/rad], 1 for a brake."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Motor:
    """A motor with its gear, as its output shaft shows it.

    Attributes
    ----------
    torque_limit : T_l, what the current limit allows [N m]; infinite without one
    stall_torque, no_load_speed : T_s [N m], v_0 [rad/s], of the line; both infinite without one
    gain : k, of the speed controller [N m s/rad]
    efficiency : of the gear [-], in 0..1; lowers the torque given to the wheel, and that got back from it

    Raises
    ------
    InputError
        For a number that is not greater than zero, an efficiency above one, or a line with one end.
    """

    torque_limit: float = math.inf
    stall_torque: float = math.inf
    no_load_speed: float = math.inf
    gain: float = 1e4
    efficiency: float = 1.0

    def __post_init__(self) -> None:
        numbers = (
            ("torque limit of the drives", self.torque_limit, "N m"),
            ("stall torque of the drives", self.stall_torque, "N m"),
            ("no-load speed of the drives", self.no_load_speed, "rad/s"),
            ("gain of the drives", self.gain, "N m s/rad"),
            ("efficiency of the drives", self.efficiency, "-"),
        )
        for what, value, unit in numbers:
            if not value > 0.0:
                raise InputError(what, f"{value:g} {unit}", "must be > 0", "leave it out for none")
        if self.efficiency > 1.0:
            raise InputError("efficiency of the drives", f"{self.efficiency:g}", "must be <= 1", "give e.g. 0.6")
        if math.isinf(self.stall_torque) != math.isinf(self.no_load_speed):
            rule = "are the two ends of one line"
            raise InputError("stall torque and no-load speed of the drives", "one", rule, "give both, or none")


@dataclass(frozen=True, slots=True, kw_only=True)
class JointMotor:
    """A motor on a hinge that no drive moves; the rate of the law is the speed asked for [rad/s]."""

    joint: str
    motor: Motor
    law: MotionLaw


def electrical_power(motor: Motor, torque: FloatArray, speed: FloatArray) -> FloatArray:
    """What motors take [W] that give torques [N m] at speeds [rad/s] of the wheels; negative where they give back."""
    inside = torque / motor.efficiency ** np.sign(torque * speed)
    loss = motor.no_load_speed / motor.stall_torque if math.isfinite(motor.stall_torque) else 0.0
    return np.asarray(inside * (speed + loss * inside))
