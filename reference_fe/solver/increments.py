"""Drives a static problem through wanted values of its control parameter, cutting increments back where needed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError, LimitLoad
from reference_fe.problem.static_problem import ProblemState, StaticProblem
from reference_fe.solver import process_sums
from reference_fe.solver.arc_length import ArcLength, follow_path
from reference_fe.solver.checkpoint import Arrays, Checkpoint, below, packed, unpacked
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.limit_point import limit_point
from reference_fe.solver.newton import NewtonOutcome, NewtonSolver

__all__ = ["solve_increments"]

type NextTarget = Callable[[float], float | None]
"""Control parameter reached -> the next target; None at the end."""
SMALLEST_FRACTION = 1.0 / 1024.0
"""An increment cut below this fraction of the first wanted step ends the run."""


def solve_increments(
    solver: NewtonSolver,
    targets: Sequence[float] | NextTarget,
    history: list[IncrementRecord],
    attempt_limit: int = 400,
    on_attempt: Callable[[IncrementRecord], None] | None = None,
    checkpoint: Checkpoint | None = None,
    *,
    past_limits: bool = False,
) -> Iterator[ConvergedState]:
    """Yield each converged state on the way through ``targets`` from an unloaded start; the caller may stop early.

    Targets are values of the control parameter, ascending from above zero [m for a raised plane, - for a load factor].
    A path that is not known before it is gone, such as one that turns back, is a function instead: from the control
    parameter reached it tells the next target, whenever it is asked.

    An increment that does not converge is halved from the last converged state; after a success the step doubles, up to
    the distance to the next target. Where the material yields, an increment begins at the displacement that the last
    one points to: a step from rest would strain it plastically all over. Every attempt is appended to ``history``. With
    a ``checkpoint``, each converged state is kept when the caller asks for the next one, and a run that finds one goes
    on behind it: on one process with the very numbers of a run that was never stopped. Of states before that one it
    knows nothing: if its first increments fail, no limit load is told and no path followed until one has converged.

    With ``past_limits``, a rising increment that does not converge is not halved: the path is followed by arc length
    (see `follow_path`) from the last converged state until it comes to the target, over limit points on the way. These
    states are yielded like the others, their control parameters may fall; they are not kept in the checkpoint.

    Raises
    ------
    ConvergenceError
        When the residual stalls at round-off, when the increment falls below 1/1024 of the first step, or after
        ``attempt_limit`` attempts; carries history, and the limit load where one ended it (see `limit_point`).

    Verified by tests/unit/test_fe_increments.py, tests/verification/test_fe_resume.py,
    tests/verification/test_fe_unloading.py and tests/verification/test_fe_ring.py.
    """
    next_target = targets if callable(targets) else _in_order(targets)
    problem = solver.problem
    smallest = SMALLEST_FRACTION * float(next_target(0.0) or 0.0)
    place = _resumed(problem, history, checkpoint) or _Place(reached=0.0, step=0.0, target=0.0)
    good, earlier = problem.state(), None
    while (target := next_target(place.reached)) is not None:
        place = place.towards(float(target))
        goal, rise = place.next()
        problem.set_control(goal)
        if problem.histories.remembered:
            problem.u.x.array[:] = place.ahead(good.displacement, goal)
        outcome = solver.solve(rise=_lag(problem, rise, first=place.reached == 0.0 and rise > 0.0))
        record = IncrementRecord(target=goal, step=rise, converged=outcome.converged, residuals=outcome.residuals)
        history.append(record)
        if on_attempt is not None:
            on_attempt(record)
        if outcome.converged:
            problem.accept()
            before = (place.reached, good.displacement) if problem.histories.remembered else None
            earlier = place.reached, good
            place, start = replace(place, reached=goal, step=2.0 * abs(rise), before=before), good
            good = problem.state()
            yield ConvergedState(
                control=goal,
                wanted=goal == place.target,
                start=start,
                outcome=outcome,
                contact_force=problem.contact_force(),
                reaction=problem.reaction(outcome.residual),
            )
            if checkpoint is not None:
                checkpoint.write(_kept(good, place, history))
            continue
        problem.restore(good)
        last_arc = _last_arc(problem, earlier, good) if past_limits else 0.0
        if last_arc > 0.0 and rise > 0.0 and not (outcome.stalled or outcome.spurious):
            span = {"start": place.reached, "target": place.target, "first_arc": last_arc}
            yield from follow_path(solver, ArcLength(first=rise), history, attempt_limit, on_attempt, **span)
            place, good, earlier = replace(place, reached=place.target, step=abs(rise)), problem.state(), None
            continue
        place = replace(place, step=0.5 * abs(rise))
        if outcome.stalled or place.step < smallest or len(history) >= attempt_limit:
            told = _message(place.reached, goal, place.step, outcome)
            if earlier is None or outcome.stalled or outcome.spurious or not earlier[0] < place.reached < goal:
                raise ConvergenceError(told, history)
            limit = limit_point(solver, earlier, (place.reached, good), rise)
            raise ConvergenceError(told if limit is None else _at_limit(problem, limit), history, limit=limit)


def _last_arc(problem: StaticProblem, earlier: tuple[float, ProblemState] | None, last: ProblemState) -> float:
    """How far the last state is from the one before [m]; zero if there is none, or nothing moved."""
    if earlier is None:
        return 0.0
    return process_sums.global_norm((last.displacement - earlier[1].displacement)[: problem.own_dofs])


def _in_order(targets: Sequence[float]) -> NextTarget:
    """The next of ascending targets; raises InputError for others."""
    if not len(targets) or np.any(np.diff([0.0, *targets]) <= 0.0) or not np.all(np.isfinite(targets)):
        raise InputError("targets", list(targets), "must increase from above zero", "sort them and drop repeats")
    return lambda reached: next((target for target in targets if target > reached), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Place:
    """Where a run stands.

    Attributes
    ----------
    reached, step, target : control parameter reached, length of the next step, what the run makes for
    before : control parameter and displacement of the state before, if they are wanted
    """

    reached: float
    step: float
    target: float
    before: tuple[float, NDArray[np.float64]] | None = None

    def towards(self, target: float) -> _Place:
        """Making for a target: one step may reach it, unless it was made for already, with smaller ones."""
        step = self.step if target == self.target else max(self.step, abs(target - self.reached))
        return replace(self, step=step, target=target)

    def next(self) -> tuple[float, float]:
        """Control parameter of the next attempt, and how far that is, negative on the way back."""
        remaining = self.target - self.reached
        if self.step >= abs(remaining) * (1.0 - 1e-9):
            return self.target, remaining
        goal = self.reached + math.copysign(self.step, remaining)
        return goal, goal - self.reached

    def ahead(self, displacement: NDArray[np.float64], goal: float) -> NDArray[np.float64]:
        """Displacement at the goal if it goes on as between the last two states, (n_dofs,) [m]; not beyond a turn."""
        share = 0.0 if self.before is None else (goal - self.reached) / (self.reached - self.before[0])
        if self.before is None or share < 0.0:  # it comes back elastically, not the way it went
            return displacement
        return displacement + share * (displacement - self.before[1])


def _kept(state: ProblemState, place: _Place, history: Sequence[IncrementRecord]) -> Arrays:
    """A converged state, where it stands and the attempts so far, as arrays."""
    arrays = {"displacement": state.displacement, "progress": np.array((place.reached, place.step, place.target))}
    arrays |= {"history": packed([asdict(record) for record in history])}
    for i, term in enumerate(state.surfaces):
        arrays |= {f"surface{i}/{name}": values for name, values in term.items()}
    if place.before is not None:
        arrays |= {"before": place.before[1], "before_control": np.array(place.before[0])}
    return arrays | {f"points{i}": past for i, past in enumerate(state.histories)}


def _resumed(problem: StaticProblem, history: list[IncrementRecord], checkpoint: Checkpoint | None) -> _Place | None:
    """Put the problem where the checkpoint left it, and say where that is; None without a checkpoint."""
    arrays = None if checkpoint is None else checkpoint.read()
    if arrays is None:
        return None
    terms = tuple(below(f"surface{i}", arrays) for i in range(len(problem.surfaces.terms)))
    histories = tuple(arrays[f"points{i}"] for i in range(len(problem.histories.state())))
    problem.restore(ProblemState(displacement=arrays["displacement"], surfaces=terms, histories=histories))
    records = unpacked(arrays["history"])
    history[:] = [IncrementRecord(**{**values, "residuals": tuple(values["residuals"])}) for values in records]
    reached, step, target = (float(value) for value in arrays["progress"])
    before = (float(arrays["before_control"]), arrays["before"]) if "before" in arrays else None
    problem.set_control(reached)
    return _Place(reached=reached, step=step, target=target, before=before)


def _lag(problem: StaticProblem, step: float, *, first: bool) -> float:
    """Contact lag of an increment [m]: its rise; at first touch only the lowest 2 % of the rise may touch."""
    if problem.contact is None and not problem.surfaces.terms:
        return 0.0
    return (0.98 if first else 1.0) * step


def _at_limit(problem: StaticProblem, limit: LimitLoad) -> str:
    """What a run that ended at a limit or branch point says."""
    driven = any(one.at_load_factor_1 for one in problem.prescribed)
    what = "height of the ground" if problem.contact is not None else "displacement" if driven else "load"
    carried = "the ground presses on the mesh with" if problem.contact is not None else "the supports carry"
    place = ", ".join(f"{x:.4g}" for x in limit.place)
    if limit.branch:
        ends = "another path branches off, on which the drive does no work: buckling"
    elif what == "load":
        ends = "no equilibrium lies beyond it nearby: snap-through"
    else:
        ends = f"the {what} turns back there: snap-back"
    return (
        f"limit load: the driven {what} ends at control {limit.control:.6g}, where {carried} {limit.load:.4g} N and "
        f"{ends} (the tangent's lowest eigenvalue, {limit.left:.3g} of what it was an increment before, reaches zero); "
        f"its mode moves most in part {limit.part} at ({place}) m; a finer mesh or smaller increments do not help: "
        "follow the path by arc length (docs/how_to/limit_load.md), or stiffen what gives way"
    )


def _message(reached: float, goal: float, step: float, outcome: NewtonOutcome) -> str:
    if outcome.spurious:
        return (
            f"the increment to control {goal:.6g} ends in a state compressed below a stretch of 0.577 or inside out, "
            f"where St. Venant-Kirchhoff material means nothing; last sound state at {reached:.6g}; try smaller "
            "increments, a finer mesh or the neo-Hookean law"
        )
    if outcome.stalled:
        floor = max(outcome.residuals[-4:])
        return (
            f"the increment to control {goal:.6g} stalls at a relative residual of {floor:.1e}, the round-off of this "
            f"mesh and load; last converged at {reached:.6g}; smaller increments do not help: set the relative "
            f"tolerance to {3.0 * floor:.0e} or more"
        )
    if outcome.failure:
        return (
            f"the increment to control {goal:.6g} ends as {outcome.failure}; last converged at {reached:.6g}, smaller "
            f"increments down to {step:.2g} end alike; look for a part that nothing holds, or take a stiffer contact "
            "or thicker strips"
        )
    residuals = ", ".join(f"{value:.1e}" for value in outcome.residuals)
    return (
        f"the increment to control {goal:.6g} does not converge; last converged at {reached:.6g}, next step would be "
        f"{step:.2g}; relative residuals of the last attempt {residuals}; try a softer contact stiffness, more "
        "iterations or a finer mesh"
    )
