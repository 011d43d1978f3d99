"""Drives a static problem through wanted values of its control parameter, cutting increments back where needed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from reference_fe.problem.static_problem import ProblemState, StaticProblem
from reference_fe.solver.checkpoint import Arrays, Checkpoint, below, packed, unpacked
from reference_fe.solver.newton import NewtonOutcome, NewtonSolver

__all__ = ["ConvergedState", "solve_increments"]

SMALLEST_FRACTION = 1.0 / 1024.0
"""An increment cut below this fraction of the first wanted step ends the run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvergedState:
    """One converged increment.

    Attributes
    ----------
    control : control parameter reached [m for a raised plane, - for a load factor]
    wanted : whether it is one of the targets asked for, not only a cut-back stop on the way
    outcome : Newton history and residual
    contact_force : force of the plane on the body [N]
    reaction : sum of the support forces on the body [N]
    """

    control: float
    wanted: bool
    outcome: NewtonOutcome
    contact_force: NDArray[np.float64]
    reaction: NDArray[np.float64]


def solve_increments(
    solver: NewtonSolver,
    targets: Sequence[float],
    history: list[IncrementRecord],
    attempt_limit: int = 400,
    on_attempt: Callable[[IncrementRecord], None] | None = None,
    checkpoint: Checkpoint | None = None,
) -> Iterator[ConvergedState]:
    """Yield each converged state on the way through ``targets`` from an unloaded start; the caller may stop early.

    Targets are values of the control parameter, ascending from above zero [m for a raised plane, - for a load factor].

    An increment that does not converge is halved from the last converged state; after a success the step doubles, up to
    the distance to the next target. Every attempt is appended to ``history``. With a ``checkpoint``, each converged
    state is kept when the caller asks for the next one, and a run that finds one goes on behind it: on one process with
    the very numbers of a run that was never stopped.

    Raises
    ------
    ConvergenceError
        When the residual stalls at round-off, when the increment falls below 1/1024 of the first step, or after
        ``attempt_limit`` attempts; carries history.

    Verified by tests/unit/test_fe_increments.py, tests/verification/test_fe_resume.py and
    tests/verification/test_fe_ring.py.
    """
    if not len(targets) or np.any(np.diff([0.0, *targets]) <= 0.0) or not np.all(np.isfinite(targets)):
        raise InputError("targets", list(targets), "must increase from above zero", "sort them and drop repeats")
    problem = solver.problem
    reached, step = _resumed(problem, history, checkpoint) or (0.0, float(targets[0]))
    good, smallest = problem.state(), SMALLEST_FRACTION * float(targets[0])
    for target in targets:
        if reached in (0.0, *targets):  # a resumed run may stand between two targets
            step = max(step, float(target) - reached)
        while reached < target:
            remaining = float(target) - reached
            step = min(step, remaining)
            goal = float(target) if step >= remaining * (1.0 - 1e-9) else reached + step
            problem.set_control(goal)
            outcome = solver.solve(rise=_lag(problem, goal - reached, first=reached == 0.0))
            record = IncrementRecord(
                target=goal, step=goal - reached, converged=outcome.converged, residuals=outcome.residuals
            )
            history.append(record)
            if on_attempt is not None:
                on_attempt(record)
            if outcome.converged:
                problem.accept()
                reached, good, step = goal, problem.state(), 2.0 * step
                yield ConvergedState(
                    control=goal,
                    wanted=goal == float(target),
                    outcome=outcome,
                    contact_force=problem.contact_force(),
                    reaction=problem.reaction(outcome.residual),
                )
                if checkpoint is not None:
                    checkpoint.write(_kept(good, (reached, step), history))
                continue
            problem.restore(good)
            step *= 0.5
            if outcome.stalled or step < smallest or len(history) >= attempt_limit:
                raise ConvergenceError(_message(reached, goal, step, outcome), history)


def _kept(state: ProblemState, progress: tuple[float, float], history: Sequence[IncrementRecord]) -> Arrays:
    """A converged state, (control reached, next step) and the attempts so far, as arrays."""
    arrays = {"displacement": state.displacement, "progress": np.array(progress)}
    arrays |= {"history": packed([asdict(record) for record in history])}
    for i, term in enumerate(state.surfaces):
        arrays |= {f"surface{i}/{name}": values for name, values in term.items()}
    return arrays | {f"history{i}": past for i, past in enumerate(state.histories)}


def _resumed(
    problem: StaticProblem, history: list[IncrementRecord], checkpoint: Checkpoint | None
) -> tuple[float, float] | None:
    """Put the problem where the checkpoint left it; control reached and next step, or None without a checkpoint."""
    arrays = None if checkpoint is None else checkpoint.read()
    if arrays is None:
        return None
    terms = tuple(below(f"surface{i}", arrays) for i in range(len(problem.surfaces.terms)))
    histories = tuple(arrays[f"history{i}"] for i in range(len(problem.histories.state())))
    problem.restore(ProblemState(displacement=arrays["displacement"], surfaces=terms, histories=histories))
    records = unpacked(arrays["history"])
    history[:] = [IncrementRecord(**{**values, "residuals": tuple(values["residuals"])}) for values in records]
    reached, step = (float(value) for value in arrays["progress"])
    problem.set_control(reached)
    return reached, step


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
