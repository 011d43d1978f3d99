"""Drives a static problem through wanted values of its control parameter, cutting increments back where needed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from reference_fe.problem.static_problem import ProblemState, StaticProblem
from reference_fe.solver.checkpoint import Arrays, Checkpoint, below, packed, unpacked
from reference_fe.solver.newton import NewtonOutcome, NewtonSolver

__all__ = ["ConvergedState", "solve_increments"]

type NextTarget = Callable[[float], float | None]
"""Control parameter reached -> the next target; None at the end."""
SMALLEST_FRACTION = 1.0 / 1024.0
"""An increment cut below this fraction of the first wanted step ends the run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvergedState:
    """One converged increment.

    Attributes
    ----------
    control : control parameter reached [m for a raised plane, - for a load factor]
    wanted : whether it is one of the targets asked for, not only a cut-back stop on the way
    start : the state that its increment began with
    outcome : Newton history and residual
    contact_force : force of the plane on the body [N]
    reaction : sum of the support forces on the body [N]
    """

    control: float
    wanted: bool
    start: ProblemState
    outcome: NewtonOutcome
    contact_force: NDArray[np.float64]
    reaction: NDArray[np.float64]


def solve_increments(
    solver: NewtonSolver,
    targets: Sequence[float] | NextTarget,
    history: list[IncrementRecord],
    attempt_limit: int = 400,
    on_attempt: Callable[[IncrementRecord], None] | None = None,
    checkpoint: Checkpoint | None = None,
) -> Iterator[ConvergedState]:
    """Yield each converged state on the way through ``targets`` from an unloaded start; the caller may stop early.

    Targets are values of the control parameter, ascending from above zero [m for a raised plane, - for a load factor].
    A path that is not known before it is gone, such as one that turns back, is a function instead: from the control
    parameter reached it tells the next target, whenever it is asked.

    An increment that does not converge is halved from the last converged state; after a success the step doubles, up to
    the distance to the next target. Where the material yields, an increment begins at the displacement that the last
    one points to: a step from rest would strain it plastically all over. Every attempt is appended to ``history``. With
    a ``checkpoint``, each converged state is kept when the caller asks for the next one, and a run that finds one goes
    on behind it: on one process with the very numbers of a run that was never stopped.

    Raises
    ------
    ConvergenceError
        When the residual stalls at round-off, when the increment falls below 1/1024 of the first step, or after
        ``attempt_limit`` attempts; carries history.

    Verified by tests/unit/test_fe_increments.py, tests/verification/test_fe_resume.py,
    tests/verification/test_fe_unloading.py and tests/verification/test_fe_ring.py.
    """
    next_target = targets if callable(targets) else _in_order(targets)
    problem = solver.problem
    smallest = SMALLEST_FRACTION * float(next_target(0.0) or 0.0)
    place = _resumed(problem, history, checkpoint) or _Place(reached=0.0, step=0.0, target=0.0)
    good = problem.state()
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
        place = replace(place, step=0.5 * abs(rise))
        if outcome.stalled or place.step < smallest or len(history) >= attempt_limit:
            raise ConvergenceError(_message(place.reached, goal, place.step, outcome), history)


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
