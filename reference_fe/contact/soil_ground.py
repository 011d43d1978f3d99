"""Ground of soil that presses by its depth, as Bekker's plate has it: on the level area of what lies in it.

A point z deep feels k z^n dA_l upwards, dA_l the level part of its present area: below zero where the face looks up, as
a grouser's lee flank does, whose pocket of soil presses the rim above it as much upwards. All together is the area of
the hole in the surface; with n = 1 it is Archimedes' law. That part follows from the places of the facet's own points
and is put right between solves until it no longer moves the pressure by more than 1e-4, so that each solve has a
symmetric tangent. Verified by tests/verification/test_fe_soil.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.contact.facets import gauss_line
from reference_fe.contact.obstacle import ObstacleContact, ObstacleTerm
from reference_fe.contact.obstacles import Plane
from reference_fe.contact.surface_term import TermState
from reference_fe.problem.domain import Domain

__all__ = ["SoilContact", "SoilTerm"]

FloatArray = NDArray[np.float64]
_SETTLED = 1e-4
"""Change of the level share below which it is left [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SoilContact(ObstacleContact):
    """Contact with a plane of soil; the penalty's attributes are of no use to it.

    Attributes
    ----------
    modulus, exponent : k [N/m^(n+2)] and n of p = k z^n

    Raises
    ------
    InputError
        For numbers that are not above zero; with an obstacle, friction, multipliers or a travel.
    """

    modulus: float
    exponent: float

    def __post_init__(self) -> None:
        ObstacleContact.__post_init__(self)
        if not all(math.isfinite(one) and one > 0.0 for one in (self.modulus, self.exponent)):
            value = f"k = {self.modulus:g}, n = {self.exponent:g}"
            raise InputError("soil", value, "must have a modulus and an exponent above zero", "take a known soil")
        odd = not isinstance(self.obstacle, Plane), self.friction > 0.0, self.closes_gaps, self.travel is not None
        if any(odd):
            rule = "presses as a plane, without friction, by its depth alone"
            raise InputError("soil", "with an obstacle, friction, multipliers or a travel", rule, "leave them out")

    def build(self, domain: Domain, V: api.Expr, young_modulus: FloatArray | None = None) -> SoilTerm:
        """The term on a mesh."""
        return SoilTerm(self, domain, V, young_modulus)


class SoilTerm(ObstacleTerm):
    """Surface term of a `SoilContact`."""

    def __init__(self, contact: SoilContact, domain: Domain, V: api.Expr, young_modulus: FloatArray | None) -> None:
        super().__init__(contact, domain, V, young_modulus)
        self._soil = contact.modulus, contact.exponent
        self._slopes = _slopes(gauss_line(contact.gauss_points)[0])
        areas = self._areas(self._facets.positions)
        cells = domain.mesh.geometry.x[api.cell_nodes(domain.mesh)[self._facets.cells]][:, :, : areas.shape[2]]
        outwards = self._facets.positions.mean(axis=1) - cells.mean(axis=1)
        sense = np.sign(np.einsum("mi,mi->m", outwards, areas.mean(axis=1)))
        self._undeformed = sense[:, None] * np.linalg.norm(areas, axis=-1)
        self._level_share = self._share(self._facets.positions)

    def augment(self) -> bool:
        """Put the level shares right; whether that changes what the soil does."""
        share = self._share(self._last_x)
        pressed = self._out.gap.min(axis=-1) < 0.0
        moved = float(np.abs(share - self._level_share)[pressed].max(initial=0.0))
        if self._comm.allreduce(moved, op=api.MPI.MAX) <= _SETTLED:
            return False
        self._level_share = share
        return True

    def state(self) -> TermState:
        """Beside the obstacle's the level shares."""
        return {**super().state(), "level_share": self._level_share.copy()}

    def restore(self, state: TermState) -> None:
        """Go back to committed values."""
        super().restore(state)
        self._level_share = np.array(state["level_share"])

    def _share(self, x: FloatArray) -> FloatArray:
        """Level area over undeformed area at points (m, q, dim), positive where they look down."""
        return np.asarray(-(self._areas(x) @ self._normal) / self._undeformed)

    def _areas(self, x: FloatArray) -> FloatArray:
        """Area vectors (m, q, dim) per unit of the facet's own coordinates: its points lie on a grid of Gauss points,
        through which it is a polynomial.
        """
        n, dim = len(self._slopes), x.shape[2]
        if dim == 2:
            along = np.einsum("pq,mqi->mpi", self._slopes, x)
            return np.stack([-along[..., 1], along[..., 0]], axis=-1)
        grid = x.reshape(len(x), n, n, dim)
        first = np.einsum("pq,mqri->mpri", self._slopes, grid)
        second = np.einsum("pr,mqri->mqpi", self._slopes, grid)
        return np.cross(first, second).reshape(x.shape)


def _slopes(points: FloatArray) -> FloatArray:
    """Matrix (n, n) that takes values at points to the derivatives of the polynomial through them there."""
    vandermonde = np.vander(points, increasing=True)
    powers = np.arange(len(points))
    derivative = np.zeros_like(vandermonde)
    derivative[:, 1:] = powers[1:] * vandermonde[:, :-1]
    return np.asarray(derivative @ np.linalg.inv(vandermonde))
