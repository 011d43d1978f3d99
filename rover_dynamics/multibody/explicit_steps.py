"""Explicit steps with error control: SciPy's DOP853 (order 8, Hairer, Norsett and Wanner 1993).

After each step the formulation brings the state back to the constraints; how far the step had left them is an error
too, and a step that left them further than allowed is tried anew. Steps are laid so that no stage comes near a singular
position. Verified by tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.linalg import LinAlgError
from numpy.typing import NDArray
from scipy.integrate import DOP853

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.multibody.formulation import Course, Equations, NoStep
from rover_dynamics.multibody.singular_position import SingularPosition

__all__ = ["ExplicitStepper", "StepControl"]

FloatArray = NDArray[np.float64]

_DETOURS = 40
"""Tries to step past a singular position."""
_STAGE_GAP = 0.467
"""Middle of the widest gap between two stages of DOP853, 0.333 and 0.6 of the step."""
_STEP_STATE = ("t", "y", "f", "h_abs", "t_old", "y_old", "h_previous", "status")
_NEARER = 6
"""Tries for a step that ends on the constraints to the error allowed; then the longest is taken after all."""
_SHORTER = 0.9
"""Length of such a try to the one before; much shorter ones creep up to a singular position."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """How explicit steps are chosen.

    Attributes
    ----------
    relative, absolute : error allowed in a step, of and besides the size of each entry of y
    largest : longest step [s]
    fixed : length of all steps, without error control [s]; None for error control
    """

    relative: float = 1e-8
    absolute: float = 1e-10
    largest: float = np.inf
    fixed: float | None = None

    def __post_init__(self) -> None:
        lengths = {"longest step": self.largest, "fixed step": np.inf if self.fixed is None else self.fixed}
        for what, value in {"relative error": self.relative, "absolute error": self.absolute, **lengths}.items():
            if not value > 0.0:
                raise InputError(f"{what} of the step control", f"{value:g}", "must be > 0", "give e.g. 1e-8")


class ExplicitStepper:
    """Steps of one motion; see `motion.Stepper`."""

    summed_error = None

    def __init__(self, formulation: Equations, span: tuple[float, float], control: StepControl) -> None:
        self._equations = formulation
        free = control.fixed is None  # with a fixed step any error is allowed, so that none is shortened
        self._solver = DOP853(
            formulation.rates,
            span[0],
            formulation.corrected(span[0], formulation.start()),
            span[1],
            rtol=control.relative if free else 1e30,
            atol=control.absolute if free else 1e30,
            max_step=control.largest if control.fixed is None else control.fixed,
            first_step=control.fixed,
        )

    @property
    def t(self) -> float:
        """See `motion.Stepper`."""
        return float(self._solver.t)

    @property
    def t_old(self) -> float:
        """See `motion.Stepper`."""
        return float(self._solver.t_old)

    @property
    def y(self) -> FloatArray:
        """See `motion.Stepper`."""
        return np.asarray(self._solver.y)

    @property
    def length(self) -> float:
        """See `motion.Stepper`."""
        return float(self._solver.h_abs)

    @property
    def evaluations(self) -> int:
        """See `motion.Stepper`."""
        return int(self._solver.nfev)

    def step(self) -> Course:
        """See `motion.Stepper`; of a length for which its stages meet the constraints and avoid singular positions."""
        solver, reason = self._solver, ""
        allowed = solver.h_abs
        before = {name: getattr(solver, name) for name in _STEP_STATE}
        nearer, longest = _NEARER, 0.0
        for _ in range(_DETOURS):
            try:
                message = solver.step()
                if solver.status == "failed":
                    raise NoStep(str(message))
                self._settled, off = self._on_the_constraints(np.asarray(solver.y_old))
                if off <= 1.0 or not nearer:
                    return cast(Course, solver.dense_output())
                nearer -= 1
                longest = max(longest, solver.t - solver.t_old)
                length = _SHORTER * (solver.t - solver.t_old) if nearer else longest
                self._back_to(before)
            except (SingularPosition, ConvergenceError, LinAlgError) as found:  # the last: flung off by a stiff force
                reason, length = str(found), 0.5 * solver.h_abs
                self._back_to(before)
                if isinstance(found, SingularPosition):
                    length = self._past(found, allowed)
                    allowed *= 0.9
            solver.h_abs = max(length, 1e-12)
        raise NoStep(f"{reason}, and no step gets past it")

    def _back_to(self, before: dict[str, object]) -> None:
        for name, value in before.items():
            setattr(self._solver, name, value)

    def settle(self, course: Course) -> None:
        """See `motion.Stepper`."""
        solver = self._solver
        solver.y = self._settled
        solver.f = solver.fun(solver.t, solver.y)
        self._equations.accepted(solver.t, solver.y, course)

    def _on_the_constraints(self, y_old: FloatArray) -> tuple[FloatArray, float]:
        """The step's end brought to the constraints, and how far off them it was, in errors allowed.

        A stage next to a singular position has rates wrong by round-off, which the estimate of the error may not see.
        """
        solver = self._solver
        y = self._equations.corrected(solver.t, solver.y)
        errors = (y - solver.y) / (solver.atol + solver.rtol * np.maximum(np.abs(y), np.abs(y_old)))
        return y, float(np.sqrt(np.mean(errors * errors)))

    def _past(self, found: SingularPosition, allowed: float) -> float:
        """A step with the singular position in the widest gap between its stages, or one that ends well before it."""
        here, t = self._equations.margin(self._solver.t, self._solver.y), self._solver.t
        ahead = (found.time - t) * here / (here - found.margin)
        straddling = ahead / _STAGE_GAP
        return float(straddling if straddling <= allowed else ahead - 0.8 * _STAGE_GAP * allowed)
