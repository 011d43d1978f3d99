"""Natural modes of an ANCF wheel: free, its hub held, or standing on its ground under a load.

Small motions about a state have the coordinates (s, h): those of plates on a hub at rest, and six of the hub, which
take plates and hub along as a rigid body, u = T s + R h. Stresses do not change under h, so that the stiffness is that
of s alone; the mass couples both,

    M = [T^T m T, T^T m R; R^T m T, R^T m R + m_hub],

m of plates. Held or standing, h = 0; touching points keep touching and slide freely.
Verified by tests/verification/test_ancf_wheel_vibration.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh, splu

from ancf_reduced.wheel.mesh import AncfWheel
from ancf_reduced.wheel.rubbing import congruent
from ancf_reduced.wheel.static import Equilibrium, Mixed, System, WheelOnGround
from contracts.errors import ConvergenceError, InputError
from contracts.modes import Modes

__all__ = ["node_shapes", "standing_under", "wheel_modes"]

Array = NDArray[np.float64]
_SLOW = 1e-2
"""Root of the shift's size, over the time of a wave across the wheel."""
_SPARE, _TRIES, _GAP = 6, 4, 1e-4
"""Eigenvalues found beyond those wanted; attempts, each for twice as many; least relative gap to count in."""
_AWAY = 1e-3
"""How far the ground is from a wheel that does not stand on it [m]."""
_FIRST, _LONGEST, _CLOSE, _STEPS = 1e-3, 6e-3, 1e-4, 60
"""First and longest step of the ground [m]; difference of the load [-] at which it is met; most steps."""


def wheel_modes(
    problem: WheelOnGround,
    count: int,
    *,
    state: Equilibrium | None = None,
    hub: Array | None = None,
    grip: bool = False,
) -> tuple[Modes, Array]:
    """The lowest modes of a wheel, besides those of a rigid body, and their coordinates.

    Parameters
    ----------
    problem : the whole width, without friction
    count : of modes
    state : in which it stands; without it, it is held at its hub and touches no ground
    hub : mass matrix (6, 6) of the hub, by translations along the axes and turns about the origin, for a free wheel
        without ``state`` [kg; kg m; kg m^2]
    grip : whether points that touch the ground stick to it, as stiffly as they are held off; else they slide freely

    Returns
    -------
    modes : at the nodes
    shapes : (n, n_nodes, 4, 3) of all nodes' vectors

    Raises
    ------
    InputError
        For half a wheel, friction, a free wheel that stands, and a count that is too large.
    ConvergenceError
        If modes are not found.

    Verified by tests/verification/test_ancf_wheel_vibration.py.
    """
    wheel = problem.wheel
    if wheel.sides != 1.0:
        rule = "has no odd modes"
        raise InputError("ANCF wheel", "half the width", rule, "build the full width (half_width = false)")
    if problem.friction != 0.0:
        told = f"{problem.friction:g}"
        raise InputError("friction coefficient", told, "has no symmetric stiffness", "leave friction away")
    if state is not None and hub is not None:
        raise InputError("free wheel", "under a load", "is none", "leave out the hub's mass or the state")
    linear = _Linear(problem, state, hub, grip=grip)
    loose = 0 if hub is None else 6
    if not 0 < count < linear.size - loose - 1:
        raise InputError("number of modes", count, f"must lie between 1 and {linear.size - loose - 2}", "ask for 10")
    values, vectors = _lowest(linear, count + loose)
    momentum = linear.momentum()
    if loose:
        rigid = np.vstack([np.zeros((linear.size - 6, 6)), np.eye(6)])
        values, vectors = _told_apart(values, vectors, linear, rigid)
    moving = np.array([float(one @ linear.mass_solve(one)) for one in momentum.T])
    shapes = np.array([linear.nodal(vector) for vector in vectors.T])
    places = 12 * np.arange(len(wheel.plates.reference))[:, None] + np.arange(3)
    modes = Modes(
        eigenvalue=values,
        shape=shapes[:, :, 0],
        points=wheel.plates.reference[:, 0],
        weight=linear.mass.diagonal()[places[:, 0]],
        participation=vectors.T @ momentum,
        moving=moving,
        whole=np.diag(linear.rigid.T @ (linear.mass @ linear.rigid)) + (0.0 if hub is None else np.diag(hub)),
        rigid=np.arange(len(values)) < loose,
        parity=np.array([_parity(wheel, shape[:, 0]) for shape in shapes]),
    )
    return modes, shapes


def standing_under(problem: WheelOnGround, load: float) -> Equilibrium:
    """The equilibrium in which the wheel bears a load [N]; InputError and ConvergenceError where there is none."""
    if not (math.isfinite(load) and load > 0.0):
        raise InputError("load", f"{load:g} N", "must be > 0 for a wheel that stands", "200 N is usual")
    points, longest = [problem.unloaded()], _LONGEST
    goal = _FIRST
    for _ in range(_STEPS):
        nearest = max((p for p in points if p.deflection < goal), key=lambda p: p.deflection)
        found = problem.solve(goal, nearest)
        if not isinstance(found, Equilibrium):
            longest = 0.5 * (goal - nearest.deflection)
            if longest < 1e-5:
                break
            goal = nearest.deflection + longest
            continue
        points.append(found)
        if abs(found.load - load) <= _CLOSE * load:
            return found
        low = max((p for p in points if p.load < load), key=lambda p: p.deflection)
        above = [p for p in points if p.load > load]
        if above:
            high = min(above, key=lambda p: p.deflection)
            share = min(max((load - low.load) / (high.load - low.load), 0.02), 0.98)
            goal = low.deflection + share * (high.deflection - low.deflection)
        else:
            before = points[-2]
            slope = (found.load - before.load) / (found.deflection - before.deflection)
            goal = found.deflection + (min(longest, (load - found.load) / slope) if slope > 0.0 else longest)
    told = f"{points[-1].load:.4g} N at {1e3 * points[-1].deflection:.4g} mm"
    raise ConvergenceError(f"ANCF wheel: it does not come to stand under {load:g} N: {told}", [], points[-1])


def node_shapes(wheel: AncfWheel, plate: NDArray[np.int64], rows: Array, shape: Array) -> Array:
    """Displacement (n, 3) of points of plates, with rows (n, 16) of shape functions, in a mode (n_nodes, 4, 3)."""
    local = shape[wheel.plates.plates[plate]].reshape(len(plate), 16, 3)
    return np.asarray(np.einsum("nk,nki->ni", rows, local))


class _Linear:
    """Stiffness and mass about a state, in coordinates (s, h) or s alone."""

    def __init__(self, problem: WheelOnGround, state: Equilibrium | None, hub: Array | None, *, grip: bool) -> None:
        wheel, rest = problem.wheel, state or problem.unloaded()
        plates = wheel.plates
        self._T, self.mass = wheel.basis, plates.mass()
        self.rigid = _rigid(wheel.coordinates(rest.free))
        mixed: Mixed = *problem.extrapolated(rest.free, 0.0 * rest.free), np.concatenate([rest.pressed, rest.inner])
        pose = problem.ground.risen(-_AWAY if state is None else rest.deflection)
        system = problem.linearised(rest.free, pose, mixed)
        touching = np.flatnonzero(system.gaps < 0.0)
        G, k = system.slopes[touching], system.stiffness[touching]
        self.K = csc_array(system.tangent + G.T @ csr_array(G * k[:, None]))
        if grip:
            self.K = csc_array(self.K + _gripping(problem, rest, system))
        self.own = csc_array(self._T.T @ self.mass @ self._T)
        columns = self.rigid if hub is not None else np.zeros((len(self.rigid), 0))
        self.border = np.asarray(self._T.T @ (self.mass @ columns))
        self.corner = np.asarray(columns.T @ (self.mass @ columns)) + (0.0 if hub is None else hub)
        self._hub, self._columns = hub, columns
        fastest = max(
            layer.material.young_modulus / layer.material.density for layers in set(plates.layers) for layer in layers
        )
        self.shift = -(_SLOW**2) * fastest / float((np.ptp(plates.reference[:, 0], axis=0) ** 2).sum())
        self._inverse: _Bordered | None = None

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(sum(self.border.shape))

    def times_mass(self, x: Array) -> Array:
        """M x, of a vector or columns."""
        n = self.own.shape[0]
        s, h = x[:n], x[n:]
        return np.concatenate([self.own @ s + self.border @ h, self.border.T @ s + self.corner @ h])

    def shifted(self, shift: float) -> _Bordered:
        """K - shift M."""
        return _Bordered(csc_array(self.K - shift * self.own), -shift * self.border, -shift * self.corner)

    def mass_solve(self, right: Array) -> Array:
        """M^-1 times a vector."""
        if self._inverse is None:
            self._inverse = _Bordered(self.own, self.border, self.corner)
        return self._inverse(right)

    def momentum(self) -> Array:
        """What the body has in rigid motion, by the coordinates, (n, 6)."""
        heavy = self.mass @ self.rigid
        below = self._columns.T @ heavy + (np.zeros((0, 6)) if self._hub is None else self._hub)
        return np.concatenate([self._T.T @ heavy, below])

    def nodal(self, vector: Array) -> Array:
        """Coordinates (n,) at the nodes (n_nodes, 4, 3)."""
        n = self.own.shape[0]
        return np.asarray(self._T @ vector[:n] + self._columns @ vector[n:]).reshape(-1, 4, 3)


class _Bordered:
    """Solutions with a symmetric sparse matrix that a few full rows and columns border."""

    def __init__(self, inner: csc_array, border: Array, corner: Array) -> None:
        self._factors = splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        self._over, self._n = self._factors.solve(border) if border.shape[1] else border, len(border)
        self._border, self._corner = border, corner - border.T @ self._over

    @property
    def negative(self) -> int:
        """Negative eigenvalues, by Sylvester's law of inertia."""
        corner = int((np.linalg.eigvalsh(self._corner) < 0.0).sum()) if len(self._corner) else 0
        return int((self._factors.U.diagonal() < 0.0).sum()) + corner

    def __call__(self, right: Array) -> Array:
        right = right.ravel()
        own = self._factors.solve(np.ascontiguousarray(right[: self._n]))
        if not len(self._corner):
            return np.asarray(own)
        rest = np.linalg.solve(self._corner, right[self._n :] - self._border.T @ own)
        return np.concatenate([own - self._over @ rest, rest])


def _lowest(linear: _Linear, count: int) -> tuple[Array, Array]:
    """Eigenvalues, ascending, and vectors of unit modal mass; as many lie below as the tangent's inertia says."""
    size, wanted = linear.size, count + _SPARE
    solve = linear.shifted(linear.shift)
    shape = (size, size)
    mass = LinearOperator(shape, matvec=lambda x: linear.times_mass(x.ravel()), dtype=np.float64)
    inverse = LinearOperator(shape, matvec=solve, dtype=np.float64)
    unused = LinearOperator(shape, matvec=lambda x: x, dtype=np.float64)
    for _ in range(_TRIES):
        wanted = min(wanted, size - 1)
        start = np.random.default_rng(wanted).normal(size=size)
        try:
            values, vectors = eigsh(unused, k=wanted, M=mass, sigma=linear.shift, OPinv=inverse, v0=start)
        except ArpackNoConvergence as error:
            raise ConvergenceError(f"natural modes are not found: {error}; ask for fewer", []) from error
        order = np.argsort(values)
        values, vectors = values[order], vectors[:, order]
        ahead = np.diff(values[count - 1 :]) / np.maximum(np.abs(values[count:]), abs(linear.shift))
        found = count + (int(np.flatnonzero(ahead > _GAP)[0]) if (ahead > _GAP).any() else 0)
        if linear.shifted(0.5 * float(values[found - 1] + values[found])).negative == found:
            return values[:count], vectors[:, :count]
        wanted *= 2
    raise ConvergenceError(f"natural modes are not found: the lowest {count} are not complete; ask for others", [])


def _told_apart(values: Array, vectors: Array, linear: _Linear, rigid: Array) -> tuple[Array, Array]:
    """Rigid modes first: translations along the axes, then turns about the centre of mass; the others as they are."""
    found = list[Array]()
    for motion in rigid.T:
        one = motion.copy()
        for before in found:
            one -= (before @ linear.times_mass(one)) * before
        found.append(one / np.sqrt(one @ linear.times_mass(one)))
    share = ((np.array(found) @ linear.times_mass(vectors)) ** 2).sum(axis=0)
    of_body = share > 0.99
    if of_body.sum() != len(found):
        told = f"{int(of_body.sum())} of {len(found)} motions of a rigid body are among the modes"
        raise ConvergenceError(f"natural modes: {told}; look for a part that nothing holds", [])
    return np.concatenate([values[of_body], values[~of_body]]), np.column_stack([*found, vectors[:, ~of_body]])


def _gripping(problem: WheelOnGround, state: Equilibrium, system: System) -> csc_array:
    """k (I - n n^T) of the points that touch the ground, (n_free, n_free) [N/m]."""
    ground = system.ground
    assert ground.surface is not None
    touch = np.flatnonzero(ground.gaps < 0.0)
    normals, T = ground.surface.normals[touch], problem.wheel.basis
    along = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    ways = problem.ground.slopes(problem.wheel.coordinates(state.free), ground.points[touch])
    return csc_array(congruent(csr_array(ways @ T), ground.stiffness[touch, None, None] * along))


def _rigid(q: Array) -> Array:
    """Rigid motions (12 n_nodes, 6) of nodes q (n_nodes, 4, 3): translations of places, turns about the origin."""
    found = np.zeros((6, *q.shape))
    for k, axis in enumerate(np.eye(3)):
        found[k, :, 0] = axis
        found[3 + k] = np.cross(axis, q)
    return found.reshape(6, -1).T


def _parity(wheel: AncfWheel, shape: Array) -> int:
    """1 for a shape (n_nodes, 3) that is even about y = 0, -1 if it is odd, 0 where there is no mirror image."""
    places = wheel.plates.reference[:, 0]
    key, mirrored = (np.round(p / 1e-7).astype(np.int64) for p in (places, places * [1.0, -1.0, 1.0]))
    numbers = {tuple(one): n for n, one in enumerate(key.tolist())}
    images = np.array([numbers.get(tuple(one), -1) for one in mirrored.tolist()])
    there = images >= 0
    other = shape[images[there]] * [1.0, -1.0, 1.0]
    even, odd = (float(np.linalg.norm(shape[there] + sign * other)) for sign in (1.0, -1.0))
    return 0 if not there.any() or min(even, odd) > 0.1 * max(even, odd) else 1 if even > odd else -1
