"""What a vehicle knows of flexible tires with a mass of their own: one system of vectors, a reference node on each hub.

The other way to a tire is `contracts.tire.Tire`, whose wrench does not know the hub's acceleration. Here the tires'
inertia couples with the wheels', so that both are solved together (thesis eqs 2.20 and 2.26). All tires are equal:
each has n vectors (positions and position gradients) in the world frame, the last four those of its reference node,
(r, r_x, r_y, r_z), which moves with the wheel's body. Arrays of all tires are (n_wheels, n, 3).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["NodalTires", "TireContacts", "TireEnergies"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class TireContacts:
    """What the ground does to each wheel at one instant.

    Attributes
    ----------
    force : (n_wheels, 3) float [N], sum of the contact forces on each tire, world
    moment : (n_wheels, 3) float [N m], of these about each hub centre
    load : (n_wheels,) float [N], sum of the normal forces
    patch_point : (n_wheels, 3) float [m], load-weighted centre of the contacts; the hub centre in the air
    penetration : (n_wheels,) float [m], load-weighted mean depth of the points that touch
    largest_pressure : (n_wheels,) float [Pa]
    slip : (n_wheels, 2) float [m/s], load-weighted mean of the slip's size, and its largest
    """

    force: FloatArray
    moment: FloatArray
    load: FloatArray
    patch_point: FloatArray
    penetration: FloatArray
    largest_pressure: FloatArray
    slip: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class TireEnergies:
    """Energy account of all tires together at one instant.

    Attributes
    ----------
    kinetic, strain, contact : stored [J]; ``contact`` is that of the penalty
    damping, contact_damping, friction : dissipated [W], >= 0
    """

    kinetic: float
    strain: float
    contact: float
    damping: float
    contact_damping: float
    friction: float


class NodalTires(Protocol):
    """Equal flexible tires on one terrain.

    Attributes
    ----------
    n_wheels : tires
    mass : (n, n) float [kg, kg m, kg m^2] of each tire, the same for each direction, constant
    weight : (n,) float [kg, kg m], so that gravity's force on a tire is weight[:, None] * g
    position_rows : (n_positions,) int, rows of a tire's vectors that are positions, increasing
    pattern : (n_blocks, 2) int, row and column vector of each 3 x 3 block that a tangent may have
    """

    @property
    def n_wheels(self) -> int:
        """See the class."""

    @property
    def mass(self) -> FloatArray:
        """(n, n) [kg, kg m, kg m^2], see the class."""

    @property
    def weight(self) -> FloatArray:
        """(n,) [kg, kg m], see the class."""

    @property
    def position_rows(self) -> IntArray:
        """(n_positions,) int, see the class."""

    @property
    def pattern(self) -> IntArray:
        """(n_blocks, 2) int, see the class."""

    def reference(self) -> FloatArray:
        """Vectors (n, 3) of a stress-free tire in the wheel frame, x forward, y along the axle, hub centre at 0."""

    def force(self, z: FloatArray, v: FloatArray) -> FloatArray:
        """Generalised forces (n_wheels, n, 3) of elasticity, damping and contact, without the weight.

        Parameters
        ----------
        z, v : (n_wheels, n, 3) float [m, -] and [m/s, 1/s]
        """

    def tangents(self, z: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Minus the derivatives of `force` by z and by v, (n_wheels, n_blocks, 3, 3) each, blocks as in `pattern`."""

    def step_matrix(self, z: FloatArray, v: FloatArray, weights: tuple[float, float]) -> FloatArray:
        """Their sum with these weights, blocks (n_wheels, n_blocks, 3, 3), for Newton's method of a time step.

        Terms of the first may be left out that are small where the tires deform slowly.
        """

    def contacts(self, z: FloatArray, v: FloatArray) -> TireContacts:
        """What the ground does to each wheel, for output; z, v (n_wheels, n, 3) as `force`."""

    def energies(self, z: FloatArray, v: FloatArray) -> TireEnergies:
        """The account [J, W] of all tires, for checks; z, v (n_wheels, n, 3) as `force`."""
