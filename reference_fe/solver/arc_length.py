"""Follows equilibria along a path that turns back: the control parameter is one more unknown, arc length the condition.

From an equilibrium (u_0, c_0) with tangent K and derivative r of the residual by the control parameter c, the path goes
on along v = -K^-1 r (supports move with it). The next point lies at (u - u_0) . t = l, with t = +-v / |v|: the plane
that a step of length l along the tangent ends in, at right angles to it (Riks 1979, Wempner 1971, from memory;
cylindrical as Crisfield 1981, from memory: the control parameter does not count). Each Newton step solves with one
factorisation and two right-hand sides: du = -K^-1 R + dc v, dc from the plane. The sign of t is that of t . (u_0 -
u_-1): onwards, past limit points and branches alike. docs/theory/finite_elements.md, "Past limit points".

Verified by tests/verification/test_fe_arc_length.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from reference_fe.contact.surface_term import WildIterateError
from reference_fe.problem.control_rate import control_rate, depends_on_the_way
from reference_fe.problem.problem_state import ProblemState
from reference_fe.solver import process_sums
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.direct import SingularMatrixError
from reference_fe.solver.newton import NewtonOutcome, NewtonSolver

__all__ = ["ArcLength", "follow_path"]

type Array = NDArray[np.float64]

SMALLEST_FRACTION = 1.0 / 1024.0
"""An arc cut below this fraction of the first one ends the run."""
LARGEST_CHANGE = 2.0
"""By which an arc is lengthened from one point to the next at most; a failed one is halved."""
ROOM = 1.1
"""Chords to the point beyond the target, within which the state at the target must lie; else it is another path's."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcLength:
    """How far points of a path lie from each other.

    Attributes
    ----------
    first : change of the control parameter that the first arc would take if the body were linear [its unit]
    longest : longest arc over the first [-]
    widest : largest change of the control parameter along the tangent in one arc [its unit]
    iterations : Newton iterations that keep the arc as it is: n make it sqrt(iterations / n) times as long
    """

    first: float
    longest: float = 4.0
    widest: float = float("inf")
    iterations: int = 4

    def __post_init__(self) -> None:
        if not (np.isfinite(self.first) and self.first != 0.0):
            raise InputError("first arc", self.first, "must be finite and not zero", "a tenth of the full load, say")
        if not (np.isfinite(self.longest) and self.longest >= 1.0):
            raise InputError("longest arc", self.longest, "must be finite and at least 1", "4 is usual")
        if not self.widest > 0.0:
            raise InputError("widest change of an arc", self.widest, "must be > 0", "a tenth of the full load, say")
        if self.iterations < 1:
            raise InputError("iterations of an arc", self.iterations, "must be at least 1", "4 is usual")


def follow_path(
    solver: NewtonSolver,
    arc: ArcLength,
    history: list[IncrementRecord],
    attempt_limit: int = 1000,
    on_attempt: Callable[[IncrementRecord], None] | None = None,
    *,
    start: float = 0.0,
    target: float = float("inf"),
    first_arc: float | None = None,
) -> Iterator[ConvergedState]:
    """Yield equilibria along the path from the problem's present one; the caller may stop early.

    An arc that does not converge is halved from the last converged state; after a success it grows or shrinks with the
    iterations it took. Every attempt is appended to ``history``. The ``negative_pivots`` of an outcome are those of the
    tangent at the state itself: where they change, a limit point or a branch lies between.

    Parameters
    ----------
    start : control parameter of the present displacement, an equilibrium
    target : control parameter at which it ends, with a state exactly there, the first time the path passes it, from
        below or above
    first_arc : the first arc, root of the sum of the squares of all unknowns' changes [m]; None goes by ``arc.first``

    Raises
    ------
    InputError
        For material or contact with a memory (plastic flow, friction, multipliers), and soil, whose level parts are put
        right between solves: what they do depends on the way there, which is not known before it is gone. For a first
        arc that is not above zero.
    ConvergenceError
        When the arc falls below 1/1024 of the first, when ``history`` has ``attempt_limit`` attempts before the target
        is reached, or where the control parameter moves nothing; carries history.
    """
    problem = solver.problem
    if depends_on_the_way(problem):
        rule = "is followed along no path: what it does depends on the way there"
        raise InputError(
            "yielding material, friction, multipliers or soil", "", rule, "leave them away, or drive the load"
        )
    if first_arc is not None and not (np.isfinite(first_arc) and first_arc > 0.0):
        raise InputError("first arc", first_arc, "must be finite and > 0 m", "leave it out: it then goes by arc.first")
    problem.set_control(start)
    run, largest = _Run(solver, history), 0.0
    here = run.begin(start, way=arc.first)
    first = length = abs(arc.first / here.rate) if first_arc is None else first_arc
    while True:
        length = min(length, arc.widest / abs(here.rate))
        reached = run.attempt(here, length)
        rise = reached.control - here.control
        crossed = here.control < target <= reached.control or here.control > target >= reached.control
        passed = reached.outcome.converged and crossed
        if passed:
            reached = run.land(here, reached, target)
        did = reached.outcome
        record = IncrementRecord(target=reached.control, step=rise, converged=did.converged, residuals=did.residuals)
        history.append(record)
        if on_attempt is not None:
            on_attempt(record)
        if reached.outcome.converged:
            before, here = here.state, run.accept(here, reached)
            largest = max(largest, float(np.linalg.norm(problem.contact_force())))
            yield ConvergedState(
                control=here.control,
                wanted=passed,
                start=before,
                outcome=here.outcome,
                contact_force=problem.contact_force(),
                reaction=problem.reaction(here.outcome.residual),
            )
            if passed:
                return
            if len(history) >= attempt_limit:
                told = f"{len(history)} attempts end at control {here.control:.6g}, before the target"
                raise ConvergenceError(f"{told}; allow more attempts, or longer arcs", history)
            change = np.sqrt(arc.iterations / max(1, here.outcome.iterations))
            length = min(length * min(change, LARGEST_CHANGE), arc.longest * first)
            continue
        problem.restore(here.state)
        problem.set_control(here.control)
        length *= 0.5
        if length < SMALLEST_FRACTION * first or len(history) >= attempt_limit:
            raise ConvergenceError(_message(here, reached, problem.contact_force(), largest), history)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Point:
    """An equilibrium and the way on.

    Attributes
    ----------
    control, state : where it is
    ahead : (n_own_dofs,) unit tangent of the path [-]
    rate : derivative of the control parameter by the arc
    outcome : of the iteration that found it
    """

    control: float
    state: ProblemState
    ahead: Array
    rate: float
    outcome: NewtonOutcome


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Reached:
    """Where an iteration ended."""

    control: float
    outcome: NewtonOutcome


class _Run:
    """Points of one path."""

    def __init__(self, solver: NewtonSolver, history: list[IncrementRecord]) -> None:
        self._solver, self._problem, self._history = solver, solver.problem, history

    def begin(self, control: float, *, way: float) -> _Point:
        """The present equilibrium, with the way on along which the control parameter changes as ``way`` does."""
        problem = self._problem
        problem.store_stress(extrapolate=False)
        force = problem.surfaces.force(problem.u.x.array, 0.0)
        body = problem.body_residual()
        outcome = NewtonOutcome(converged=True, residuals=(0.0,), residual=body - force)
        return self._at(control, body, outcome, lambda by: way)

    def accept(self, here: _Point, reached: _Reached) -> _Point:
        """The point reached, committed, with the way on."""
        problem = self._problem
        problem.accept()
        problem.store_stress(extrapolate=False)
        problem.surfaces.force(problem.u.x.array, 0.0)
        moved = (problem.u.x.array - here.state.displacement)[: problem.own_dofs]
        body = problem.body_residual()
        return self._at(reached.control, body, reached.outcome, lambda by: process_sums.global_dot(by, moved))

    def _at(self, control: float, body: Array, outcome: NewtonOutcome, sense: Callable[[Array], float]) -> _Point:
        """The present state as a point; ``sense`` of a direction is positive if it leads on."""
        by, negative = self._by_control(control, body)
        size = process_sums.global_norm(by)
        if size == 0.0:
            told = f"the control parameter moves nothing at {control:.6g}: no load, or an obstacle that does not touch"
            raise ConvergenceError(told, self._history)
        rate = np.copysign(1.0 / size, sense(by))
        return _Point(
            control=control,
            state=self._problem.state(),
            ahead=rate * by,
            rate=float(rate),
            outcome=replace(outcome, negative_pivots=negative),
        )

    def _by_control(self, control: float, body: Array) -> tuple[Array, int | None]:
        """New factors of the present tangent: derivative of u by the control parameter, negative eigenvalues."""
        solver = self._solver
        force, moved = control_rate(self._problem, control, body)
        right_hand_side = np.where(solver.free, -force, moved)
        lifted = solver.factorise(moved if process_sums.global_norm(moved) > 0.0 else np.zeros(0))
        if lifted.size:
            right_hand_side -= np.where(solver.free, lifted, 0.0)
        return solver.solved(right_hand_side), solver.negative_pivots

    def attempt(self, here: _Point, length: float) -> _Reached:
        """Iterate to the point that lies ``length`` ahead; leaves the last iterate in the problem."""
        history = list[float]()
        control, residual = here.control, here.outcome.residual
        du, change = length * here.ahead, length * here.rate
        goal, limit = self._solver.settings.relative_tolerance, self._solver.settings.maximum_iterations
        failure, converged, spurious = "", False, False
        try:
            while True:
                control += change
                body, residual = self._move(du, control)
                history.append(self._solver.relative(residual))
                if history[-1] <= goal:
                    spurious = self._solver.is_spurious()
                    converged = not spurious
                    break
                if not np.isfinite(history[-1]) or len(history) > limit:
                    break
                by, _ = self._by_control(control, body)
                own = self._solver.solved(np.where(self._solver.free, -residual, 0.0))
                across = process_sums.global_dot(here.ahead, by)
                if across == 0.0:  # nothing is driven any more: an obstacle that is not touched
                    break
                change = -process_sums.global_dot(here.ahead, own) / across
                du = own + change * by
        except (SingularMatrixError, WildIterateError) as error:
            history.append(float("inf"))
            failure = str(error)
        outcome = NewtonOutcome(
            converged=converged, residuals=tuple(history), residual=residual, spurious=spurious, failure=failure
        )
        return _Reached(control=control, outcome=outcome)

    def _move(self, du: Array, control: float) -> tuple[Array, Array]:
        """Go on by du (n_own_dofs,) [m] to a control parameter; residual without and with the surface terms there."""
        problem = self._problem
        problem.du.x.array[: problem.own_dofs] = du
        problem.du.x.scatter_forward()
        if problem.discretisation.mixed_integration_points:
            problem.store_stress(extrapolate=True)
        problem.u.x.array[:] += problem.du.x.array
        problem.set_control(control)
        force = problem.surfaces.force(problem.u.x.array, 0.0)
        body = problem.body_residual()
        return body, body - force

    def land(self, here: _Point, beyond: _Reached, target: float) -> _Reached:
        """The equilibrium at a control parameter between two points, from their chord; none behind or beyond them."""
        problem = self._problem
        share = (target - here.control) / (beyond.control - here.control)
        chord = problem.u.x.array - here.state.displacement
        problem.u.x.array[:] = here.state.displacement + share * chord
        problem.set_control(target)
        outcome = self._solver.solve()
        moved = (problem.u.x.array - here.state.displacement)[: problem.own_dofs]
        far = process_sums.global_norm(moved) > ROOM * process_sums.global_norm(chord[: problem.own_dofs])
        if outcome.converged and (far or process_sums.global_dot(moved, here.ahead) <= 0.0):
            outcome = replace(outcome, converged=False, failure=f"a state of another path at control {target:.6g}")
        return _Reached(control=target, outcome=outcome)


def _message(here: _Point, reached: _Reached, pressed: Array, largest: float) -> str:
    """pressed, largest : force of the obstacle on the body now, and the largest on the way [N]"""
    told = f"no equilibrium found along the path beyond control {here.control:.6g}"
    if largest > 0.0 and np.linalg.norm(pressed) < 1e-3 * largest:
        return f"{told}: there the body leaves the obstacle, which pressed it with up to {largest:.4g} N on this path"
    if reached.outcome.failure:
        return f"{told}; the last attempt ends as {reached.outcome.failure}; try a shorter first arc"
    residuals = ", ".join(f"{value:.1e}" for value in reached.outcome.residuals)
    return f"{told}; relative residuals of the last attempt {residuals}; try a shorter first arc, or more iterations"
