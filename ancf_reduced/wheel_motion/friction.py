"""Friction of the ground on the points of a wheel that are under pressure.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ancf_reduced.wheel.rubbing import congruent
from ancf_reduced.wheel_motion.bordered import HUB
from contracts.errors import InputError

__all__ = ["Friction", "Rubbing"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Friction:
    """Coulomb's friction on the ground, smoothed: mu N v / sqrt(v^2 + v_0^2) against a slip velocity v.

    Attributes
    ----------
    coefficient : mu [-]
    slip_velocity : v_0 [m/s]
    """

    coefficient: float = 0.0
    slip_velocity: float = 1e-3

    def __post_init__(self) -> None:
        if not (np.isfinite(self.coefficient) and self.coefficient >= 0.0):
            raise InputError("friction coefficient", f"{self.coefficient:g}", "must be >= 0", "0 is without friction")
        if not (np.isfinite(self.slip_velocity) and self.slip_velocity > 0.0):
            raise InputError("slip velocity", f"{self.slip_velocity:g} m/s", "must be > 0", "1e-3 m/s is usual")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pressed:
    """Points under pressure.

    Attributes
    ----------
    force : of the ground along its normal (n,) [N]
    normals : of the ground, in the hub's frame (n, 3)
    slopes : derivatives of their places by the plates' coordinates (3 n, n_free)
    ways : by the hub's (n, 3, 3)
    """

    force: Array
    normals: Array
    slopes: csr_array
    ways: Array

    def forces(self, force: Array) -> Array:
        """What forces (n, 3) [N] at the points, in the hub's frame, do on all coordinates (n_free + 3,)."""
        return np.concatenate([self.slopes.T @ force.ravel(), np.einsum("pi,pik->k", force, self.ways)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rubbing:
    """Friction at points under pressure.

    Attributes
    ----------
    points : where
    velocity : of the points over the ground (n, 3) [m/s], in the hub's frame
    force : on the wheel (n, 3) [N]
    viscosity : minus its derivative by the velocity at constant pressure (n, 3, 3) [N s/m]
    """

    points: Pressed
    velocity: Array
    force: Array
    viscosity: Array

    @classmethod
    def of(cls, friction: Friction, points: Pressed, v: Array) -> Rubbing:
        """At rates v (n_free + 3,)."""
        N, normals = points.force, points.normals
        velocity = (points.slopes @ v[:-HUB]).reshape(-1, 3) + points.ways @ v[-HUB:]
        across = velocity - (velocity * normals).sum(axis=1)[:, None] * normals
        size = np.sqrt((across**2).sum(axis=1) + friction.slip_velocity**2)
        tau = across / size[:, None]
        mu = friction.coefficient
        P = np.eye(3) - normals[:, :, None] * normals[:, None, :] - tau[:, :, None] * tau[:, None, :]
        force, viscosity = -mu * N[:, None] * tau, (mu * N / size)[:, None, None] * P
        return cls(points=points, velocity=velocity, force=force, viscosity=viscosity)

    @property
    def power(self) -> float:
        """Dissipated [W], >= 0."""
        return -float((self.force * self.velocity).sum())

    def by_rate(self) -> tuple[csr_array, Array]:
        """Minus the derivative of the forces on all coordinates by their rates, a `BorderedMatrix`."""
        J, ways = self.points.slopes, self.points.ways
        wide = (self.viscosity @ ways).reshape(-1, HUB)
        corner = np.einsum("pik,pil->kl", ways, wide.reshape(-1, 3, HUB))
        return csr_array(congruent(J, self.viscosity)), np.concatenate([J.T @ wide, corner])
