"""Equilibria of an ANCF wheel on rigid ground, its hub held: loads, and whether they are stable.

Newton's method as the continuum model has it: stresses of the tangent's geometric part are linearised from step to step
(mixed integration points), so that thin strips turn far in few iterations, and every step finds its own set of touching
points (`ancf_reduced.wheel.contact_step`). Verified by tests/unit/test_ancf_wheel_static.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, csr_array
from scipy.sparse.linalg import splu

from ancf_reduced.wheel.contact_step import settle
from ancf_reduced.wheel.contacts import Near, joined
from ancf_reduced.wheel.ground import GroundContact, Pose, ground_frame
from ancf_reduced.wheel.inner_contacts import RIM, InnerContacts
from ancf_reduced.wheel.mesh import AncfWheel
from ancf_reduced.wheel.reduction import Reduction
from ancf_reduced.wheel.rubbing import Rubbed, Since, congruent, rubbed
from ancf_reduced.wheel.ties import Ties
from contracts.errors import ConvergenceError, IncrementRecord, InputError
from contracts.hub_travel import HubTravel
from contracts.terrain import Plane, Terrain

__all__ = ["Equilibrium", "Mixed", "System", "WheelOnGround", "press"]

Array = NDArray[np.float64]
Mixed = tuple[list[Array], Array, Array]
"""Stresses of plates, forces of ties and of contacts [N]."""

_LOWEST = 1e-6
"""Height above the lowest point up to which points are taken to touch first [m]."""
_ASTRAY = 1e5
"""Work of the residual, over load times deflection, from which no iteration has come back [-]."""
_LEAST_WORK = 1e-9
"""Work that residuals are held against at least [N m]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Equilibrium:
    """The wheel at rest at one deflection.

    Attributes
    ----------
    deflection : from first touch [m]
    load : of the ground on the whole wheel [N]
    energy : strain energy of plates and ties, of the whole wheel [J]
    free : (n_free,) coordinates
    pressed : (n_ground,) force at each contact of a point with a piece of the ground [N]
    pull : (n_ground, 3) friction there, on the wheel [N]
    inner : (n_inner,) force at each pair of a point on a spring's or the rim's face and what it may touch [N]
    negative : negative eigenvalues of the tangent, the contact's stiffness included: none where the wheel stands. With
        friction, whose tangent is unsymmetric, negative pivots that say nothing
    residuals : work of the residual in each step, over load times deflection [-]
    """

    deflection: float
    load: float
    energy: float
    free: Array
    pressed: Array
    pull: Array
    inner: Array
    negative: int
    residuals: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """Steps taken."""
        return len(self.residuals) - 1


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class System:
    """The wheel linearised: residual (n,) and tangent without contact; gaps, their slopes (m, n) and penalties near.

    What a unit of force at each contact does, ``push`` (m, n): the slopes, and friction where it slides. And the
    ground's contacts, the first of them, with their friction.
    """

    residual: Array
    tangent: csc_array
    gaps: Array
    slopes: csr_array
    push: csr_array
    stiffness: Array
    near: NDArray[np.int64]
    ground: Near
    friction: Rubbed | None
    energy: float


class WheelOnGround:
    """One wheel at one orientation.

    Parameters
    ----------
    wheel : from `ancf_reduced.wheel.mesh.build_ancf_wheel`
    orientation : circumferential position that faces the ground [rad]
    contact_stiffness : penalty of the ground [N/m^3]
    inner_contact_stiffness : penalty of springs, rim and hub against each other [N/m^3]; 0: they pass through
    terrain : the ground in its own frame, x forward, z along its normal, the hub above its origin; a plane without it
    camber : of the ground about its forward direction; positive lifts its left side [rad]
    friction : Coulomb coefficient on the ground [-]
    travel : how the hub is moved over the ground behind a deflection; `press` then takes its controls behind it
    soil : modulus [N/m^(n+2)] and exponent of soil in place of rigid ground, without friction
    """

    def __init__(
        self,
        wheel: AncfWheel,
        orientation: float,
        contact_stiffness: float = 1e11,
        inner_contact_stiffness: float = 1e11,
        *,
        terrain: Terrain | None = None,
        camber: float = 0.0,
        friction: float = 0.0,
        travel: HubTravel | None = None,
        soil: tuple[float, float] | None = None,
    ) -> None:
        if soil is not None and friction > 0.0:
            raise InputError("soil", "with friction", "presses by its depth alone", "leave the friction out")
        if not np.isfinite(orientation):
            raise InputError("orientation", f"{orientation} rad", "must be finite", "give an angle such as 0.785 rad")
        if not abs(camber) < 0.5 * np.pi:
            raise InputError(
                "camber", f"{camber} rad", "must lie between -pi/2 and pi/2", "give an angle such as 0.1 rad"
            )
        if not (np.isfinite(contact_stiffness) and contact_stiffness > 0.0):
            raise InputError("contact stiffness", f"{contact_stiffness:g} N/m^3", "must be > 0", "1e11 N/m^3 is usual")
        if not (np.isfinite(inner_contact_stiffness) and inner_contact_stiffness >= 0.0):
            told = f"{inner_contact_stiffness:g} N/m^3"
            raise InputError("inner contact stiffness", told, "must be >= 0", "1e11 N/m^3 is usual, 0 is without")
        if not (np.isfinite(friction) and friction >= 0.0):
            raise InputError("friction coefficient", f"{friction:g}", "must be >= 0", "0 is without friction")
        if travel is not None and travel.slides and friction == 0.0:
            rule = "must be > 0 for a wheel that moves over the ground: without, nothing resists"
            raise InputError("friction coefficient", "0", rule, "0.6 is the thesis'")
        self.wheel, self.orientation, self.camber, self.friction = wheel, orientation, camber, friction
        plates = wheel.plates
        frame = ground_frame(orientation, camber)
        self.ground = GroundContact(wheel, terrain or Plane(), frame, contact_stiffness, travel, soil)
        self._inner = InnerContacts(wheel, inner_contact_stiffness) if inner_contact_stiffness > 0.0 else None
        self.counts = [self.ground.count, *(self._inner.counts if self._inner else [])]
        self._ties = Ties(plates, wheel.ties)
        self._farthest = float(np.linalg.norm(plates.reference[:, 0], axis=1).max())
        self._reduction = Reduction(wheel.basis, (plates.numbers, self._ties.numbers))

    def unloaded(self) -> Equilibrium:
        """The wheel at first touch."""
        zeros = [np.zeros(n) for n in (self.wheel.basis.shape[1], self.ground.count, sum(self.counts[1:]))]
        state = {"free": zeros[0], "pressed": zeros[1], "pull": np.zeros((len(zeros[1]), 3)), "inner": zeros[2]}
        return Equilibrium(deflection=0.0, load=0.0, energy=0.0, negative=0, residuals=(), **state)

    def solve(
        self, deflection: float, start: Equilibrium, tolerance: float = 1e-12, limit: int = 25
    ) -> Equilibrium | tuple[float, ...]:
        """Equilibrium at a deflection [m] from one that is near, or the works of the residual of a try that failed.

        tolerance : work of the residual in the next step over load times deflection; limit : steps, twice as many
        with friction
        """
        free, residuals, pose = start.free, list[float](), self.ground.risen(deflection)
        mixed: Mixed = *self.extrapolated(free, np.zeros_like(free)), np.concatenate([start.pressed, start.inner])
        since = self._since(start) if self.friction > 0.0 else None
        while True:
            system = self.linearised(free, pose, mixed, since)
            touching = system.gaps < 0.0 if residuals else self._touching(system, start)
            G = system.slopes[np.flatnonzero(touching)]
            push = system.push[np.flatnonzero(touching)]
            matrix = csc_array(system.tangent + push.T @ csr_array(G * system.stiffness[touching, None]))
            try:
                factors = splu(
                    matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
                )
            except RuntimeError:  # singular
                return tuple(residuals)
            contact = system.gaps, system.slopes, system.stiffness
            found = settle(factors.solve, system.tangent.dot, system.residual, contact, touching, system.push)
            if found is None or self._moved(found[0]) > self._farthest:
                return tuple(residuals)
            step, forces = found
            held = -system.stiffness * np.minimum(system.gaps, 0.0)
            work = abs(float((system.residual - system.push.T @ held) @ step))
            load = float(held[: len(system.ground.points)] @ self.lift(system.ground, pose))
            pull = np.zeros((self.ground.count, 3))
            if system.friction is not None:
                pull[system.friction.numbers] = system.friction.pull(held)
                since = None if since is None else since.after(system.friction)
                load += float((pull @ pose[0][2]).sum())
            residuals.append(work / max(load * deflection, start.load / self.wheel.sides * deflection, _LEAST_WORK))
            pressed = np.zeros(sum(self.counts))
            if residuals[-1] < tolerance:
                pressed[system.near] = held
                return Equilibrium(
                    deflection=deflection,
                    load=self.wheel.sides * load,
                    energy=self.wheel.sides * system.energy,
                    free=free,
                    pressed=pressed[: self.ground.count],
                    pull=pull,
                    inner=pressed[self.ground.count :],
                    negative=int((factors.U.diagonal() < 0.0).sum()),
                    residuals=tuple(residuals),
                )
            if len(residuals) > (limit if since is None else 2 * limit) or not residuals[-1] < _ASTRAY:
                return tuple(residuals)
            pressed[system.near] = forces
            mixed = *self.extrapolated(free, step), pressed
            free = free + step

    def rim_force(self, state: Equilibrium) -> float:
        """Of springs on the rim, sum of the sizes of all points' forces, of the whole wheel [N]."""
        if self._inner is None:
            return 0.0
        on_rim = np.split(state.inner, np.cumsum(self._inner.counts)[:-1])[RIM]
        return self.wheel.sides * float(on_rim.sum())

    def wrench(self, state: Equilibrium) -> tuple[Array, Array]:
        """Force [N] and moment about the hub's centre [N m] of the ground on the whole wheel.

        Along the ground's forward, left and up.
        """
        q, pose = self.wheel.coordinates(state.free), self.ground.risen(state.deflection)
        near = self.ground.near(q, pose, np.zeros(self.ground.count), np.empty((0, 16, 3, 16, 3)))
        assert near.surface is not None
        forces = state.pressed[near.points, None] * near.surface.normals + state.pull[near.points]
        axes = pose[0]
        force = axes @ forces.sum(axis=0)
        moment = axes @ np.cross(near.surface.places, forces).sum(axis=0)
        if self.wheel.sides > 1.0:
            force[1] = moment[0] = moment[2] = 0.0
        return self.wheel.sides * force, self.wheel.sides * moment

    def _since(self, start: Equilibrium) -> Since:
        q, pose = self.wheel.coordinates(start.free), self.ground.risen(start.deflection)
        return Since.equilibrium(q, pose, start.pull, self.friction)

    def lift(self, ground: Near, pose: Pose) -> Array:
        """Share of each contact's force that acts along the ground's normal, (n,) [-]."""
        assert ground.surface is not None
        return np.asarray(ground.surface.normals @ pose[0][2])

    def _moved(self, step: Array) -> float:
        """Longest way of a node in a step [m]."""
        change = (self.wheel.basis @ step).reshape(self.wheel.plates.reference.shape)
        return float(np.linalg.norm(change[:, 0], axis=1).max())

    def _touching(self, system: System, start: Equilibrium) -> NDArray[np.bool_]:
        """First guess: what touched before; at first touch the lowest points (nearly all gaps are negative there)."""
        before = np.concatenate([start.pressed, start.inner])[system.near] > 0.0
        return before if before.any() else np.asarray(system.gaps < system.gaps.min(initial=np.inf) + _LOWEST)

    def linearised(self, free: Array, pose: Pose, mixed: Mixed, since: Since | None = None) -> System:
        """The wheel about free coordinates (n_free,), the ground in a pose; stresses and forces as `extrapolated`.

        since : where friction starts from; without it there is none
        """
        plates, T = self.wheel.plates, self.wheel.basis
        q = self.wheel.coordinates(free)
        stresses, tied, pressed = mixed
        energy, force, blocks = plates.terms(q, stresses)
        tie_energy, tie_force, tie_blocks = self._ties.terms(q, tied)
        shares = np.split(pressed, np.cumsum(self.counts)[:-1])
        found = [self.ground.near(q, pose, shares[0], blocks)]
        found += self._inner.near(q, shares[1:], blocks) if self._inner else []
        near = joined(found, self.counts)
        total = np.bincount(plates.numbers.ravel(), weights=force.ravel(), minlength=plates.size)
        total += np.bincount(self._ties.numbers.ravel(), weights=tie_force.ravel(), minlength=plates.size)
        matrix = self._reduction(np.concatenate([blocks.ravel(), tie_blocks.ravel()]))
        if near.tangent is not None:
            rows, columns, values = near.tangent
            inner = csc_array(coo_array((values, (rows, columns)), shape=(plates.size, plates.size)))
            matrix = matrix + T.T @ inner @ T
        held, friction, push = self.wheel.held @ free, None, near.slopes
        if since is not None:
            friction = rubbed(self.ground, q, pose, found[0], shares[0], since)
            total -= friction.slopes.T @ friction.stuck.ravel()
            matrix = matrix + congruent(csr_array(friction.slopes @ T), friction.stiffness)
            push = push + friction.leaning(len(near.gaps))
        return System(
            residual=T.T @ total + held,
            tangent=csc_array(matrix + self.wheel.held),
            gaps=near.gaps,
            slopes=csr_array(near.slopes @ T),
            push=csr_array(push @ T),
            stiffness=near.stiffness,
            near=near.points,
            ground=found[0],
            friction=friction,
            energy=energy + tie_energy + 0.5 * float(free @ held),
        )

    def material_tangent(self, free: Array) -> csc_array:
        """The tangent of plates and ties without what their stresses add (n_free, n_free), at free coordinates.

        Positive semidefinite, and nothing to motions that turn a strip as a whole.
        """
        q, plates = self.wheel.coordinates(free), self.wheel.plates
        stresses, tied = self.extrapolated(free, np.zeros_like(free))
        tie_blocks = self._ties.terms(q, 0.0 * tied)[2]
        blocks = plates.terms(q, [0.0 * stress for stress in stresses])[2]
        return csc_array(self._reduction(np.concatenate([blocks.ravel(), tie_blocks.ravel()])) + self.wheel.held)

    def extrapolated(self, free: Array, step: Array) -> tuple[list[Array], Array]:
        """Stresses of plates and forces of ties after a step, linearised."""
        plates = self.wheel.plates
        q, change = self.wheel.coordinates(free), (self.wheel.basis @ step).reshape(plates.reference.shape)
        return plates.stresses(q, change), self._ties.after(q, change)


def press(
    problem: WheelOnGround,
    deflections: Sequence[float],
    smallest_step: float = 1e-5,
    history: list[IncrementRecord] | None = None,
) -> Iterator[Equilibrium]:
    """Equilibria at increasing deflections [m], each from the one before; increments that fail are halved.

    history : every increment is added to it, converged or not

    Raises
    ------
    InputError
        For deflections that do not increase from above zero, and a smallest step that is not positive.
    ConvergenceError
        If an increment fails whose half is below ``smallest_step`` [m]; with the history of increments.
    """
    if not (all(a < b for a, b in pairwise((0.0, *deflections))) and np.isfinite(deflections).all()):
        told = ", ".join(f"{1e3 * d:g}" for d in deflections)
        raise InputError("deflections", f"{told} mm", "must be finite and increase from above zero", "sort them")
    if not (np.isfinite(smallest_step) and smallest_step > 0.0):
        raise InputError("smallest step", f"{smallest_step:g} m", "must be > 0", "1e-5 m is usual")
    state, history = problem.unloaded(), [] if history is None else history
    for target in deflections:
        step = target - state.deflection
        while state.deflection < target:
            goal = target if state.deflection + 1.5 * step > target else state.deflection + step
            found = problem.solve(goal, state)
            arrived = isinstance(found, Equilibrium)
            residuals = found.residuals if isinstance(found, Equilibrium) else found
            history.append(
                IncrementRecord(target=goal, step=goal - state.deflection, converged=arrived, residuals=residuals)
            )
            if isinstance(found, Equilibrium):
                state = found
            elif 0.5 * step < smallest_step:
                what = f"ANCF wheel: no equilibrium found from {1e3 * state.deflection:.4g} to {1e3 * goal:.4g} mm"
                raise ConvergenceError(f"{what}; ask for closer deflections, or stop there", history, state)
            else:
                step *= 0.5
        yield state
