"""Equilibrium of a tire with a held reference node against a plane: residual, exact tangent, one Newton solve."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import ContactPatch, PlateContact
from ancf_reduced.motion.equilibrium import NewtonControls, NewtonResult, newton_solve
from ancf_reduced.motion.reference_node import rigid_reference_node
from ancf_reduced.plates.assembly import dense_matrix
from ancf_reduced.tire.mesh import Tire
from contracts.terrain import Plane

__all__ = ["PlaneProblem"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneProblem:
    """Free coordinates of a tire whose reference node is held at the hub centre, against a frictionless plane.

    Attributes
    ----------
    tire : constant data
    direction : (3,) float [-], from the hub to the ground, wheel frame

    Verified by tests/unit/test_ancf_plane_problem.py (finite differences) and tests/unit/test_ancf_static_tire.py.
    """

    tire: Tire
    direction: FloatArray

    @property
    def hub(self) -> FloatArray:
        """The held reference node's coordinates, (4, 3)."""
        return rigid_reference_node(self.tire.tie.origin, np.eye(3))

    def expand(self, x: FloatArray) -> FloatArray:
        """Node coordinates (n_nodes, 4, 3) from the free ones, flat."""
        return self.tire.tie.expand(x.reshape(-1, 4, 3), self.hub)

    def contact(self, deflection: float) -> PlateContact:
        """Contact points on the plane at zero radius - deflection [m] from the hub, without friction and damping."""
        x, y, z = (-self.direction).tolist()
        plane = Plane(normal=(x, y, z), offset=deflection - self.tire.preset.zero_radius)
        law = ContactLaw(stiffness=self.tire.preset.contact_stiffness)
        return PlateContact(grid=self.tire.grid, terrain=plane.pieces(), law=law)

    def contact_force(self, p: FloatArray, deflection: float) -> FloatArray:
        """Generalised force (n_nodes, 4, 3) of the plane on the tire."""
        return self.contact(deflection).force(p, np.zeros_like(p))

    def patch(self, p: FloatArray, deflection: float) -> ContactPatch:
        """The points that touch at coordinates p (n_nodes, 4, 3) and a deflection [m], wheel frame."""
        return self.contact(deflection).patch(p, np.zeros_like(p))

    def residual(self, x: FloatArray, deflection: float) -> tuple[FloatArray, float]:
        """Elastic minus contact force (12 n_free,), gradient rows divided by t, and its scale: all in newtons.

        At x (12 n_free,) [m, -] and a deflection [m]. The scale is the largest contact force component, and at least
        1e-4 E t w (so that the dead zone has one).
        """
        preset, p = self.tire.preset, self.expand(x)
        contact, free = self.contact_force(p, deflection), self.tire.tie.free
        unit = np.array([1.0, *[1.0 / preset.rim_thickness] * 3])[:, None]
        floor = 1e-4 * preset.young_modulus * preset.rim_thickness * preset.width
        out_of_balance = (self.tire.model.elastic_force(p) - contact)[free] * unit
        return out_of_balance.ravel(), max(float(np.abs(contact[free] * unit).max()), floor)

    def tangent(self, x: FloatArray, deflection: float) -> FloatArray:
        """Exact derivative (12 n_free, 12 n_free) [N/m, N] of `residual` by x (contact points that switch excepted)."""
        preset, p = self.tire.preset, self.expand(x)
        contact = self.contact(deflection).tangents(p, np.zeros_like(p))[0]
        rows = (12 * self.tire.tie.free[:, None] + np.arange(12)).ravel()
        unit = np.tile([1.0] * 3 + [1.0 / preset.rim_thickness] * 9, len(self.tire.tie.free))
        tangent = dense_matrix(self.tire.mesh, self.tire.model.elastic_tangents(p) + contact)
        return np.asarray(tangent[np.ix_(rows, rows)] * unit[:, None])

    def solve(self, deflection: float, start: FloatArray, controls: NewtonControls) -> NewtonResult:
        """Newton at one deflection [m] from x (12 n_free,); a result with an inverted plate counts as not converged."""
        result = newton_solve(
            lambda x: self.residual(x, deflection), lambda x: self.tangent(x, deflection), start, controls
        )
        if result.converged and self.tire.model.volume_ratio(self.expand(result.x)).min() <= 0.0:
            reason = "a plate is inverted, det F <= 0: beyond what St. Venant-Kirchhoff can carry"
            return replace(result, converged=False, reason=reason)
        return result
