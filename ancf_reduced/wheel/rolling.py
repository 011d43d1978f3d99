"""Equations of an ANCF wheel that rolls: its plates in the hub's frame, the hub on its way in the plane of the wheel.

Coordinates y = (s, x, z, theta): free coordinates of the plates in the hub's frame, the hub's place in the world [m],
its angle about the axle [rad] (positive rolls towards +x; the wheel then stands on its position phi = theta). With
E = e_y x, R the rotation and M the plates' constant mass, the acceleration of a node's vectors p in the hub's frame,

    a = p'' + 2 theta' E p' + theta'^2 E^2 p + theta'' E p + (R^T (x'', 0, z'') for places),

is exact, so that nothing of the wheel's inertia is left out; statics' plates, ties and contacts serve as they are.
Lateral motion of the hub and its turning about other axes are held.
Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, eye_array, hstack, kron
from scipy.sparse.linalg import eigsh, splu

from ancf_reduced.wheel.static import Mixed, System, WheelOnGround
from contracts.errors import InputError

__all__ = ["ABOUT_AXLE", "HUB", "Bordered", "Friction", "Hub", "Linearised", "Motion", "RollingWheel"]

Array = NDArray[np.float64]
ABOUT_AXLE = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
"""E: what e_y x does to a vector."""
HUB = 3
"""The hub's coordinates x, z, theta, behind those of the plates."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hub:
    """What moves with the hub, of the whole wheel, and its drive.

    Attributes
    ----------
    mass : on the axle [kg]
    inertia : about the axle [kg m^2]
    speed, gain : drive that turns it with gain (speed - theta') [rad/s, N m s]; no gain: it turns freely
    """

    mass: float
    inertia: float
    speed: float = 0.0
    gain: float = 0.0

    def __post_init__(self) -> None:
        for what, value, unit, least in (
            ("hub mass", self.mass, "kg", 0.0),
            ("hub inertia", self.inertia, "kg m^2", 0.0),
            ("drive gain", self.gain, "N m s", -1e-300),
        ):
            if not (np.isfinite(value) and value > least):
                raise InputError(what, f"{value:g} {unit}", "must be finite and > 0", "check the unit")
        if not np.isfinite(self.speed):
            raise InputError("drive speed", f"{self.speed:g} rad/s", "must be finite", "e.g. 0.14 rad/s")


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
class Motion:
    """Coordinates y, their rates v and accelerations a (n_free + 3,) at a time [s]; forces of all contacts [N]."""

    time: float
    y: Array
    v: Array
    a: Array
    pressed: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Linearised:
    """Residual (n,), its derivatives by coordinates, rates and accelerations; contacts for `contact_step.settle`.

    Attributes
    ----------
    residual : inertia and inner forces less weight, drive and friction, without contacts' normal forces
    by_place, by_rate, by_acceleration : the plates' part (n_free, n_free) and the hub's columns (n_free + 3, 3)
    slopes : (m, n_free + 3) of the gaps
    system : the wheel without inertia
    """

    residual: Array
    by_place: tuple[csc_array, Array]
    by_rate: tuple[csc_array, Array]
    by_acceleration: tuple[csc_array, Array]
    slopes: csr_array
    system: System


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Rubbing:
    """Points under pressure: derivatives of places J (3 n, n_free) and ways (n, 3, 3) by the hub, velocity, force.

    And minus the force's derivative by velocity D (n, 3, 3).
    """

    J: csr_array
    ways: Array
    velocity: Array
    force: Array
    D: Array


class RollingWheel:
    """A wheel with a hub on ground, in the plane of the wheel.

    Parameters
    ----------
    problem : the wheel on its ground, orientation 0; its terrain is the world's
    hub : mass, inertia and drive
    gravity : downwards [m/s^2]
    friction : on the ground
    damping_ratio : of the first mode with the hub held [-]; damping in proportion to the stiffness at rest
    """

    def __init__(
        self,
        problem: WheelOnGround,
        hub: Hub,
        gravity: float,
        friction: Friction | None = None,
        damping_ratio: float = 0.0,
    ) -> None:
        if not (np.isfinite(damping_ratio) and 0.0 <= damping_ratio < 1.0):
            raise InputError("damping ratio", f"{damping_ratio:g}", "must lie in 0..1, 1 excluded", "0.05 is usual")
        if not np.isfinite(gravity):
            raise InputError("gravity", f"{gravity:g} m/s^2", "must be finite", "3.711 on Mars")
        self.problem, self.hub, self.friction, self.gravity = problem, hub, friction or Friction(), gravity
        wheel = problem.wheel
        self.sides, self.basis = wheel.sides, wheel.basis
        self._hub = hub.mass / wheel.sides, hub.inertia / wheel.sides
        self._mass = wheel.plates.mass()
        self._nodes = wheel.plates.reference.shape
        ones = np.zeros(self._nodes)
        ones[:, 0, :] = 1.0
        self._ones = [(ones * axis).ravel() for axis in np.eye(3)]
        self._turn = csr_array(kron(eye_array(self._nodes[0] * 4), ABOUT_AXLE))
        T = self.basis
        self.own_mass = csc_array(T.T @ self._mass @ T)
        self.plates_mass = float(self._ones[0] @ (self._mass @ self._ones[0]))
        rest = np.zeros(T.shape[1])
        none: Mixed = *problem.extrapolated(rest, rest), np.zeros(sum(problem.counts))
        self.stiffness = problem.linearised(rest, self._pose(np.array([0.0, 1e3, 0.0])), none).tangent
        self.viscosity = 0.0 if damping_ratio == 0.0 else 2.0 * damping_ratio / self.first_frequency()

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.basis.shape[1]) + HUB

    def first_frequency(self) -> float:
        """Angular frequency of the first mode of the free wheel, its hub held [rad/s]."""
        square = eigsh(
            self.stiffness, k=1, M=self.own_mass, sigma=0.0, v0=np.ones(self.size - HUB), return_eigenvectors=False
        )
        return float(np.sqrt(square[0]))

    def standing(self, free: Array, deflection: float, pressed: Array) -> Motion:
        """At rest on level ground as statics found it at a deflection from first touch [m], orientation 0."""
        y = np.zeros(self.size)
        y[:-HUB], y[-2] = free, -float(self.problem.ground.risen(deflection)[1][2])
        return Motion(time=0.0, y=y, v=np.zeros(self.size), a=np.zeros(self.size), pressed=pressed)

    def above(self, height: float, x: float = 0.0) -> Motion:
        """Undeformed and at rest, a height [m] above first touch on level ground."""
        y = np.zeros(self.size)
        y[-3], y[-2] = x, height - float(self.problem.ground.risen(0.0)[1][2])
        zeros = np.zeros(self.size)
        return Motion(time=0.0, y=y, v=zeros, a=zeros, pressed=np.zeros(sum(self.problem.counts)))

    def linearised(self, y: Array, v: Array, a: Array, mixed: Mixed) -> Linearised:
        """The equations about a state; ``mixed`` as `WheelOnGround.linearised`."""
        T, M = self.basis, self._mass
        system = self.problem.linearised(y[:-HUB], self._pose(y[-HUB:]), mixed)
        omega, turning = float(v[-1]), float(a[-1])
        p = self.problem.wheel.coordinates(y[:-HUB]).ravel()
        rate, second = T @ v[:-HUB], T @ a[:-HUB]
        Ep = self._turn @ p
        ahead, up = self._axes(float(y[-1]))
        rigid = a[-3] * ahead + (a[-2] + self.gravity) * up
        moving = M @ (second + 2.0 * omega * (self._turn @ rate) + omega**2 * (self._turn @ Ep) + turning * Ep + rigid)
        m, inertia = self._hub
        damping = self.viscosity * (self.stiffness @ v[:-HUB])
        drive = self.hub.gain / self.sides * (self.hub.speed - omega)
        ends = np.array([m * a[-3], m * (a[-2] + self.gravity), inertia * turning - drive])
        for k, way in enumerate((ahead, up, Ep)):
            ends[k] += way @ moving
        residual = np.concatenate([T.T @ moving + system.residual + damping, ends])
        borders = np.stack([ahead, up, Ep], axis=1)
        heavy = M @ borders
        hub_mass = np.concatenate([T.T @ heavy, borders.T @ heavy + np.diag([m, m, inertia])])
        by_rate = np.zeros((self.size, HUB))
        by_rate[-1, -1] = self.hub.gain / self.sides
        slopes, place = self._contacts(y, system, mixed[2])
        found = Linearised(
            residual=residual,
            by_place=(system.tangent, place),
            by_rate=(csc_array(self.viscosity * self.stiffness), by_rate),
            by_acceleration=(self.own_mass, hub_mass),
            slopes=slopes,
            system=system,
        )
        return self._rubbed(found, y, v, mixed[2])

    def load(self, motion: Motion) -> Array:
        """Force of the ground on the whole wheel along world x and z, normal parts alone, (2,) [N]."""
        none: Mixed = *self.problem.extrapolated(motion.y[:-HUB], 0.0 * motion.y[:-HUB]), 0.0 * motion.pressed
        ground = self.problem.linearised(motion.y[:-HUB], self._pose(motion.y[-HUB:]), none).ground
        assert ground.surface is not None
        held = -ground.stiffness * np.minimum(ground.gaps, 0.0)
        world = ground.surface.normals @ _rotation(float(motion.y[-1])).T
        return np.asarray(self.sides * (held @ world)[[0, 2]])

    def energies(self, motion: Motion, found: Linearised, step: Array) -> tuple[float, float, float, float]:
        """Kinetic, strain, of weight, of contacts' penalty [J], of the whole wheel.

        found : the equations a step before, by which the two in the middle follow to third order in the step
        """
        p = self.problem.wheel.coordinates(motion.y[:-HUB]).ravel()
        ahead, up = self._axes(float(motion.y[-1]))
        u = self.basis @ motion.v[:-HUB] + motion.v[-1] * (self._turn @ p) + motion.v[-3] * ahead + motion.v[-2] * up
        m, inertia = self._hub
        kinetic = 0.5 * float(u @ (self._mass @ u))
        kinetic += 0.5 * float(m * (motion.v[-3:-1] ** 2).sum() + inertia * motion.v[-1] ** 2)
        raised = float(up @ (self._mass @ p)) + (self.plates_mass + m) * float(motion.y[-2])
        system, own = found.system, step[:-HUB]
        strain = system.energy + float(own @ (system.residual + 0.5 * (self.stiffness @ own)))
        contact = 0.5 * float(system.stiffness @ np.minimum(system.gaps + found.slopes @ step, 0.0) ** 2)
        k = self.sides
        return k * kinetic, k * strain, k * self.gravity * raised, k * contact

    def powers(self, motion: Motion, found: Linearised) -> tuple[float, float, float]:
        """Of damping and friction (dissipated, >= 0) and of the drive [W], of the whole wheel."""
        damping = self.viscosity * float(motion.v[:-HUB] @ (self.stiffness @ motion.v[:-HUB]))
        drive = self.hub.gain * (self.hub.speed - motion.v[-1]) * motion.v[-1]
        rubbing = self._rubbing(found.system, motion.y, motion.v, motion.pressed)
        friction = 0.0 if rubbing is None else -float((rubbing.force * rubbing.velocity).sum())
        return self.sides * damping, self.sides * friction, float(drive)

    def _axes(self, theta: float) -> tuple[Array, Array]:
        """World x and z for all nodes' places, in the hub's frame."""
        c, s = np.cos(theta), np.sin(theta)
        return c * self._ones[0] + s * self._ones[2], c * self._ones[2] - s * self._ones[0]

    def _pose(self, hub: Array) -> tuple[Array, Array]:
        """The world in the hub's frame."""
        return _rotation(float(hub[2])), np.array([-hub[0], 0.0, -hub[1]])

    def _contacts(self, y: Array, system: System, pressed: Array) -> tuple[csr_array, Array]:
        """Slopes of all gaps with the hub's columns; what the ground's forces add to the tangent's hub columns."""
        surface, count = system.ground.surface, len(system.ground.points)
        assert surface is not None
        hub = np.zeros((len(system.gaps), HUB))
        E_places = surface.places @ ABOUT_AXLE.T
        axes = _rotation(float(y[-1]))[[0, 2]]
        hub[:count, :2] = surface.normals @ axes.T
        hub[:count, 2] = (surface.normals * E_places).sum(axis=1)
        slopes = csr_array(hstack([system.slopes, csr_array(hub)]))
        place = np.zeros((self.size, HUB))
        held = np.flatnonzero(pressed[system.ground.points] > 0.0)
        if len(held):
            force = pressed[system.ground.points[held]]
            J = self._point_slopes(y, system.ground.points[held])
            ways = np.empty((len(held), 3, HUB))
            ways[:, :, 0], ways[:, :, 1], ways[:, :, 2] = axes[0], axes[1], E_places[held]
            bent = surface.bends[held] @ ways
            bent[:, :, 2] += surface.normals[held] @ ABOUT_AXLE
            place[:-HUB] = -(J.T @ (force[:, None, None] * bent).reshape(-1, HUB))
            square = np.einsum("p,pik,pij,pjl->kl", force, ways, surface.bends[held], ways)
            square[2, 2] += float(force @ (surface.normals[held] * (E_places[held] @ ABOUT_AXLE.T)).sum(axis=1))
            place[-HUB:] = -square
        return slopes, place

    def _point_slopes(self, y: Array, contacts: NDArray[np.int64]) -> csr_array:
        """Derivatives (3 n, n_free) of the points of contacts."""
        q = self.problem.wheel.coordinates(y[:-HUB])
        return csr_array(self.problem.ground.slopes(q, contacts) @ self.basis)

    def _rubbing(self, system: System, y: Array, v: Array, pressed: Array) -> _Rubbing | None:
        """Friction of the ground at points under pressure."""
        ground, mu = system.ground, self.friction.coefficient
        held = np.flatnonzero(pressed[ground.points] > 0.0)
        if mu == 0.0 or not len(held):
            return None
        assert ground.surface is not None
        N, normals = pressed[ground.points[held]], ground.surface.normals[held]
        J = self._point_slopes(y, ground.points[held])
        ways = np.empty((len(held), 3, HUB))
        axes = _rotation(float(y[-1]))[[0, 2]]
        ways[:, :, 0], ways[:, :, 1], ways[:, :, 2] = axes[0], axes[1], ground.surface.places[held] @ ABOUT_AXLE.T
        velocity = (J @ v[:-HUB]).reshape(-1, 3) + ways @ v[-HUB:]
        across = velocity - (velocity * normals).sum(axis=1)[:, None] * normals
        size = np.sqrt((across**2).sum(axis=1) + self.friction.slip_velocity**2)
        tau = across / size[:, None]
        force = -mu * N[:, None] * tau
        P = np.eye(3) - normals[:, :, None] * normals[:, None, :] - tau[:, :, None] * tau[:, None, :]
        return _Rubbing(J=J, ways=ways, velocity=velocity, force=force, D=(mu * N / size)[:, None, None] * P)

    def _rubbed(self, found: Linearised, y: Array, v: Array, pressed: Array) -> Linearised:
        """With friction of the ground, its forces' derivatives by rates at constant pressure."""
        rubbing = self._rubbing(found.system, y, v, pressed)
        if rubbing is None:
            return found
        J, ways, force, D = rubbing.J, rubbing.ways, rubbing.force, rubbing.D
        count = len(force)
        wide = (D @ ways).reshape(-1, HUB)
        blocks = csr_array(
            (D.ravel(), (3 * np.arange(count)[:, None] + np.tile([0, 1, 2], 3)).ravel(), 3 * np.arange(3 * count + 1)),
            shape=(3 * count, 3 * count),
        )
        residual, by_rate = found.residual.copy(), found.by_rate[1].copy()
        residual[:-HUB] -= J.T @ force.ravel()
        residual[-HUB:] -= np.einsum("pi,pik->k", force, ways)
        by_rate[:-HUB] += J.T @ wide
        by_rate[-HUB:] += np.einsum("pik,pil->kl", ways, wide.reshape(-1, 3, HUB))
        return Linearised(
            residual=residual,
            by_place=found.by_place,
            by_rate=(csc_array(found.by_rate[0] + J.T @ blocks @ J), by_rate),
            by_acceleration=found.by_acceleration,
            slopes=found.slopes,
            system=found.system,
        )

    def accelerations(self, motion: Motion) -> Array:
        """That belong to places and rates, all forces as they are there."""
        none: Mixed = *self.problem.extrapolated(motion.y[:-HUB], 0.0 * motion.y[:-HUB]), motion.pressed
        found = self.linearised(motion.y, motion.v, 0.0 * motion.a, none)
        held = -found.system.stiffness * np.minimum(found.system.gaps, 0.0)
        right = -(found.residual - found.slopes.T @ held)
        return Bordered(found.by_acceleration)(right)


class Bordered:
    """Solutions with a matrix of which the plates' part is sparse, the hub's rows and columns full and alike."""

    def __init__(self, matrix: tuple[csc_array, Array]) -> None:
        inner, border = matrix
        self._border, corner = border[:-HUB], border[-HUB:]
        self._factors = splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        self._over = self._factors.solve(self._border)
        self._corner = np.linalg.inv(corner - self._border.T @ self._over)

    def __call__(self, right: Array) -> Array:
        """Of vectors (n,) or columns (n, j)."""
        own = self._factors.solve(np.ascontiguousarray(right[:-HUB]))
        hub = self._corner @ (right[-HUB:] - self._border.T @ own)
        return np.concatenate([own - self._over @ hub, hub])


def _rotation(theta: float) -> Array:
    """Rows: world axes in the hub's frame."""
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
