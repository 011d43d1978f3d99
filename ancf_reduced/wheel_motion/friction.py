"""Friction of the ground on the points of a wheel that are under pressure.

Newton's method on a force that saturates overshoots. As in total variation (Chan, Golub & Mulet, SIAM J. Sci. Comput.
20, 1999, from memory) the direction of the pull, w with |w| <= 1, is an unknown of its own: of w sqrt(v^2 + v_0^2) = v,
linearised, the step follows with the viscosity mu N (I - w tau^T) / sqrt(v^2 + v_0^2), tau = v / sqrt(v^2 + v_0^2),
which is Newton's where w = tau and never negative. N is that of the step itself: the ground's force leans by -mu tau.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, hstack

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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rubbing:
    """Friction at points under pressure.

    Attributes
    ----------
    points : where
    velocity : of the points over the ground (n, 3) [m/s], in the hub's frame
    size : sqrt(v^2 + v_0^2) (n,) [m/s]
    pull : w, against which the ground pulls (n, 3) [-]
    lean : force of the ground on the wheel along the ground, of a unit of pressure (n, 3)
    viscosity : minus the force's derivative by the velocity at constant pressure (n, 3, 3) [N s/m], or more
    """

    points: Pressed
    velocity: Array
    size: Array
    pull: Array
    lean: Array
    viscosity: Array

    @classmethod
    def of(cls, friction: Friction, points: Pressed, v: Array, pull: Array | None = None) -> Rubbing:
        """At rates v (n_free + 3,); the pull of the Newton step before, or that of these rates."""
        N, normals = points.force, points.normals
        velocity = (points.slopes @ v[:-HUB]).reshape(-1, 3) + points.ways @ v[-HUB:]
        across = velocity - (velocity * normals).sum(axis=1)[:, None] * normals
        size = np.sqrt((across**2).sum(axis=1) + friction.slip_velocity**2)
        tau = across / size[:, None]
        mu = friction.coefficient
        w = tau if pull is None else pull
        both = w[:, :, None] * tau[:, None, :]
        P = np.eye(3) - normals[:, :, None] * normals[:, None, :] - 0.5 * (both + np.swapaxes(both, 1, 2))
        viscosity = (mu * N / size)[:, None, None] * P
        return cls(points=points, velocity=velocity, size=size, pull=w, lean=-mu * tau, viscosity=viscosity)

    @property
    def force(self) -> Array:
        """On the wheel (n, 3) [N]."""
        return self.points.force[:, None] * self.lean

    @property
    def power(self) -> float:
        """Dissipated [W], >= 0."""
        return -float((self.force * self.velocity).sum())

    def after(self, rates: Array) -> Array:
        """The pull (n, 3) after a step that changes the rates by (n_free + 3,)."""
        change = (self.points.slopes @ rates[:-HUB]).reshape(-1, 3) + self.points.ways @ rates[-HUB:]
        normals = self.points.normals
        velocity, change = (x - (x * normals).sum(axis=1)[:, None] * normals for x in (self.velocity, change))
        along = (velocity * change).sum(axis=1) / self.size
        w = (velocity + change - self.pull * along[:, None]) / self.size[:, None]
        return np.asarray(w / np.maximum(1.0, np.linalg.norm(w, axis=1))[:, None])

    def leaning(self, rows: NDArray[np.int64], count: int) -> csr_array:
        """What a unit of pressure does along the ground at each of ``count`` contacts, these in ``rows``."""
        n = len(rows)
        starts = np.zeros(count + 1, dtype=np.int64)
        starts[rows + 1] = 3
        shape, starts = (count, 3 * n), np.cumsum(starts)
        lean = csr_array((self.lean.ravel(), np.arange(3 * n), starts), shape=shape)
        hub = np.zeros((count, HUB))
        hub[rows] = np.einsum("pi,pik->pk", self.lean, self.points.ways)
        return csr_array(hstack([lean @ self.points.slopes, csr_array(hub)]))

    def by_rate(self) -> tuple[csr_array, Array]:
        """Minus the derivative of the forces on all coordinates by their rates, a `BorderedMatrix`."""
        J, ways = self.points.slopes, self.points.ways
        wide = (self.viscosity @ ways).reshape(-1, HUB)
        corner = np.einsum("pik,pil->kl", ways, wide.reshape(-1, 3, HUB))
        return csr_array(congruent(J, self.viscosity)), np.concatenate([J.T @ wide, corner])
