"""The generalised-alpha method for a tree of links: coefficients, and positions and velocities at a step's end.

The method (Chung and Hulbert 1993; Arnold and Bruels 2007; in joint coordinates: quaternions are turned by rotation
vectors) has accelerations A of its own beside the accelerations a of the equations of motion:

    step = dt v_n + dt^2 (1/2 - beta) A_n + dt^2 beta A,    v = v_n + dt (1 - gamma) A_n + dt gamma A
    (1 - alpha_m) A + alpha_m A_n = (1 - alpha_f) a + alpha_f a_n

A_n belongs to the time t_n + (alpha_m - alpha_f) dt, so that a step of another length needs A_n moved to its own
(`rescaled_rates`): without it the order falls to one where the step changes (Bruels and Arnold 2008).

Verified by tests/verification/test_multibody_implicit.py and tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled, cross
from rover_dynamics.multibody.tree_kernels import LinkKind, Tree, advance, tree_motion

__all__ = ["Method", "damped_newmark", "generalised_alpha", "newmark", "rescaled_rates", "step_frames"]

FloatArray = NDArray[np.float64]

_SPHERICAL = int(LinkKind.SPHERICAL)


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

    def weights(self, dt: float) -> tuple[float, float, float]:
        """Derivatives by the method's accelerations of the true ones [-], of the rates [s] and of the step [s^2]."""
        return (1.0 - self.alpha_m) / (1.0 - self.alpha_f), dt * self.gamma, dt * dt * self.beta


def generalised_alpha(spectral_radius: float, tolerance: float, iterations: int) -> Method:
    """Coefficients of order two for a spectral radius at infinity [-] (Chung and Hulbert 1993, eqs 17, 20 and 25).

    ``tolerance`` [m, rad] and ``iterations`` are those of `Method`.
    """
    rho = spectral_radius
    alpha_m, alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 - alpha_m + alpha_f
    beta = 0.25 * (gamma + 0.5) ** 2
    error = abs(beta - 1.0 / 6.0 + 0.5 * (alpha_m - alpha_f))
    return Method(alpha_m, alpha_f, beta, gamma, error, tolerance, iterations)


def damped_newmark(tolerance: float, iterations: int) -> Method:
    """Newmark's method with beta = gamma = 1: order one, every frequency damped; for settling, not for motions.

    The highest frequencies lose a factor of sqrt(2) a step: roots of x^2 - x/2 + 1/2.
    Verified by tests/unit/test_newmark_damping.py.

    ``tolerance`` [m, rad] and ``iterations`` are those of `Method`.
    """
    return Method(0.0, 0.0, 1.0, 1.0, 0.0, tolerance, iterations)


def rescaled_rates(a: FloatArray, A: FloatArray, ratio: float) -> FloatArray:
    """A, of a's shape and unit, at the time that belongs to a next step ``ratio`` [-] times as long as the last one."""
    return a + ratio * (A - a)


@compiled
def step_frames(tree: Tree, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Joint frames, (n_l, 3, 3), and the factor of dt^2 in the step, (n_v,), where frames turn with their carriers.

    The rate of F^T w is F^T (w' - W x w), with W the carrier's angular velocity, and not F^T w'. Only ball joints have
    such frames: free links hang on the ground, and hinges and sliders need none.
    """
    turning = np.zeros_like(v)
    if not np.any(tree.kinds == _SPHERICAL):
        return tree.turns, turning
    motion = tree_motion(tree, q, v)
    for k in range(len(tree.parents)):
        if tree.kinds[k] == _SPHERICAL:
            at = tree.v_at[k]
            cross(-0.5 * motion.V[tree.parents[k], :3], v[at : at + 3], turning[at : at + 3])
    return motion.frames, turning


@compiled
def newmark(
    tree: Tree,
    before: tuple[FloatArray, FloatArray, FloatArray],
    A: FloatArray,
    start: tuple[FloatArray, FloatArray],
    step_of: tuple[float, Method],
) -> tuple[FloatArray, FloatArray]:
    """Coordinates and velocities at the end of a step.

    Parameters
    ----------
    before : q, v and A where the step starts
    A : (n_v,) float, the method's accelerations at its end
    start : what `step_frames` returns
    step_of : length [s], method
    """
    q, v, A_n = before
    frames, turning = start
    dt, method = step_of
    beta, gamma = method.beta, method.gamma
    step = dt * v + dt * dt * ((0.5 - beta) * A_n + beta * A) + dt * dt * turning
    return advance(tree, q, step, frames), v + dt * ((1.0 - gamma) * A_n + gamma * A)
