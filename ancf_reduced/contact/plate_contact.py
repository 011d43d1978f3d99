"""Contact of a mesh of plates with terrain: forces, exact tangents, power and contact patch (thesis 2.21, 2.22).

Coordinates are in the world frame, z up. The force is that of the ground on the tire, an external force; tangents are
minus its derivatives, so that they add to those of the elastic and damping forces.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.grid import ContactGrid
from ancf_reduced.contact.kernels import contact_force_kernel, contact_record_kernel, contact_tangent_kernel
from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.search import Constants
from contracts.errors import InputError
from contracts.terrain import TerrainPieces

__all__ = ["ContactNormal", "ContactPatch", "ContactPower", "PlateContact"]

FloatArray = NDArray[np.float64]


class ContactNormal(StrEnum):
    """Whose normal the force of a point has."""

    TERRAIN = "terrain"
    """The ground's: the force then has a potential, and follows every shape of the ground."""
    SURFACE = "surface"
    """The tire's, r_x1 x r_x2 / |r_x1 x r_x2| turned inwards (thesis 2.22); a face turned away from the ground is not
    pressed. Has no potential: it gives and takes energy where both normals differ."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactPower:
    """Energy account of contact at one instant.

    Attributes
    ----------
    energy : stored in the penalty [J]
    damping, friction : dissipated by normal damping and by friction, >= 0 [W]
    power : of all contact forces on the tire [W]; -d(energy)/dt - damping - friction with the terrain's normal
    """

    energy: float
    damping: float
    friction: float
    power: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactPatch:
    """The points that touch; a point pressed by two pieces of terrain counts twice.

    Attributes
    ----------
    plates, points : (n,) int, plate and point on it
    position : (n, 3) float [m], world frame
    penetration : (n,) float [m], delta > 0
    normal : (n, 3) float [-], towards the tire
    normal_force : (n,) float [N], >= 0
    force : (n, 3) float [N], ground on tire, friction included
    slip : (n, 3) float [m/s], velocity of the point along the ground
    area : (n,) float [m^2], part of the tire's face that the point stands for

    Verified by tests/unit/test_ancf_plate_contact.py.
    """

    plates: NDArray[np.int64]
    points: NDArray[np.int64]
    position: FloatArray
    penetration: FloatArray
    normal: FloatArray
    normal_force: FloatArray
    force: FloatArray
    slip: FloatArray
    area: FloatArray

    @property
    def pressure(self) -> FloatArray:
        """Normal force over area, (n,) float [Pa]."""
        return self.normal_force / self.area

    @property
    def load(self) -> float:
        """Sum of the normal forces [N]."""
        return float(self.normal_force.sum())

    @property
    def resultant(self) -> FloatArray:
        """Force of the ground on the tire, (3,) float [N]."""
        return np.asarray(self.force.sum(axis=0))

    def moment(self, about: FloatArray) -> FloatArray:
        """Moment (3,) float [N m] of the ground on the tire about a point (3,) [m]."""
        return np.asarray(np.cross(self.position - about, self.force).sum(axis=0))

    def length(self, direction: FloatArray) -> float:
        """Extent of the pressed points along a unit vector (3,) [m]; 0 without contact."""
        pressed = self.position[self.normal_force > 0.0] @ direction
        return float(np.ptp(pressed)) if len(pressed) else 0.0

    @property
    def total_area(self) -> float:
        """Area of the pressed points [m^2]."""
        return float(self.area[self.normal_force > 0.0].sum())

    @property
    def penetration_max(self) -> float:
        """Largest penetration of a point [m]; 0 without contact."""
        return float(self.penetration.max(initial=0.0))

    @property
    def penetration_mean(self) -> float:
        """Load-weighted mean penetration, sum N delta / sum N [m]; 0 without contact."""
        return float(self.normal_force @ self.penetration / self.load) if self.load > 0.0 else 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateContact:
    """Contact points of a mesh, the ground below them and what they feel; an external force of `plate_system`.

    Attributes
    ----------
    grid : points on the plates
    terrain : from a terrain's ``pieces()``
    law : penalty, damping, friction
    normal : the terrain's, or the tire's as in the thesis
    coarse_search : passes over plates whose box is clear of the ground; changes the time and nothing else
    constants : all of this for the compiled loops

    Raises
    ------
    InputError
        By all methods, if a point touches the ground beside a height field.

    Verified by tests/unit/test_ancf_plate_contact.py and tests/verification/test_ancf_contact.py.
    """

    grid: ContactGrid
    terrain: TerrainPieces
    law: ContactLaw
    normal: ContactNormal = ContactNormal.TERRAIN
    coarse_search: bool = True
    constants: Constants = field(init=False, repr=False)

    def __post_init__(self) -> None:
        tables = tuple(self.grid.tables), tuple(self.terrain), tuple(self.law.numbers)
        object.__setattr__(self, "constants", (*tables, self.normal is ContactNormal.SURFACE))

    @property
    def depends_on_rates(self) -> bool:
        """Whether there is damping or friction."""
        return self.law.is_damped or self.law.friction > 0.0

    def force(self, p: FloatArray, v: FloatArray, time: float = 0.0, out: FloatArray | None = None) -> FloatArray:
        """Generalised force of the ground on the mesh.

        Parameters
        ----------
        p, v : (n_nodes, 4, 3) float, structure coordinates [m, -] and rates [m/s, 1/s], world frame
        time : not used: the ground is at rest
        out : array to write to, so that nothing of the mesh's size is allocated

        Returns
        -------
        force : (n_nodes, 4, 3) float [N, N m]
        """
        force = np.empty_like(p) if out is None else out
        self._evaluate(p, v, force)
        return force

    def power(self, p: FloatArray, v: FloatArray) -> ContactPower:
        """Energy account [J, W]; p, v (n_nodes, 4, 3) as `force`."""
        _, energy, damping, friction, power = self._evaluate(p, v, np.empty_like(p))
        return ContactPower(energy=energy, damping=damping, friction=friction, power=power)

    def tangents(
        self, p: FloatArray, v: FloatArray, time: float = 0.0, out: FloatArray | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Minus the exact derivatives of the force by coordinates and by rates (points that switch excepted).

        Parameters
        ----------
        p, v, time : as `force`
        out : (2, n_plates, 48, 48) float, array to write to

        Returns
        -------
        by_position, by_rate : (n_plates, 48, 48) float [N/m, N, N m] and [N s/m, ...], for `plates.assembly`; symmetric
            with the terrain's normal, no friction and no damping
        """
        both = np.empty((2, self.grid.n_plates, 48, 48)) if out is None else out
        _check(contact_tangent_kernel(p, v, self.constants, both[0], both[1]))
        return both[0], both[1]

    def patch(self, p: FloatArray, v: FloatArray) -> ContactPatch:
        """The points that touch, for output, in the world frame; p, v (n_nodes, 4, 3) as `force`."""
        carriers, points = self.grid.tables.interpolation.shape[:2]
        capacity = carriers * points * len(self.terrain.rows)
        where, record = np.empty((capacity, 2), dtype=np.int64), np.empty((capacity, 14))
        count = _check(contact_record_kernel(p, v, self.constants, where, record))
        carrier, point = where[:count].T
        record = record[:count]
        return ContactPatch(
            plates=self.grid.tables.plates[carrier],
            points=point,
            penetration=record[:, 0],
            normal_force=record[:, 1],
            position=record[:, 2:5],
            force=record[:, 5:8],
            slip=record[:, 8:11],
            normal=record[:, 11:14],
            area=self.grid.areas(p, carrier, point),
        )

    def _evaluate(self, p: FloatArray, v: FloatArray, force: FloatArray) -> tuple[int, float, float, float, float]:
        account = contact_force_kernel(p, v, self.constants, self.coarse_search, force)
        _check(account[0])
        return account


def _check(count: int) -> int:
    """The count of a kernel; raises InputError where it says that points lie beside a height field."""
    if count < 0:
        rule = "touch the ground beside the height field"
        raise InputError("contact points", -1 - count, rule, "give a field that covers the tire's path")
    return count
