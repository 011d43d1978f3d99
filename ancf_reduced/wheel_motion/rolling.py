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

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, eye_array, hstack, kron
from scipy.sparse.linalg import eigsh

from ancf_reduced.wheel.contacts import Near
from ancf_reduced.wheel.static import Mixed, System, WheelOnGround
from ancf_reduced.wheel_motion.bordered import HUB, Bordered
from ancf_reduced.wheel_motion.friction import Friction, Pressed, Rubbing
from ancf_reduced.wheel_motion.state import Hub, Linearised, Motion
from contracts.errors import InputError

__all__ = ["ABOUT_AXLE", "Hub", "Linearised", "Motion", "RollingWheel"]

Array = NDArray[np.float64]
Held = tuple[Array, NDArray[np.int64]]
ABOUT_AXLE = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
"""E: what e_y x does to a vector."""
_RUBBING = 0.1e-3
"""Gap below which the ground's friction on a point is in the equations [m]."""
_FAR = 1e3
"""Height at which no ground is near [m]."""


class RollingWheel:
    """A wheel with a hub on ground, in the plane of the wheel.

    Parameters
    ----------
    problem : the wheel on its ground without camber; its terrain is the world's
    hub : mass, inertia and drive
    gravity : downwards [m/s^2]
    friction : on the ground
    damping_ratio : of the first mode with the hub held [-]; stresses in proportion to rates of strain (Kelvin & Voigt)
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
        if problem.camber != 0.0:
            raise InputError("camber", f"{problem.camber:g} rad", "must be 0 for a wheel that rolls", "leave it out")
        self.problem, self.hub, self.friction, self.gravity = problem, hub, friction or Friction(), gravity
        wheel = problem.wheel
        self.sides, self.basis = wheel.sides, wheel.basis
        self._hub = hub.mass / wheel.sides, hub.inertia / wheel.sides
        self._mass = wheel.plates.mass()
        nodes = wheel.plates.reference.shape
        ones = np.zeros(nodes)
        ones[:, 0, :] = 1.0
        self._ones = [(ones * axis).ravel() for axis in np.eye(3)]
        self._turn = csr_array(kron(eye_array(nodes[0] * nodes[1]), ABOUT_AXLE))
        T = self.basis
        self.own_mass = csc_array(T.T @ self._mass @ T)
        self._plates = float(self._ones[0] @ (self._mass @ self._ones[0]))
        rest = np.zeros(T.shape[1])
        none: Mixed = *problem.extrapolated(rest, rest), np.zeros(sum(problem.counts))
        self.stiffness = problem.linearised(rest, self._pose(np.array([0.0, _FAR, 0.0])), none).tangent
        self._viscosity = 0.0 if damping_ratio == 0.0 else 2.0 * damping_ratio / self.first_frequency()

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.basis.shape[1]) + HUB

    @property
    def mass(self) -> float:
        """Of plates and hub, of the whole wheel [kg]."""
        return self.hub.mass + self.sides * self._plates

    def first_frequency(self) -> float:
        """Angular frequency of the first mode of the free wheel, its hub held [rad/s]."""
        begin, n = np.ones(self.size - HUB), self.stiffness
        square = eigsh(n, k=1, M=self.own_mass, sigma=0.0, v0=begin, return_eigenvectors=False)
        return float(np.sqrt(square[0]))

    def damping(self, y: Array) -> csc_array:
        """By rates of strain at coordinates y (n_free, n_free) [N s/m and alike]."""
        if self._viscosity == 0.0:
            return csc_array((self.size - HUB, self.size - HUB))
        return csc_array(self._viscosity * self.problem.material_tangent(y[:-HUB]))

    def linearised(self, motion: Motion, mixed: Mixed, damping: csc_array, pull: Array | None = None) -> Linearised:
        """The equations about a state.

        mixed : as `WheelOnGround.linearised`; damping : as it is there or near; pull : of the ground at all its
        contacts (n_ground, 3) [-] as the Newton step before found it, or None
        """
        y, v, a = motion.y, motion.v, motion.a
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
        drive = self.hub.gain / self.sides * (self.hub.speed - omega)
        borders = np.stack([ahead, up, Ep], axis=1)
        ends = np.array([m * a[-3], m * (a[-2] + self.gravity), inertia * turning - drive]) + borders.T @ moving
        residual = np.concatenate([T.T @ moving + system.residual + damping @ v[:-HUB], ends])
        heavy = M @ borders
        hub_mass = np.concatenate([T.T @ heavy, borders.T @ heavy + np.diag([m, m, inertia])])
        inner, by_rate = damping, np.zeros((self.size, HUB))
        by_rate[-1, -1] = self.hub.gain / self.sides
        slopes, place = self._contacts(y, system, mixed[2])
        close = system.ground.gaps < (-np.inf if pull is None else _RUBBING)
        rubs = np.flatnonzero((mixed[2][system.ground.points] > 0.0) | close)
        rubbing, push = self._rubbing(motion, system.ground, (mixed[2], rubs), pull), slopes
        if rubbing is not None:
            push = push + rubbing.leaning(rubs, len(system.gaps))
            more, border = rubbing.by_rate()
            inner, by_rate = inner + more, by_rate + border
        return Linearised(
            residual=residual,
            by_place=(system.tangent, place),
            by_rate=(csc_array(inner), by_rate),
            by_acceleration=(self.own_mass, hub_mass),
            slopes=slopes,
            push=csr_array(push),
            rubbing=rubbing,
            rubs=rubs,
            damping=damping,
            system=system,
        )

    def accelerations(self, motion: Motion) -> Array:
        """That belong to places and rates (n_free + 3,), all forces as they are there."""
        at = Motion(time=motion.time, y=motion.y, v=motion.v, a=0.0 * motion.v, pressed=motion.pressed)
        found = self.linearised(at, self._mixed(motion), self.damping(motion.y))
        held = -found.system.stiffness * np.minimum(found.system.gaps, 0.0)
        return Bordered(found.by_acceleration)(found.push.T @ held - found.residual)

    def load(self, motion: Motion) -> Array:
        """Force of the ground on the whole wheel along world x and z (2,) [N], friction with it."""
        ground = self._near(motion)
        held = _held(ground, motion.pressed)
        points = self._pressed(motion.y, ground, held)
        force = points.force[:, None] * points.normals
        rubbing = self._rubbing(motion, ground, held)
        if rubbing is not None:
            force = force + rubbing.force
        return np.asarray(self.sides * (_rotation(float(motion.y[-1])) @ force.sum(axis=0))[[0, 2]])

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
        raised = float(up @ (self._mass @ p)) + (self._plates + m) * float(motion.y[-2])
        system, own = found.system, step[:-HUB]
        strain = system.energy + float(own @ (system.residual + 0.5 * (system.tangent @ own)))
        contact = 0.5 * float(system.stiffness @ np.minimum(system.gaps + found.slopes @ step, 0.0) ** 2)
        k = self.sides
        return k * kinetic, k * strain, k * self.gravity * raised, k * contact

    def powers(self, motion: Motion, found: Linearised) -> tuple[float, float, float]:
        """Of damping and friction (dissipated, >= 0) and of the drive [W], of the whole wheel."""
        damping = float(motion.v[:-HUB] @ (found.damping @ motion.v[:-HUB]))
        drive = self.hub.gain * (self.hub.speed - motion.v[-1]) * motion.v[-1]
        rubbing = self._rubbing(motion, found.system.ground, _held(found.system.ground, motion.pressed))
        friction = 0.0 if rubbing is None else rubbing.power
        return self.sides * damping, self.sides * friction, float(drive)

    def _axes(self, theta: float) -> tuple[Array, Array]:
        """World x and z for all nodes' places, in the hub's frame."""
        c, s = np.cos(theta), np.sin(theta)
        return c * self._ones[0] + s * self._ones[2], c * self._ones[2] - s * self._ones[0]

    def _pose(self, hub: Array) -> tuple[Array, Array]:
        """The world in the hub's frame."""
        return _rotation(float(hub[2])), np.array([-hub[0], 0.0, -hub[1]])

    def _mixed(self, motion: Motion) -> Mixed:
        own = motion.y[:-HUB]
        return *self.problem.extrapolated(own, 0.0 * own), motion.pressed

    def _near(self, motion: Motion) -> Near:
        """The ground's contacts at a state."""
        q = self.problem.wheel.coordinates(motion.y[:-HUB])
        forces = np.zeros(self.problem.counts[0])
        return self.problem.ground.near(q, self._pose(motion.y[-HUB:]), forces, np.empty((0, 16, 3, 16, 3)))

    def _contacts(self, y: Array, system: System, pressed: Array) -> tuple[csr_array, Array]:
        """Slopes of all gaps with the hub's columns; what the ground's forces add to the tangent's hub columns."""
        surface, count = system.ground.surface, len(system.ground.points)
        assert surface is not None
        hub = np.zeros((len(system.gaps), HUB))
        E_places, axes = surface.places @ ABOUT_AXLE.T, _rotation(float(y[-1]))[[0, 2]]
        hub[:count, :2] = surface.normals @ axes.T
        hub[:count, 2] = (surface.normals * E_places).sum(axis=1)
        slopes, place = csr_array(hstack([system.slopes, csr_array(hub)])), np.zeros((self.size, HUB))
        held = _held(system.ground, pressed)[1]
        if len(held):
            points = self._pressed(y, system.ground, (pressed, held))
            bends, normals = surface.bends[held], points.normals
            bent = bends @ points.ways
            bent[:, :, 2] += normals @ ABOUT_AXLE
            place[:-HUB] = -(points.slopes.T @ (points.force[:, None, None] * bent).reshape(-1, HUB))
            square = np.einsum("p,pik,pij,pjl->kl", points.force, points.ways, bends, points.ways)
            square[2, 2] += float(points.force @ (normals * (E_places[held] @ ABOUT_AXLE.T)).sum(axis=1))
            place[-HUB:] = -square
        return slopes, place

    def _pressed(self, y: Array, ground: Near, which: Held) -> Pressed:
        """Some of the points that are near the ground."""
        assert ground.surface is not None
        pressed, held = which
        axes = _rotation(float(y[-1]))[[0, 2]]
        ways = np.empty((len(held), 3, HUB))
        ways[:, :, 0], ways[:, :, 1], ways[:, :, 2] = axes[0], axes[1], ground.surface.places[held] @ ABOUT_AXLE.T
        q = self.problem.wheel.coordinates(y[:-HUB])
        slopes = csr_array(self.problem.ground.slopes(q, ground.points[held]) @ self.basis)
        force = pressed[ground.points[held]]
        return Pressed(force=force, normals=ground.surface.normals[held], slopes=slopes, ways=ways)

    def _rubbing(self, motion: Motion, ground: Near, which: Held, pull: Array | None = None) -> Rubbing | None:
        """Friction of the ground on some of the points near, if there is any."""
        if self.friction.coefficient == 0.0 or not len(which[1]):
            return None
        own = None if pull is None else pull[ground.points[which[1]]]
        return Rubbing.of(self.friction, self._pressed(motion.y, ground, which), motion.v, own)


def _held(ground: Near, pressed: Array) -> Held:
    """Forces of all contacts, and which of those near the ground are under pressure."""
    return pressed, np.flatnonzero(pressed[ground.points] > 0.0)


def _rotation(theta: float) -> Array:
    """Rows: world axes in the hub's frame."""
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
