"""Equilibria along a path that turns back: arc length.

The parameter (a deflection, a share of a load) is one more unknown; each point lies a given way of the nodes from the
one before, measured along the path's tangent (Riks 1979, from memory; cylindrical as Crisfield 1981, from memory: the
parameter does not count), contacts settled within each step. Where stability is lost the tangent's negative
eigenvalues change; at limit points of the parameter its rate changes sign.

Verified by tests/verification/test_ancf_path.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import SuperLU, splu

from contracts.errors import ConvergenceError, InputError

__all__ = ["Body", "Linear", "PathPoint", "follow"]

Array = NDArray[np.float64]
_LIMIT = 25
"""Linear solves a point."""
_FEW, _GROWTH = 5, 1.5
"""After a point of no more solves than the first the next lies further by the second."""
_ASTRAY = 1e6
"""Work of the residual over the strain energy from which no iteration has come back [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contacts:
    """What may touch within a step.

    Attributes
    ----------
    gaps, rate : (m,) and by the parameter [m]
    slopes : (m, n) by free coordinates
    stiffness : penalties (m,) [N/m]
    touching : (m,) first guess
    """

    gaps: Array
    rate: Array
    slopes: csr_array
    stiffness: Array
    touching: NDArray[np.bool_]

    def after(self, step: Array, along: float) -> Array:
        """Gaps (m,) a step and a change of the parameter later, linearised [m]."""
        return np.asarray(self.gaps + self.slopes @ step + along * self.rate)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Linear:
    """A body about a state, without its contacts: residual R (n,), tangent (n, n), dR/dparameter (n,), energy [J].

    Attributes
    ----------
    memory : what `Body.linearised` left for `Body.extrapolated`
    """

    residual: Array
    tangent: csc_array
    rate: Array
    energy: float
    contacts: Contacts
    memory: Any = None

    def out_of_balance(self) -> Array:
        """Residual (n,) with what contacts press."""
        held = np.minimum(self.contacts.gaps, 0.0)
        return np.asarray(self.residual + self.contacts.slopes.T @ (self.contacts.stiffness * held))


class Body(Protocol):
    """What can be followed.

    Attributes
    ----------
    places : picks the nodes' places from free coordinates (3 n_nodes, n)
    """

    places: csr_array

    def linearised(self, free: Array, parameter: float, mixed: Any) -> Linear:
        """About free coordinates (n,) and a parameter; stresses of the geometric part as `extrapolated` left them."""

    def extrapolated(self, free: Array, step: Array, gaps: Array, linear: Linear) -> Any:
        """Stresses and contact forces after a step (n,) that leaves the gaps as they are given."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PathPoint:
    """An equilibrium.

    Attributes
    ----------
    parameter, rate : and its derivative by the way of the nodes, negative where the path turns back
    free : (n,) coordinates
    mixed : stresses and contact forces as `Body.extrapolated` has them
    energy : strain energy [J]
    negative : negative eigenvalues of the tangent at a fixed parameter
    solves : linear solves it took
    """

    parameter: float
    rate: float
    free: Array
    mixed: Any
    energy: float
    negative: int
    solves: int


def follow(
    body: Body,
    start: tuple[Array, float, Any],
    arc: float,
    *,
    back: bool = False,
    tolerance: float = 1e-10,
    smallest: float = 1e-4,
) -> Iterator[PathPoint]:
    """Equilibria along a path, without end.

    Parameters
    ----------
    start : free coordinates (n,), parameter, stresses and contact forces of an equilibrium
    arc : way between points, root of the sum of all nodes' squares [m]; it grows to four times as much and is halved
    back : begins with a parameter that falls
    tolerance : work of the residual over the strain energy
    smallest : share of ``arc`` below which it is given up

    Raises
    ------
    InputError
        For an arc that is not positive.
    ConvergenceError
        Where no further point is found; with the last one.
    """
    if not (np.isfinite(arc) and arc > 0.0):
        raise InputError("arc length", f"{arc:g} m", "must be finite and > 0", "some 0.01 m for a wheel")
    run, way = _Run(body, tolerance), arc
    here = run.begin(*start, back=back)
    while True:
        found = run.next(here, way)
        if found is None:
            way *= 0.5
            if way < smallest * arc:
                told = f"no equilibrium found along the path from the parameter {here.point.parameter:.6g} on"
                raise ConvergenceError(told, [], here.point)
            continue
        here = found
        yield here.point
        way = min(_GROWTH * way, 4.0 * arc) if here.point.solves <= _FEW else way


@dataclass(frozen=True, slots=True, eq=False)
class _Solved:
    """A linearisation with a set of touching contacts: factors, steps of the residual and of a unit of parameter."""

    factors: SuperLU
    own: Array
    by: Array


def _solved(linear: Linear, touching: NDArray[np.bool_]) -> _Solved:
    """Raises RuntimeError where the tangent is singular."""
    one = linear.contacts
    G, k = one.slopes[np.flatnonzero(touching)], one.stiffness[touching]
    tangent = csc_array(linear.tangent + G.T @ csr_array(G * k[:, None]))
    factors = splu(tangent, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    own = factors.solve(-(linear.residual + G.T @ (k * one.gaps[touching])))
    return _Solved(factors, own, factors.solve(-(linear.rate + G.T @ (k * one.rate[touching]))))


@dataclass(frozen=True, slots=True, eq=False)
class _Here:
    """A point with its linearisation, solved with the contacts that touch there, and the way on, of unit length."""

    point: PathPoint
    linear: Linear
    solved: _Solved
    ahead: Array


class _Run:
    def __init__(self, body: Body, tolerance: float) -> None:
        self._body, self._tolerance = body, tolerance

    def begin(self, free: Array, parameter: float, mixed: Any, *, back: bool) -> _Here:
        linear = self._body.linearised(free, parameter, mixed)
        return self._at((free, parameter, mixed), linear, 0, lambda onwards: -1.0 if back else 1.0)

    def _at(
        self, state: tuple[Array, float, Any], linear: Linear, solves: int, sense: Callable[[Array], float]
    ) -> _Here:
        """sense : of a direction (n,), positive if it leads on"""
        solved = _solved(linear, linear.contacts.touching)
        rate = 1.0 / float(np.linalg.norm(self._body.places @ solved.by))
        rate = rate if sense(solved.by) >= 0.0 else -rate
        point = PathPoint(
            parameter=state[1],
            rate=rate,
            free=state[0],
            mixed=state[2],
            energy=linear.energy,
            negative=int((solved.factors.U.diagonal() < 0.0).sum()),
            solves=solves,
        )
        return _Here(point, linear, solved, rate * solved.by)

    def next(self, here: _Here, way: float) -> _Here | None:
        """The point that lies ``way`` ahead [m]; None if it is not found."""
        body, linear = self._body, here.linear
        plane = body.places.T @ (body.places @ here.ahead)
        found = _settled(linear, plane, way, here.solved)
        free, parameter, solves = here.point.free, here.point.parameter, 0
        while found is not None and solves <= _LIMIT:
            step, along, gaps, count = found
            mixed = body.extrapolated(free, step, gaps, linear)
            free, parameter, solves = free + step, parameter + along, solves + count
            linear = body.linearised(free, parameter, mixed)
            found = _settled(linear, plane, 0.0)
            if found is None:
                break
            work = abs(float(linear.out_of_balance() @ found[0])) / max(abs(linear.energy), abs(here.linear.energy))
            if work < self._tolerance:
                moved = body.places.T @ (body.places @ (free - here.point.free))
                return self._at((free, parameter, mixed), linear, solves + found[3], moved.dot)
            if not work < _ASTRAY:
                break
        return None


def _settled(
    linear: Linear, plane: Array, way: float, known: _Solved | None = None
) -> tuple[Array, float, Array, int] | None:
    """Step (n,), change of the parameter, gaps after both, new solves: plane . step = way, contacts consistent.

    known : solved with the first guess of contacts
    """
    touching, seen, count = linear.contacts.touching, set[bytes](), 0
    while touching.tobytes() not in seen:
        seen.add(touching.tobytes())
        try:
            solved = known or _solved(linear, touching)
        except RuntimeError:  # singular
            return None
        count, known = count + (known is None), None
        across = float(plane @ solved.by)
        if across == 0.0 or not np.isfinite(across):  # nothing touches
            return None
        along = (way - float(plane @ solved.own)) / across
        step = solved.own + along * solved.by
        gaps = linear.contacts.after(step, along)
        if np.array_equal(gaps < 0.0, touching):
            return step, along, gaps, count
        touching = gaps < 0.0
    return None
