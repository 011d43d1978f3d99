"""Drives with limits: motors on hinges, whose torque follows a speed as far as their line and their current allow.

At the output of its gear a direct-current motor gives, at full voltage, a torque that falls in a line from stall to the
speed without load, T_s (1 - v / v_0); its current limit bounds the torque by T_l. In between a controller asks for

    T = k (v_c - v),    -min(T_l, T_s (1 + v / v_0)) <= T <= min(T_l, T_s (1 - v / v_0)),

with the speed v_c that the joint's law gives at that time, lowered or raised by what `drive_control` makes of what it
saw at the end of the last step. A drive that is asked to stand is held by a brake: gain `BRAKE`, no limit, no current.

These are torques before the gear. Its efficiency counts in both directions of the power: a wheel that is driven gets
eta T of the motor's T, one that is held back or pushed backwards is held with T / eta, for the gear's friction brakes
with the motor. Between the two lies standing still, where the share goes over as eta^tanh(v / `STANDS`).

A motor of constant k_t and resistance R has T_s / v_0 = k_t^2 / R at its own shaft, so that it takes the electrical
power T (v + v_0 T / T_s): what it gives and what its windings lose. Inertia of the rotor, its friction, and that of a
gear that carries nothing are left out.

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

__all__ = [
    "ASKED",
    "BRAKE",
    "BRAKED",
    "GAIN",
    "STANDS",
    "JointMotor",
    "Motor",
    "electrical_power",
    "motor_torque",
    "used_of_limits",
]

FloatArray = NDArray[np.float64]
BRAKE = 1e5
"""Gain of a drive that stands [N m s/rad]: on 25 degrees it creeps by a hundredth of a millimetre a second."""
STANDS = 1e-3
"""Speed over which a gear goes over from giving back to giving [rad/s]; 70 m/h is 0.14 rad/s."""
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
    efficiency : eta, of the gear [-], in 0..1; torques and line above are those of a gear without loss

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

    def stands(self, t: float) -> bool:
        """Whether it is asked to stand at t [s], which a brake does."""
        return self.law.at(t)[1:] == (0.0, 0.0)


def motor_torque(motor: Motor, torque: FloatArray, speed: FloatArray) -> FloatArray:
    """Torques before the gear [N m], as a gear without loss would hand them on, of torques at the wheel [N m].

    Parameters
    ----------
    torque, speed : any shape; of the wheels [N m, rad/s]
    """
    return np.asarray(torque / motor.efficiency ** np.tanh(np.sign(torque) * speed / STANDS))


def used_of_limits(motor: Motor, torque: FloatArray, speed: FloatArray) -> FloatArray:
    """Torques over the most that current limit and line allow in their direction at these speeds [-], 0 without any."""
    line = np.full(np.shape(torque), math.inf)
    if math.isfinite(motor.stall_torque):
        line = motor.stall_torque * np.maximum(1.0 - np.sign(torque) * speed / motor.no_load_speed, 0.0)
    most = np.maximum(np.minimum(motor.torque_limit, line), np.finfo(np.float64).tiny)
    return np.asarray(np.abs(motor_torque(motor, torque, speed)) / most)


def electrical_power(motor: Motor, torque: FloatArray, speed: FloatArray) -> FloatArray:
    """What motors take [W] that give torques [N m] at speeds [rad/s] of the wheels; negative where they give back."""
    inside = motor_torque(motor, torque, speed)
    loss = motor.no_load_speed / motor.stall_torque if math.isfinite(motor.stall_torque) else 0.0
    return np.asarray(inside * (speed + loss * inside))
