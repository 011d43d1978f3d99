"""What the generalised-alpha method carries from step to step of a vehicle.

The method is written down in `rover_dynamics.multibody.generalised_alpha` and, with the tires' states, in
`rover_dynamics.vehicle.implicit_kernels`.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.generalised_alpha import rescaled_rates

__all__ = ["Known", "Moment", "rescaled"]

FloatArray = NDArray[np.float64]


class Known(NamedTuple):
    """What is prescribed at the end of a step.

    Attributes
    ----------
    q, v, a : (n_d,) float, coordinates, velocities and accelerations of the driven joints
    tau : (n_v,) float, joint efforts [N m, N]
    asked : (n_m, 3) float, of the motors, see `rover_dynamics.vehicle.motors.add_motor_torques`
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    tau: FloatArray
    asked: FloatArray


class Moment(NamedTuple):
    """Everything at one time that a step starts from.

    Attributes
    ----------
    q, v, a : (n_q,), (n_v,), (n_v,) float, coordinates, velocities, accelerations of the joints
    A : (n_v,) float, the method's accelerations
    s, s_rate, B : (n_w, n_s) float, states of the tires, their rates, the method's rates
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    A: FloatArray
    s: FloatArray
    s_rate: FloatArray
    B: FloatArray


def rescaled(moment: Moment, ratio: float) -> Moment:
    """The moment with A and B at the time that belongs to a next step ``ratio`` [-] times as long as the last one."""
    A, B = rescaled_rates(moment.a, moment.A, ratio), rescaled_rates(moment.s_rate, moment.B, ratio)
    return moment._replace(A=A, B=B)
