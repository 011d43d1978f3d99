r"""Stiffness of a pressed tire against the hub's travel over the ground: its touching points stuck, one linear solve.

At an equilibrium p of the held hub on the plane, the points that press are stuck: where the ground moves by u_i at
point i, along itself, it draws the point with k_t (u_i - P B_i v), besides the penalty k along its normal; B_i
interpolates, P = I - n n^T, and v is what the free coordinates move by. With A the tangent of the tire on the plane
plus k_t sum B_i^T P B_i, and g_a = k_t sum B_i^T u_i^a for a unit of motion a,

    A v_b = g_b,    S_ab = k_t sum u_i^a . u_i^b - g_a . A^-1 g_b,

the force or moment about the hub's centre that the ground exerts on the tire along a where it moved along b; since
only the motion relative to the hub counts, it is what resists the hub's travel (`contracts.travel_curve`). The motions
are those of `contracts.hub_travel.Way`: u = forward, u = left, u = n x (r_i - hub). Deflection, the axle's direction
and the turn about it are held, as there. S is symmetric, and it does not see sliding: it is the stiffness of a step
that goes to zero.

Assumed: k_t is the penalty k of the same points. Two like elastic bodies have k_t / k = 2 (1 - nu) / (2 - nu)
(Mindlin 1949, from memory), which is 1 for the thesis' nu = 0; what other ratios make of S is told in
docs/theory/ancf_fit.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.equilibrium import NewtonControls, newton_solve
from ancf_reduced.plates.assembly import dense_matrix
from ancf_reduced.tire.mesh import Tire
from ancf_reduced.tire.plane_problem import PlaneProblem
from ancf_reduced.tire.static import TireEquilibria
from contracts.errors import ConvergenceError, InputError
from contracts.frames import ground_direction_h
from contracts.hub_travel import OVER_GROUND

__all__ = ["WAYS", "Stand", "StuckGround", "load_of", "loaded_tangent", "stand_under", "stuck_ground"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
WAYS = OVER_GROUND
"""Order of rows and columns of S."""
_BEYOND = 1.5
"""Of the largest load solved, to which an equilibrium is looked for [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stand:
    """A tire that stands on the plane under a load.

    Attributes
    ----------
    tire, phi : constant data, and circumferential position that faces the ground [rad]
    deflection : hub drop from the nominal radius [m]
    coordinates : (n_nodes, 4, 3) float [m, -], wheel frame
    """

    tire: Tire
    phi: float
    deflection: float
    coordinates: FloatArray

    @property
    def problem(self) -> PlaneProblem:
        """The plane that it stands on."""
        return PlaneProblem(tire=self.tire, direction=ground_direction_h(self.phi))

    @property
    def rows(self) -> IntArray:
        """Rows of the mesh's matrix that are free, (12 n_free,)."""
        return _free_rows(self.tire)


def _free_rows(tire: Tire) -> IntArray:
    """Rows of the mesh's matrix that do not belong to the hub, (12 n_free,) int."""
    return np.asarray((12 * tire.tie.free[:, None] + np.arange(12)).ravel())


def loaded_tangent(problem: PlaneProblem, p: FloatArray, deflection: float) -> tuple[FloatArray, FloatArray, float]:
    """K = dR/dx, s = dF/dx = dR/dd and dF/dd at coordinates p (n_nodes, 4, 3) and a deflection d [m].

    R is elastic minus contact force on the free coordinates x, F the load; a plane that rises by d does to the points
    what a drop of all of them would. Shapes (12 n_free, 12 n_free), (12 n_free,) and a number, [N/m, N, N m].

    Verified by tests/unit/test_ancf_travel_stiffness.py.
    """
    tire, rows = problem.tire, _free_rows(problem.tire)
    contact = dense_matrix(tire.mesh, problem.contact(deflection).tangents(p, np.zeros_like(p))[0])
    tangent = dense_matrix(tire.mesh, tire.model.elastic_tangents(p)) + contact
    along = np.zeros_like(p)
    along[:, 0] = problem.direction
    slope = contact @ along.ravel()
    return np.asarray(tangent[np.ix_(rows, rows)]), slope[rows], float(along.ravel() @ slope)


def stand_under(tire: Tire, states: TireEquilibria, load: float, controls: NewtonControls | None = None) -> Stand:
    """The equilibrium under a load [N], by Newton's method for coordinates and deflection together.

    Parameters
    ----------
    tire, states : a tire and its equilibria at one orientation; between those on either side of the load it begins
    load : ground on wheel [N], above zero and not far beyond the largest of ``states``
    controls : Newton's tolerance

    Raises
    ------
    InputError
        For a load that is not above zero, or that the tire does not come to at the deflections solved.
    ConvergenceError
        If Newton's method does not arrive.

    Verified by tests/unit/test_ancf_travel_stiffness.py.
    """
    most = float(states.load.max())
    if not (np.isfinite(load) and 0.0 < load <= _BEYOND * most):
        shown, rule = f"{load:g} N", f"must be above zero and near the loads solved, up to {most:.4g} N"
        raise InputError("load of the travels", shown, rule, "give a load that the curves reach")
    problem, free = PlaneProblem(tire=tire, direction=ground_direction_h(states.phi)), tire.tie.free
    unit = np.tile([1.0] * 3 + [1.0 / tire.preset.rim_thickness] * 9, len(free))

    def residual(y: FloatArray) -> tuple[FloatArray, float]:
        p = problem.expand(y[:-1])
        contact = problem.contact_force(p, float(y[-1]))
        out = (tire.model.elastic_force(p) - contact)[free].ravel() * unit
        return np.append(out, load_of(contact, problem.direction) - load), load

    def tangent(y: FloatArray) -> FloatArray:
        K, s, by_d = loaded_tangent(problem, problem.expand(y[:-1]), float(y[-1]))
        return np.block([[K * unit[:, None], (s * unit)[:, None]], [s[None], np.array([[by_d]])]])

    found = newton_solve(residual, tangent, _between(tire, states, load), controls or NewtonControls())
    if not found.converged:
        at = f"at {np.degrees(states.phi):g} deg"
        raise ConvergenceError(f"no equilibrium of the ANCF tire under {load:g} N {at}; try another load", [])
    return Stand(tire=tire, phi=states.phi, deflection=float(found.x[-1]), coordinates=problem.expand(found.x[:-1]))


def _between(tire: Tire, states: TireEquilibria, load: float) -> FloatArray:
    """Free coordinates and deflection (12 n_free + 1,) on the straight line between the states around a load [N]."""
    loads = np.concatenate([[0.0], states.load])
    upper = int(np.argmax(loads >= load)) if loads.max() >= load else len(loads) - 1
    lower = upper - 1
    share = (load - loads[lower]) / (loads[upper] - loads[lower])
    rows = np.concatenate([tire.mesh.reference_coordinates()[None], states.coordinates])[:, tire.tie.free]
    places = np.column_stack([rows.reshape(len(rows), -1), np.concatenate([[0.0], states.deflection])])
    return np.asarray(places[lower] + share * (places[upper] - places[lower]))


def load_of(contact: FloatArray, direction: FloatArray) -> float:
    """Load [N] from the generalised contact force (n_nodes, 4, 3): its positions' rows sum to the resultant."""
    return float(-(contact[:, 0] @ direction).sum())


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StuckGround:
    """The points of a standing tire that touch, stuck to the ground.

    Attributes
    ----------
    stand : what stands
    carriers, points : (n,) int, where the points are in the contact grid
    stiffness : k_t of each point [N/m]

    Verified by tests/unit/test_ancf_travel_stiffness.py (whole solves; the rigid limit in closed form).
    """

    stand: Stand
    carriers: IntArray
    points: IntArray
    stiffness: float

    @property
    def motions(self) -> FloatArray:
        """u of each point for a unit of each of `WAYS`, (3, n, 3) float [-, -, m/rad]."""
        normal = -ground_direction_h(self.stand.phi)
        forward = ground_direction_h(self.stand.phi + 0.5 * np.pi)
        r = self.stand.tire.grid.positions(self.stand.coordinates)[self.carriers, self.points]
        along = [np.broadcast_to(u, r.shape) for u in (forward, np.cross(normal, forward))]
        return np.array([*along, np.cross(normal, r - self.stand.tire.tie.origin)])

    @property
    def drawn(self) -> FloatArray:
        """g of each of `WAYS` on the free coordinates, (12 n_free, 3) float [N/m, N; N/rad, N m/rad]."""
        tire, force = self.stand.tire, np.zeros((3, *self.stand.coordinates.shape))
        tables = tire.grid.tables
        shape = tables.interpolation[self.carriers, self.points].reshape(-1, 4, 4)
        at_nodes = self.stiffness * np.einsum("qab,wqi->wqabi", shape, self.motions)
        for way in range(3):
            np.add.at(force[way], tables.nodes[self.carriers], at_nodes[way])
        return np.asarray(force.reshape(3, -1)[:, self.stand.rows].T)

    @property
    def held(self) -> FloatArray:
        """Sum k_t u_i^a . u_i^b, (3, 3): S of a tire that does not give way."""
        return np.asarray(self.stiffness * np.einsum("aqi,bqi->ab", self.motions, self.motions))

    @property
    def tangent(self) -> FloatArray:
        """A on the free coordinates, (12 n_free, 12 n_free) float."""
        tire, direction = self.stand.tire, self.stand.problem.direction
        tables = tire.grid.tables
        along = np.eye(3) - np.outer(direction, direction)
        blocks = np.zeros((tire.grid.n_plates, 16, 16))
        shape = tables.interpolation[self.carriers, self.points]
        np.add.at(blocks, tables.plates[self.carriers], self.stiffness * shape[:, :, None] * shape[:, None])
        springs = np.einsum("pab,ij->paibj", blocks, along).reshape(-1, 48, 48)
        K = loaded_tangent(self.stand.problem, self.stand.coordinates, self.stand.deflection)[0]
        return np.asarray(K + dense_matrix(tire.mesh, springs)[np.ix_(self.stand.rows, self.stand.rows)])

    def moved(self) -> FloatArray:
        """v of the free coordinates for a unit of each of `WAYS`, (12 n_free, 3); ConvergenceError if singular."""
        try:
            return np.asarray(np.linalg.solve(self.tangent, self.drawn))
        except np.linalg.LinAlgError as error:
            message = "the tire's stiffness against travel does not exist: its tangent is singular"
            raise ConvergenceError(message, []) from error

    def stiffness_matrix(self) -> FloatArray:
        """S, (3, 3) float in the order of `WAYS`: [N/m], the last row and column [N/rad], its corner [N m/rad]."""
        return np.asarray(self.held - self.drawn.T @ self.moved())

    def energies(self, v: FloatArray) -> FloatArray:
        """Twice the energy of a unit of each of `WAYS` where the coordinates move by v (12 n_free, 3), (3,) float.

        It is least at the v of `moved`, and there the diagonal of S: so a derivative of that needs none of v.
        """
        drawn = np.einsum("xw,xw->w", self.drawn, v)
        return np.asarray(np.diag(self.held) - 2.0 * drawn + np.einsum("xw,xw->w", v, self.tangent @ v))


def stuck_ground(stand: Stand, ratio: float = 1.0) -> StuckGround:
    """The points that press, stuck with ``ratio`` times their penalty [-].

    Raises
    ------
    InputError
        For a ratio that is not above zero.
    """
    if not (np.isfinite(ratio) and ratio > 0.0):
        raise InputError("tangential over normal stiffness", f"{ratio:g}", "must be finite and > 0", "1 is usual")
    patch = stand.problem.patch(stand.coordinates, stand.deflection)
    pressed = patch.normal_force > 0.0
    carrier_of = np.full(stand.tire.grid.n_plates, -1)
    carrier_of[stand.tire.grid.tables.plates] = np.arange(len(stand.tire.grid.tables.plates))
    k_t = ratio * stand.tire.preset.contact_stiffness
    carriers = carrier_of[patch.plates[pressed]]
    return StuckGround(stand=stand, carriers=carriers, points=patch.points[pressed], stiffness=k_t)
