"""Motors on joints, compiled: their torques, and how these fall with speed. Numbers and equations: `motors`.

Verified by tests/verification/test_motor_drives.py.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled
from rover_dynamics.vehicle.motors import ASKED, BRAKED, GAIN, STANDS, JointMotor

__all__ = ["MotorNumbers", "add_motor_torques", "motor_numbers"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class MotorNumbers(NamedTuple):
    """Motors for the compiled calls.

    Attributes
    ----------
    places : (n,) int, their joints' velocities
    rows : (n, 4) float, torque limit, stall torque [N m], no-load speed [rad/s] and efficiency [-], see `Motor`
    """

    places: IntArray
    rows: FloatArray


def motor_numbers(places: IntArray, motors: tuple[JointMotor, ...]) -> MotorNumbers:
    """Motors on the joint velocities ``places``."""
    rows = [(m.torque_limit, m.stall_torque, m.no_load_speed, m.efficiency) for m in (one.motor for one in motors)]
    return MotorNumbers(places, np.array(rows, dtype=np.float64).reshape(-1, 4))


@compiled
def _most(row: FloatArray, speed: float, way: float) -> tuple[float, float]:
    """Torque at the wheel towards ``way``, 1 or -1, that a motor at full voltage gives [N m], and -dT/dv [N m s/rad].

    The torque is negative where the wheel turns faster that way than the motor does without load.
    """
    limit, fall, inside = row[0], 0.0, np.inf
    if row[2] < np.inf:
        fall = row[1] / row[2]
        inside = row[1] - fall * way * speed
    if abs(inside) >= limit:
        inside, fall = math.copysign(limit, inside), 0.0
    if row[3] == 1.0:
        return way * inside, fall
    passes = math.tanh(math.copysign(way * speed / STANDS, inside * way * speed))
    share = row[3] ** passes
    turns = -abs(inside) * math.log(row[3]) * (1.0 - passes * passes) / STANDS
    return way * share * inside, share * (fall + turns)


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
            top, bottom = _most(motors.rows[i], speed, 1.0), _most(motors.rows[i], speed, -1.0)
            if torque > top[0]:
                torque, slope = top
            elif torque < bottom[0]:
                torque, slope = bottom
        tau[motors.places[i]] += torque
        changed = changed or slope != slopes[i]
        slopes[i] = slope
    return changed
