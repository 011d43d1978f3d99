"""Whether an ANCF wheel stands: the mode in which it does not, and its path beyond folds and branches.

Verified by tests/verification/test_ancf_path.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import eigsh

from ancf_reduced.wheel.path import Contacts, Linear, PathPoint, follow
from ancf_reduced.wheel.static import Equilibrium, Mixed, WheelOnGround
from contracts.errors import InputError

__all__ = ["Unstable", "press_along", "press_buckled", "unstable_mode"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Unstable:
    """The way in which a wheel held at its hub leaves an equilibrium that does not last.

    Attributes
    ----------
    growth : square of its rate, minus the lowest eigenvalue of tangent over mass [1/s^2]
    shape : (n_free,) the mode
    part : of the node that moves most
    angle_deg, radius : where that node is, circumferential position of the wheel [deg] and distance from the axle [m]
    """

    growth: float
    shape: Array
    part: str
    angle_deg: float
    radius: float


class _Pressed:
    """The wheel on its ground as `follow` takes it, pushed by forces (n_free,); the parameter is the deflection [m]."""

    def __init__(self, problem: WheelOnGround, push: Array) -> None:
        self._problem, self.push = problem, push
        self.places = csr_array(problem.wheel.basis)[_places(problem)]

    def linearised(self, free: Array, parameter: float, mixed: Mixed) -> Linear:
        """The ground's pose is the parameter's."""
        problem = self._problem
        pose = problem.ground.risen(parameter)
        system = problem.linearised(free, pose, mixed)
        lift = np.zeros(len(system.gaps))
        lift[: len(system.ground.points)] = problem.lift(system.ground, pose)
        return Linear(
            residual=system.residual - self.push,
            tangent=system.tangent,
            rate=np.zeros(len(free)),
            energy=system.energy,
            contacts=Contacts(
                gaps=system.gaps,
                rate=-lift,
                slopes=system.slopes,
                stiffness=system.stiffness,
                touching=mixed[2][system.near] > 0.0,
            ),
            memory=system.near,
        )

    def extrapolated(self, free: Array, step: Array, gaps: Array, linear: Linear) -> Mixed:
        """Contacts press as far as the gaps are below zero."""
        return *self._problem.extrapolated(free, step), self._forces(linear, gaps)

    def _forces(self, linear: Linear, gaps: Array) -> Array:
        """Of all contacts [N]."""
        pressed = np.zeros(sum(self._problem.counts))
        pressed[linear.memory] = -linear.contacts.stiffness * np.minimum(gaps, 0.0)
        return pressed

    def equilibrium(self, point: PathPoint) -> Equilibrium:
        """The point as one of a curve."""
        linear = self.linearised(point.free, point.parameter, point.mixed)
        pressed = self._forces(linear, linear.contacts.gaps)
        ground, sides = self._problem.ground.count, self._problem.wheel.sides
        return Equilibrium(
            deflection=point.parameter,
            load=-sides * float(pressed[linear.memory] @ linear.contacts.rate),
            energy=sides * point.energy,
            free=point.free,
            pressed=pressed[:ground],
            pull=np.zeros((ground, 3)),
            inner=pressed[ground:],
            negative=point.negative,
            residuals=(0.0,) * (point.solves + 1),
        )


def press_along(problem: WheelOnGround, start: Equilibrium, arc: float) -> Iterator[Equilibrium]:
    """Equilibria along a wheel's path, its deflection free to fall, without end.

    Parameters
    ----------
    start : a loaded equilibrium of the same problem
    arc : way between them, root of the sum of all nodes' squares [m]

    Raises
    ------
    InputError
        For a wheel that carries nothing at the start, for friction, and as `follow` does.
    ConvergenceError
        Where no further point is found.
    """
    if not start.load > 0.0:
        raise InputError("load at the start", f"{start.load:g} N", "must be > 0", "press the wheel a little first")
    _without_friction(problem)
    body = _Pressed(problem, np.zeros_like(start.free))
    for point in follow(body, (start.free, start.deflection, _mixed(problem, start)), arc):
        yield body.equilibrium(point)


def press_buckled(
    problem: WheelOnGround, stands: Equilibrium, falls: Equilibrium, arc: float, push: float = 1e-2
) -> Iterator[Equilibrium]:
    """Equilibria of the path that branches off between one that stands and one that does not, without end.

    A small force in the direction of the mode leads there; each point is then found again without it. Points at which
    the wheel without it has no equilibrium nearby, as where the branch leaves, are left out.

    Parameters
    ----------
    stands, falls : without and with a negative eigenvalue, the second further down; else as `press_along`
    push : sum of the forces on all nodes over the load of ``stands`` [-]
    """
    if stands.negative or not falls.negative or not stands.deflection < falls.deflection:
        told = (
            f"{stands.negative} and {falls.negative} at {1e3 * stands.deflection:g} and {1e3 * falls.deflection:g} mm"
        )
        raise InputError("negative eigenvalues", told, "must be none, then some", "give points on both sides")
    _without_friction(problem)
    mode = unstable_mode(problem, falls)
    assert mode is not None
    body = _Pressed(problem, np.zeros_like(stands.free))
    moved = body.places @ mode.shape
    whole = np.linalg.norm(moved.reshape(-1, 3), axis=1).sum()
    body.push = push * stands.load / whole * (body.places.T @ moved)
    for point in follow(body, (stands.free, stands.deflection, _mixed(problem, stands)), arc):
        found = problem.solve(point.parameter, body.equilibrium(point))
        if isinstance(found, Equilibrium):
            yield found


def unstable_mode(problem: WheelOnGround, state: Equilibrium) -> Unstable | None:
    """The mode that grows fastest at an equilibrium, its deflection held; None where the wheel stands."""
    if state.negative == 0:
        return None
    linear = _Pressed(problem, np.zeros_like(state.free)).linearised(
        state.free, state.deflection, _mixed(problem, state)
    )
    T, plates = problem.wheel.basis, problem.wheel.plates
    mass, begin = csc_array(T.T @ plates.mass() @ T), np.ones(T.shape[1])
    touching = linear.contacts.gaps < 0.0
    G, k = linear.contacts.slopes[np.flatnonzero(touching)], linear.contacts.stiffness[touching]
    tangent = csc_array(linear.tangent + G.T @ csr_array(G * k[:, None]))
    values, modes = eigsh(tangent, k=state.negative, M=mass, sigma=0.0, which="SA", v0=begin)
    lowest = modes[:, values.argmin()]
    moved = np.linalg.norm((T @ lowest).reshape(plates.reference.shape)[:, 0], axis=1)
    node = int(moved.argmax())
    x, _, z = plates.reference[node, 0]
    return Unstable(
        growth=-float(values.min()),
        shape=lowest,
        part=str(problem.wheel.parts[np.flatnonzero((plates.plates == node).any(axis=1))[0]]),
        angle_deg=float(np.degrees(np.arctan2(x, -z)) % 360.0),
        radius=float(np.hypot(x, z)),
    )


def _without_friction(problem: WheelOnGround) -> None:
    """What a path's friction does depends on the way along it: there is none here."""
    if problem.friction != 0.0:
        told = f"{problem.friction:g}"
        raise InputError("friction coefficient", told, "is not followed along a path", "leave friction away")


def _mixed(problem: WheelOnGround, state: Equilibrium) -> Mixed:
    held = np.concatenate([state.pressed, state.inner])
    return *problem.extrapolated(state.free, 0.0 * state.free), held


def _places(problem: WheelOnGround) -> NDArray[np.int64]:
    """Numbers of the coordinates that are places."""
    places = np.zeros(problem.wheel.plates.reference.shape, dtype=bool)
    places[:, 0] = True
    return np.flatnonzero(places.ravel())
