"""Motors on joints, compiled: their torques, and how these fall with speed. Numbers and equations: `motors`.

Verified by tests/verification/test_motor_drives.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled
from rover_dynamics.vehicle.motors import ASKED, BRAKED, GAIN, JointMotor

__all__ = ["MotorNumbers", "add_motor_torques", "motor_numbers"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class MotorNumbers(NamedTuple):
    """Motors for the compiled calls.

    Attributes
    ----------
    places : (n,) int, their joints' velocities
    rows : (n, 3) float, torque limit [N m], stall torque [N m], no-load speed [rad/s], the first two at the wheel
    """

    places: IntArray
    rows: FloatArray


def motor_numbers(places: IntArray, motors: tuple[JointMotor, ...]) -> MotorNumbers:
    """Motors on the joint velocities ``places``."""
    rows = [
        (m.efficiency * m.torque_limit, m.efficiency * m.stall_torque, m.no_load_speed)
        for m in (one.motor for one in motors)
    ]
    return MotorNumbers(places, np.array(rows, dtype=np.float64).reshape(-1, 3))


@compiled
def add_motor_torques(
    motors: MotorNumbers, asked: FloatArray, v: FloatArray, tau: FloatArray, slopes: FloatArray
) -> bool:
    """Add the motors' torques to the joint efforts, and write how they fall with speed.

    Parameters
    ----------
    asked : (n, 3) float, columns `ASKED`, `GAIN`, `BRAKED`
    v : (n_v,) float, joint velocities [rad/s]
    tau : (n_v,) float, added to [N m]
    slopes : (n,) float, -dT/dv [N m s/rad], overwritten

    Returns
    -------
    Whether a slope is another one than before.
    """
    changed = False
    for i in range(len(motors.places)):
        speed = v[motors.places[i]]
        gain = asked[i, GAIN]
        torque, slope = gain * (asked[i, ASKED] - speed), gain
        if asked[i, BRAKED] == 0.0:
            limit, stall, no_load = motors.rows[i, 0], motors.rows[i, 1], motors.rows[i, 2]
            fall = stall / no_load if no_load < np.inf else 0.0
            top, bottom = min(limit, stall - fall * speed), -min(limit, stall + fall * speed)
            if torque > top:
                torque, slope = max(top, -limit), fall if top < limit else 0.0
            elif torque < bottom:
                torque, slope = min(bottom, limit), fall if bottom > -limit else 0.0
        tau[motors.places[i]] += torque
        changed = changed or slope != slopes[i]
        slopes[i] = slope
    return changed
