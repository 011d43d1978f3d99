"""Coefficients of the generalised-alpha method, and what it carries from step to step.

The method is written down in `rover_dynamics.vehicle.implicit_kernels`.

A_n belongs to the time t_n + (alpha_m - alpha_f) dt, so that a step of another length needs A_n moved to its own
(`rescaled`): without it the order falls to one where the step changes (Bruels and Arnold 2008).

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Known", "Method", "Moment", "generalised_alpha", "implicit_euler", "rescaled"]

FloatArray = NDArray[np.float64]


class Method(NamedTuple):
    """Coefficients of the generalised-alpha method, and when its iteration ends.

    Attributes
    ----------
    alpha_m, alpha_f, beta, gamma : [-]
    error : factor of dt^2 max |A - A_n| in the local error of the coordinates, dt^3 q''' (beta - 1/6 + (alpha_m -
        alpha_f) / 2) [-]
    tolerance : largest dt^2 times the change of A in the last iteration [m, rad]
    iterations : at most
    """

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    error: float
    tolerance: float
    iterations: int


def generalised_alpha(spectral_radius: float, tolerance: float, iterations: int) -> Method:
    """Coefficients of order two for a spectral radius at infinity (Chung and Hulbert 1993, eqs 17, 20 and 25)."""
    rho = spectral_radius
    alpha_m, alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 - alpha_m + alpha_f
    beta = 0.25 * (gamma + 0.5) ** 2
    error = abs(beta - 1.0 / 6.0 + 0.5 * (alpha_m - alpha_f))
    return Method(alpha_m, alpha_f, beta, gamma, error, tolerance, iterations)


def implicit_euler(tolerance: float, iterations: int) -> Method:
    """The implicit Euler method as coefficients: order one, damps every frequency; for settling, not for motions."""
    return Method(0.0, 0.0, 1.0, 1.0, 0.0, tolerance, iterations)


class Known(NamedTuple):
    """What is prescribed at the end of a step.

    Attributes
    ----------
    q, v, a : (n_d,) float, coordinates, velocities and accelerations of the driven joints
    tau : (n_v,) float, joint efforts [N m, N]
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    tau: FloatArray


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
    """The moment with A and B at the time that belongs to a next step ``ratio`` times as long as the last one."""
    A = moment.a + ratio * (moment.A - moment.a)
    return moment._replace(A=A, B=moment.s_rate + ratio * (moment.B - moment.s_rate))
