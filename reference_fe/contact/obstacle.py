"""Contact with a rigid obstacle that is raised against the body: description and surface term.

Virtual work int (p n + t) . v dA over the undeformed faces, with the pressure p and the tangential traction t of
`contact.law` at fixed quadrature points. Docs: docs/theory.md, section 2.4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.hub_travel import HubTravel
from reference_fe import dolfinx_api as api
from reference_fe.contact import kernels
from reference_fe.contact.facets import ContactFacets, gauss_line, local_stiffness, simpson_line
from reference_fe.contact.friction_energy import sliding_dissipation, slip_energy
from reference_fe.contact.obstacle_path import ObstaclePath, Place
from reference_fe.contact.obstacles import Obstacle, Plane, smallest_gap
from reference_fe.contact.surface_term import SurfaceForces, TermState
from reference_fe.problem.domain import Domain

__all__ = ["ContactMethod", "ObstacleContact", "ObstacleTerm", "moment_of"]


STIFFENING = 10.0
"""Ratio of the augmented Lagrangian's penalty stiffness to the given one, and its growth with each update."""


class ContactMethod(StrEnum):
    """How points are kept out of the obstacle."""

    PENALTY = "penalty"
    """Pressure in proportion to the penetration."""
    AUGMENTED_LAGRANGIAN = "augmented_lagrangian"
    """Multipliers at the points of contact, improved by Uzawa's update until the gap closes where there is pressure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ObstacleContact:
    """Contact of named faces with a rigid obstacle.

    The obstacle's profile stands on a ground whose unit normal n points to the body, at the distance
    ``distance_at_touch`` minus the control parameter from the origin along -n; its s axis is ``along``, s = 0 passes
    through the origin. Raised along another direction r than n, it moves by the control parameter along r.

    Attributes
    ----------
    faces : face names that may touch it
    normal : unit normal n of the ground, to the body, one component an axis of space [-]
    distance_at_touch : distance of the ground's level from the origin at control parameter 0 [m]
    obstacle : its shape
    along : unit vector of the profile's s axis in the ground [-]; None where it does not matter (plane)
    rise : unit direction of the obstacle's motion r [-]; None is n
    travel : what follows where the obstacle has risen enough; None: it rises on
    stiffness : penalty stiffness [N/m^3]; None takes `contact.facets.local_stiffness` on each facet
    ramp : gap below which the pressure begins, and above which (negative) it is linear [m]
    gauss_points : n Gauss points along each axis of a facet; the augmented Lagrangian takes 4 n - 3 evenly spaced
        points, edges included, as a facet is kept out only where there are points: where it bends by kappa relative to
        the obstacle, it dips in by up to kappa s^2 / 8 between points s apart
    method : penalty or augmented Lagrangian
    penetration_tolerance : largest depth, or gap under pressure, that the augmented Lagrangian leaves at a point [m];
        its ramp is at most twice that
    friction : Coulomb coefficient mu [-]
    stick_ratio : stiffness of sticking over penalty stiffness [-]: elastic slip before sliding is mu p / (ratio k)
    """

    faces: tuple[str, ...]
    normal: tuple[float, ...]
    distance_at_touch: float
    obstacle: Obstacle = field(default_factory=Plane)
    along: tuple[float, ...] | None = None
    rise: tuple[float, ...] | None = None
    travel: HubTravel | None = None
    stiffness: float | None = None
    ramp: float = 5e-6
    gauss_points: int = 5
    method: ContactMethod = ContactMethod.PENALTY
    penetration_tolerance: float = 5e-7
    friction: float = 0.0
    stick_ratio: float = 1.0

    def __post_init__(self) -> None:
        for what, vector in (("normal", self.normal), ("along", self.along), ("rise", self.rise)):
            if vector is not None and abs(math.hypot(*vector) - 1.0) > 1e-9:
                raise InputError(f"obstacle {what}", vector, "must have length 1", "normalise it")
        if self.along is not None and abs(np.dot(self.along, self.normal)) > 1e-9:
            raise InputError("obstacle along", self.along, "must be at right angles to the normal", "turn it")
        if self.rise is not None and np.dot(self.rise, self.normal) <= 0.0:
            raise InputError("obstacle rise", self.rise, "must point to the body, as the normal does", "flip it")
        if self.travel is not None and not isinstance(self.obstacle, Plane):
            rule = "must be a plane if the wheel is moved over it"
            raise InputError("obstacle", type(self.obstacle).__name__, rule, "leave out the travel")
        positive = {
            "contact stiffness": (self.stiffness, "N/m^3", "None takes it from the local stiffness"),
            "contact ramp": (self.ramp, "m", "5e-6 is usual"),
            "penetration tolerance": (self.penetration_tolerance, "m", "5e-7 is usual"),
            "stick ratio": (self.stick_ratio, "-", "1 is usual"),
        }
        for what, (value, unit, hint) in positive.items():
            if value is not None and not (math.isfinite(value) and value > 0.0):
                raise InputError(what, f"{value:g} {unit}", "must be > 0", hint)
        if not (math.isfinite(self.friction) and self.friction >= 0.0):
            raise InputError("friction coefficient", f"{self.friction:g}", "must be >= 0", "0 is without friction")

    @property
    def closes_gaps(self) -> bool:
        """Whether multipliers close the gaps that the penalty leaves."""
        return self.method is ContactMethod.AUGMENTED_LAGRANGIAN

    def path(self) -> ObstaclePath:
        """Where the obstacle is over the control parameter."""
        n, s, r = self.axes()
        return ObstaclePath(normal=n, along=s, rise=r, travel=self.travel)

    def axes(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Unit vectors n, s and r, (dim,) each [-]."""
        n = np.array(self.normal)
        s = np.zeros_like(n) if self.along is None else np.array(self.along)
        return n, s, n if self.rise is None else np.array(self.rise)

    def gap(self, points: NDArray[np.float64], control: float) -> NDArray[np.float64]:
        """Normal gap of points (n, dim) from the obstacle at a control parameter, (n,) [m], open > 0."""
        n, s, _ = self.axes()
        own = self.path().place(control).back(points)
        return np.asarray(smallest_gap(self.obstacle.pieces(), own @ s, own @ n + self.distance_at_touch))

    def build(self, domain: Domain, V: api.Expr, young_modulus: NDArray[np.float64] | None = None) -> ObstacleTerm:
        """The term on a mesh; without a stiffness it needs every own cell's Young modulus [Pa], 0 where rigid."""
        return ObstacleTerm(self, domain, V, young_modulus)


class ObstacleTerm:
    """Surface term of an `ObstacleContact`; see `surface_term.SurfaceTerm`.

    Attributes
    ----------
    description : the contact as data
    stiffness : (m,) penalty stiffness of each facet [N/m^3]; the augmented Lagrangian raises it within an increment
    symmetric : whether the tangent is symmetric: without friction

    Verified by tests/unit/test_fe_contact_obstacle.py and tests/verification/test_fe_ring.py.
    """

    pattern_version = 0

    def __init__(
        self, contact: ObstacleContact, domain: Domain, V: api.Expr, young_modulus: NDArray[np.float64] | None
    ) -> None:
        self.description, self._comm = contact, domain.mesh.comm
        n, closed = contact.gauss_points, contact.closes_gaps
        self._facets = ContactFacets.of(domain, V, contact.faces, simpson_line(4 * n - 3) if closed else gauss_line(n))
        self._ramp = min(contact.ramp, 2.0 * contact.penetration_tolerance) if closed else contact.ramp
        given = self._penalty(young_modulus)
        self._stick = contact.stick_ratio * given
        self._base_stiffness = STIFFENING * given if closed else given
        self.stiffness = self._base_stiffness.copy()
        self.symmetric = contact.friction == 0.0
        self._normal, self._along, _ = contact.axes()
        self._path = contact.path()
        self._control, self._pieces = 0.0, contact.obstacle.pieces()
        facets, points, dim = self._facets.positions.shape
        self._out = kernels.PointForces.zeros(facets, points, len(self._pieces), dim)
        self._place, self._last_x = self._facets.positions.copy(), self._facets.positions
        self._traction = np.zeros_like(self._out.traction)
        self._multiplier = np.zeros_like(self._out.pressure)
        self._accepted_multiplier = np.zeros_like(self._out.pressure)
        self._dissipated = np.zeros(1)
        self._soil, self._level_share = (0.0, 0.0), np.zeros((0, 0))

    def couplings(self) -> NDArray[np.int64]:
        """Nodes of each facet, (n_facets, n_nodes)."""
        return self._facets.nodes

    def set_control(self, control: float) -> None:
        """Set the obstacle's rise [m]."""
        self._control = control

    def evaluate(self, u: NDArray[np.float64], lag: float) -> SurfaceForces:
        """Forces at u (n,) [m]; with a lag [m] their tangent line about the obstacle's place at ``control - lag``.

        In an increment's first solve, the rise used as lag gives the linearisation about the last converged state,
        with its contact set.
        """
        facets, out = self._facets, self._out
        dim = facets.positions.shape[2]
        displacement = u.reshape(-1, dim)[facets.nodes]
        x = facets.positions + np.einsum("mqk,mki->mqi", facets.shapes[facets.kind], displacement)
        self._last_x = x
        place = self._path.place(self._control - lag)
        slip, held = x - place.of(self._place), place.turned(self._traction)
        history = kernels.ContactHistory(multiplier=self._multiplier, traction=held, place=self._place)
        kernels.point_forces(x, slip, self._surface(place), history, out)
        if lag:
            now = self._path.place(self._control)
            way = now.of(self._place) - place.of(self._place)
            out.force[...] = now.turned(place.turned_back(out.force)) + np.einsum("mqij,mqj->mqi", out.stiffness, way)
        active = np.flatnonzero(out.stiffness.any(axis=(1, 2, 3)) | out.force.any(axis=(1, 2)))
        per_facet = (active, facets.shapes, facets.kind, facets.weights)
        return SurfaceForces(
            nodes=facets.nodes[active],
            force=kernels.facet_forces(*per_facet, out.force),
            stiffness=kernels.facet_blocks(*per_facet, out.stiffness),
        )

    def resultant(self) -> NDArray[np.float64]:
        """Force of the obstacle on the body at the last evaluation, (dim,) [N], over all processes."""
        local = np.einsum("mq,mqi->i", self._facets.weights, self._out.force)
        return np.array(self._comm.allreduce(local))

    def moment(self) -> NDArray[np.float64]:
        """Moment of those forces about the origin, (3,) [N m]; (1,) in the plane."""
        arm = np.atleast_1d(moment_of(self._last_x, self._out.force))
        local = np.einsum("mq,mq...->...", self._facets.weights, arm)
        return np.atleast_1d(np.array(self._comm.allreduce(local)))

    def friction_energy(self) -> tuple[float, float]:
        """Energy dissipated by sliding up to the last accepted state, and that stored by elastic slip there [J]."""
        stored = slip_energy(self._facets.weights, self._traction, self._stick)
        return self._comm.allreduce(float(self._dissipated[0])), self._comm.allreduce(stored)

    def penetration(self) -> float:
        """Largest depth of a quadrature point in the obstacle at the last evaluation [m], >= 0."""
        local = float(max(0.0, -self._out.gap.min(initial=0.0)))
        return float(self._comm.allreduce(local, op=api.MPI.MAX))

    def points_and_pressure(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """This process' deformed quadrature points (n, dim) [m] and the pressure there (n,) [Pa], pieces summed."""
        dim = self._last_x.shape[2]
        return self._last_x.reshape(-1, dim), self._out.pressure.sum(axis=-1).ravel()

    def augment(self) -> bool:
        """Uzawa's update with a growing penalty stiffness, if a gap under pressure is too large or too small.

        |p - l| / k is the gap where p = l - k g, and stays large where a point has left the ground with a multiplier.
        """
        contact, pressure = self.description, self._out.pressure
        if not contact.closes_gaps:
            return False
        missing = np.abs(pressure - self._multiplier) / self.stiffness[:, None, None]
        largest = self._comm.allreduce(float(missing.max(initial=0.0)), op=api.MPI.MAX)
        if largest <= contact.penetration_tolerance:
            return False
        self._multiplier[...] = pressure
        self.stiffness *= STIFFENING
        return True

    def accept(self) -> None:
        """Commit multipliers, and traction, place and dissipation for friction."""
        self._accepted_multiplier[...] = self._multiplier
        self._soften()
        now = self._path.place(self._control)
        place, traction = now.back(self._last_x), now.turned_back(self._out.traction)
        if not self.symmetric:
            tractions, slip = (self._traction, traction), place - self._place
            self._dissipated += sliding_dissipation(self._facets.weights, tractions, slip, self._stick)
        self._traction[...], self._place[...] = traction, place

    def state(self) -> TermState:
        """Committed multipliers [Pa], traction [Pa], places [m], dissipation [J], where the method needs them."""
        kept = {}
        if self.description.closes_gaps:
            kept["multiplier"] = self._accepted_multiplier.copy()
        if self.description.friction > 0.0:
            friction = {"traction": self._traction, "place": self._place, "dissipated": self._dissipated}
            kept |= {name: values.copy() for name, values in friction.items()}
        return kept

    def restore(self, state: TermState) -> None:
        """Go back to committed values."""
        if "multiplier" in state:
            self._accepted_multiplier[...] = state["multiplier"]
            self._multiplier[...] = state["multiplier"]
            self._soften()
        if "traction" in state:
            self._traction[...], self._place[...] = state["traction"], state["place"]
            self._dissipated[...] = state["dissipated"]

    def _soften(self) -> None:
        """Begin the next increment with the penalty stiffness as given: a soft contact finds its set sooner."""
        self.stiffness = self._base_stiffness.copy()

    def _penalty(self, young_modulus: NDArray[np.float64] | None) -> NDArray[np.float64]:
        """Penalty stiffness of each facet; facets of rigid cells take the largest of the others."""
        given, facets = self.description.stiffness, self._facets
        if given is not None:
            return np.full(len(facets.nodes), given)
        if young_modulus is None:
            raise InputError("contact stiffness", "None", "needs the cells' Young moduli", "give a stiffness")
        local = local_stiffness(facets, young_modulus[facets.cells])
        largest = float(self._comm.allreduce(float(local.max(initial=0.0)), op=api.MPI.MAX))
        return np.where(local > 0.0, local, largest)

    def _surface(self, place: Place) -> kernels.Surface:
        contact, normal, along = self.description, place.turned(self._normal), place.turned(self._along)
        return kernels.Surface(
            normal=normal,
            along=along,
            level=float(place.moved @ normal) - contact.distance_at_touch,
            start=float(place.moved @ along),
            pieces=self._pieces,
            stiffness=self.stiffness,
            ramp=self._ramp,
            friction=contact.friction,
            stick=self._stick,
            soil=self._soil,
            level_share=self._level_share,
        )


def moment_of(x: NDArray[np.float64], f: NDArray[np.float64]) -> NDArray[np.float64]:
    """Moment x cross f [N m] of forces f (..., dim) [N] at points x (..., dim) [m]; in the plane its one component."""
    if x.shape[-1] == 3:
        return np.cross(x, f)
    return np.asarray(x[..., 0] * f[..., 1] - x[..., 1] * f[..., 0])
