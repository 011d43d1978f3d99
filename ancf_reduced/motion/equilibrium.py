"""Newton's method with an exact tangent, and a path of targets followed with cut-back.

No line search: with the exact tangent the full step is taken, and an increment that fails is halved instead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError

__all__ = ["NewtonControls", "NewtonResult", "PathPoint", "follow_path", "newton_solve"]

FloatArray = NDArray[np.float64]
System = Callable[[FloatArray], tuple[FloatArray, float]]


@dataclass(frozen=True, slots=True, kw_only=True)
class NewtonControls:
    """When to stop iterating and when to give up.

    Attributes
    ----------
    tolerance : largest residual component relative to the system's force scale [-]
    max_iterations : linear solves per increment
    smallest_step : increments are halved down to this [unit of the control parameter, m for a raised plane]

    Raises
    ------
    InputError
        For values not above zero.
    """

    tolerance: float = 1e-10
    max_iterations: int = 25
    smallest_step: float = 1e-6

    def __post_init__(self) -> None:
        for name in ("tolerance", "max_iterations", "smallest_step"):
            if not getattr(self, name) > 0:
                raise InputError(name, getattr(self, name), "must be greater than zero", "use the default")


@dataclass(frozen=True, slots=True, kw_only=True)
class NewtonResult:
    """Outcome of one Newton iteration.

    Attributes
    ----------
    x : (n,) float, last iterate
    residuals : relative residual before each solve and after the last [-]
    converged : whether the last one met the tolerance
    reason : why a result that met the tolerance is refused all the same, else empty
    """

    x: FloatArray
    residuals: tuple[float, ...]
    converged: bool
    reason: str = ""

    @property
    def iterations(self) -> int:
        """Linear solves done."""
        return len(self.residuals) - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class PathPoint:
    """A converged target.

    Attributes
    ----------
    target : control parameter
    x : (n,) float, solution
    iterations : linear solves since the target before, cut-backs included
    """

    target: float
    x: FloatArray
    iterations: int


def newton_solve(
    system: System,
    tangent: Callable[[FloatArray], Any],
    start: FloatArray,
    controls: NewtonControls,
    solve: Callable[[Any, FloatArray], FloatArray] = np.linalg.solve,
) -> NewtonResult:
    """Solve residual(x) = 0 by full Newton steps.

    Parameters
    ----------
    system : x (n,) -> residual (n,) and the force scale it is held against, in the residual's unit
    tangent : x (n,) -> d residual / d x, (n, n), full or sparse
    start : (n,) first iterate
    controls : tolerance and iteration limit
    solve : matrix and right-hand side -> solution; ``scipy.sparse.linalg.spsolve`` for a sparse tangent

    Returns
    -------
    NewtonResult
        Not converged for a singular tangent, values that are not finite, or too many iterations: never raises.

    Verified by tests/unit/test_ancf_equilibrium.py (quadratic convergence).
    """
    x, residuals = start, list[float]()
    while True:
        residual, scale = system(x)
        residuals.append(float(np.abs(residual).max() / scale))
        converged = residuals[-1] <= controls.tolerance
        if converged or not np.isfinite(residuals[-1]) or len(residuals) > controls.max_iterations:
            return NewtonResult(x=x, residuals=tuple(residuals), converged=converged)
        try:
            step = solve(tangent(x), residual)
        except np.linalg.LinAlgError:
            step = np.full_like(x, np.nan)
        if not np.isfinite(step).all():
            return NewtonResult(x=x, residuals=tuple(residuals), converged=False, reason="the tangent is singular")
        x = x - step


def follow_path(
    solve_at: Callable[[float, FloatArray], NewtonResult],
    start: tuple[float, FloatArray],
    targets: Sequence[float],
    controls: NewtonControls,
    history: list[IncrementRecord],
) -> Iterator[PathPoint]:
    """Reach each target from the one before, halving increments that do not converge.

    Parameters
    ----------
    solve_at : (control parameter, first iterate (n,)) -> NewtonResult
    start : control parameter and solution (n,) to start from
    targets : control parameters wanted, in order, in a unit of their own: m for a deflection, [-] for a load factor
    controls : smallest increment, in the same unit
    history : every attempt is appended

    Yields one PathPoint per target, as soon as it is reached.

    Raises
    ------
    ConvergenceError
        If an increment fails whose half is below ``controls.smallest_step``; with the history, no last good state.

    Verified by tests/unit/test_ancf_equilibrium.py.
    """
    position, x = start
    for target in targets:
        step, iterations, arrived = target - position, 0, False
        while not arrived:
            last = abs(target - position) <= abs(step) * (1.0 + 1e-9)
            goal = target if last else position + step
            result = solve_at(goal, x)
            record = _record(goal, position, result)
            history.append(record)
            iterations += result.iterations
            if result.converged:
                position, x, arrived = goal, result.x, last
            elif abs(step) < 2.0 * controls.smallest_step:
                raise ConvergenceError(_failure(record, result, position, controls), history)
            else:
                step *= 0.5
        yield PathPoint(target=target, x=x, iterations=iterations)


def _record(goal: float, position: float, result: NewtonResult) -> IncrementRecord:
    """The attempt from ``position`` to ``goal``."""
    return IncrementRecord(target=goal, step=goal - position, converged=result.converged, residuals=result.residuals)


def _failure(record: IncrementRecord, result: NewtonResult, position: float, controls: NewtonControls) -> str:
    """Say where the path ended, why, and what to try."""
    reason = result.reason or (
        f"residual {result.residuals[-1]:.3g} after {result.iterations} iterations, tolerance {controls.tolerance:g}"
    )
    return (
        f"Newton stopped on the way to {record.target:.6g} ({reason}) in an increment of {record.step:.3g}; "
        f"last good at {position:.6g}; allow more iterations, ask for closer targets, or stop there"
    )
