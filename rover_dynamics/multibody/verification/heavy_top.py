"""A symmetric top on a ball joint under its weight: the height of its centre of mass in closed form.

With u the cosine of the axis from the vertical and I the moment about the fixed point, across the axis, conservation of
energy and of the angular momenta about axis and vertical leaves

    u'^2 = (2 m g l / I) (u - u_1) (u - u_2) (u - u_3),   u_1 <= u <= u_2 <= 1 <= u_3

whose solution is a squared elliptic sine (Lagrange's top). Released with u = 0 and u' = 0, one of u_1 and u_2 is zero.
Derived here. Verified by
tests/verification/test_multibody_heavy_top.py, against `tree_coordinates`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipj, ellipk

from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.joint import spherical
from rover_dynamics.multibody.model import MultibodyModel

__all__ = ["HeavyTop"]

FloatArray = NDArray[np.float64]

_G = 9.81


@dataclass(frozen=True, slots=True, kw_only=True)
class HeavyTop:
    """A top whose axis is along y, horizontal, at the start.

    Attributes
    ----------
    mass : [kg]
    arm : from the fixed point to the centre of mass [m]
    along, across : moments of inertia about the centre of mass, along and across the axis [kg m^2]
    spin, precession : angular velocity at the start about the axis, and about the vertical [rad/s]
    """

    mass: float
    arm: float
    along: float
    across: float
    spin: float
    precession: float

    def model(self) -> MultibodyModel:
        """The top on its ball joint, weight along -z."""
        at, turning = np.array([0.0, self.arm, 0.0]), np.array([0.0, self.spin, self.precession])
        top = body(
            "top",
            self.mass,
            (self.across, self.along, self.across),
            tuple(at),
            velocity=tuple(np.cross(turning, at)),
            angular_velocity=tuple(turning),
        )
        return MultibodyModel(
            bodies=(top,), joints=(spherical("tip", "ground", top, at=(0, 0, 0)),), gravity=(0.0, 0.0, -_G)
        )

    def heights(self, times: FloatArray) -> FloatArray:
        """Height of the centre of mass over the fixed point at the times [s], (n,) [m]."""
        about_tip = self.across + self.mass * self.arm**2
        a, b, c = self.along * self.spin / about_tip, self.precession, 2.0 * self.mass * _G * self.arm / about_tip
        # u'^2 = (b^2 - c u)(1 - u^2) - (b - a u)^2 = u (c u^2 - (a^2 + b^2) u + 2 a b - c), as u = 0 at the start
        low, high = np.sort(np.roots([c, -(a * a + b * b), 2.0 * a * b - c]).real)
        first, second, third = np.sort([0.0, low, high])
        m, rate = (second - first) / (third - first), 0.5 * np.sqrt(c * (third - first))
        begins = 0.0 if first == 0.0 else ellipk(m)  # the squared sine starts from the lower end
        sn, _, _, _ = ellipj(rate * times + begins, m)
        return np.asarray(self.arm * (first + (second - first) * sn**2))
