"""Motions in time: explicit integration with error control, samples, and events.

The stepper is SciPy's DOP853 (order 8, Hairer, Norsett and Wanner 1993); between its steps the formulation brings the
state back to the constraints. Verified by tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from rover_dynamics.multibody.formulation import Course, Formulation, SingularPosition
from rover_dynamics.multibody.state import State

__all__ = ["Event", "EventRecord", "Motion", "StepControl", "integrate"]

FloatArray = NDArray[np.float64]

_DETOURS = 40
"""Tries to step past a singular position."""
_STAGE_GAP = 0.467
"""Middle of the widest gap between two stages of DOP853, 0.333 and 0.6 of the step."""
_STEP_STATE = ("t", "y", "f", "h_abs", "t_old", "y_old", "h_previous", "status")


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """How steps are chosen.

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """A time at which a function of the state changes its sign.

    Attributes
    ----------
    name : what happens
    function : of time and state
    terminal : whether the motion ends there
    """

    name: str
    function: Callable[[float, State], float]
    terminal: bool = False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EventRecord:
    """One event found: its name, time [s], state, and the sign the function changes to."""

    name: str
    time: float
    state: State
    sign: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """A motion at the times asked for.

    Attributes
    ----------
    times : (n,) float [s], ascending; fewer than asked for if a terminal event ended it
    states : one for each time
    coordinates : (n, N) float, y of the formulation at each time
    events : in the order of time
    steps, evaluations : accepted steps, and calls of the equations of motion
    """

    times: FloatArray
    states: tuple[State, ...]
    coordinates: FloatArray
    events: tuple[EventRecord, ...]
    steps: int
    evaluations: int


def integrate(
    formulation: Formulation,
    times: FloatArray,
    control: StepControl = StepControl(),
    events: Sequence[Event] = (),
) -> Motion:
    """Integrate from ``times[0]``, where the model starts, to ``times[-1]``.

    Parameters
    ----------
    formulation : equations of motion, e.g. `AbsoluteCoordinates`
    times : (n,) ascending [s]
    control : error allowed, or a fixed step
    events : looked for between the ends of each step; found to 1e-12 s

    Raises
    ------
    InputError
        If the times do not ascend.
    ConvergenceError
        If the step falls below what numbers can resolve, or the constraints cannot be met; it carries the motion up to
        there.
    """
    if len(times) < 2 or not np.all(np.diff(times) > 0.0):
        raise InputError("times of a motion", times, "must be two or more and ascend", "give e.g. numpy.linspace(0, 1)")
    run = _Run(formulation, np.asarray(times, dtype=np.float64), control, events)
    return run.to_its_end()


class _Run:
    """One integration under way."""

    def __init__(
        self, formulation: Formulation, times: FloatArray, control: StepControl, events: Sequence[Event]
    ) -> None:
        self._equations, self._times, self._events = formulation, times, events
        start = formulation.corrected(times[0], formulation.start())
        free = control.fixed is None  # with a fixed step any error is allowed, so that none is shortened
        self._solver = DOP853(
            formulation.rates,
            float(times[0]),
            start,
            float(times[-1]),
            rtol=control.relative if free else 1e30,
            atol=control.absolute if free else 1e30,
            max_step=control.largest if control.fixed is None else control.fixed,
            first_step=control.fixed,
        )
        self._coordinates = [start]
        self._states = [formulation.state(times[0], start)]
        self._found: list[EventRecord] = []
        self._signs = [event.function(times[0], self._states[0]) for event in events]
        self._steps = 0

    def to_its_end(self) -> Motion:
        while self._solver.status == "running":
            dense = self._step()
            self._steps += 1
            if self._look(dense):
                break
            self._sample(dense, self._solver.t)
            self._correct()
            self._equations.accepted(self._solver.t, self._solver.y, dense)
        return self._motion()

    def _step(self) -> Course:
        """One step, of a length for which its stages meet the constraints and avoid singular positions; its course."""
        solver, reason = self._solver, ""
        allowed = solver.h_abs
        before = {name: getattr(solver, name) for name in _STEP_STATE}
        for _ in range(_DETOURS):
            try:
                message = solver.step()
                if solver.status == "failed":
                    raise self._stopped(str(message))
                return cast(Course, solver.dense_output())
            except (SingularPosition, ConvergenceError) as found:
                if isinstance(found, ConvergenceError) and solver.status == "failed":
                    raise
                reason = str(found)
                for name, value in before.items():
                    setattr(solver, name, value)
                length = self._past(found, allowed) if isinstance(found, SingularPosition) else 0.5 * solver.h_abs
                solver.h_abs = max(length, 1e-12)
                allowed *= 0.9
        raise self._stopped(f"{reason}, and no step gets past it")

    def _past(self, found: SingularPosition, allowed: float) -> float:
        """A step with the singular position in the widest gap between its stages, or one that ends well before it."""
        here, t = self._equations.margin(self._solver.t, self._solver.y), self._solver.t
        ahead = (found.time - t) * here / (here - found.margin)
        straddling = ahead / _STAGE_GAP
        return float(straddling if straddling <= allowed else ahead - 0.8 * _STAGE_GAP * allowed)

    def _correct(self) -> None:
        solver = self._solver
        try:
            solver.y = self._equations.corrected(solver.t, solver.y)
        except ConvergenceError as error:
            raise self._stopped(str(error)) from error
        solver.f = solver.fun(solver.t, solver.y)

    def _sample(self, dense: Course, until: float) -> None:
        while len(self._states) < len(self._times) and self._times[len(self._states)] <= until:
            t = float(self._times[len(self._states)])
            y = self._coordinates_at(dense, t)
            self._coordinates.append(y)
            self._states.append(self._equations.state(t, y))

    def _coordinates_at(self, course: Course, t: float) -> FloatArray:
        """y at a time within the last step; not corrected at a singular position, where that has no meaning."""
        try:
            return self._equations.corrected(t, course(t))
        except SingularPosition:
            return course(t)

    def _at(self, course: Course, t: float) -> State:
        return self._equations.state(t, self._coordinates_at(course, t))

    def _look(self, dense: Course) -> bool:
        """Find the events of the last step in their order; whether one of them ends the motion."""
        found: list[tuple[float, Event, int]] = []
        begins, ends = self._solver.t_old, self._solver.t
        for k, event in enumerate(self._events):
            before, after = self._signs[k], event.function(ends, self._at(dense, ends))
            if after != 0.0:  # a zero at the step's end is found in the next one
                self._signs[k] = after
            if before * after < 0.0:
                t = brentq(lambda s, e=event: e.function(s, self._at(dense, s)), begins, ends, xtol=1e-12)
                found.append((float(t), event, int(np.sign(after))))
        for t, event, sign in sorted(found, key=lambda item: item[0]):
            self._found.append(EventRecord(name=event.name, time=t, state=self._at(dense, t), sign=sign))
            if event.terminal:
                self._sample(dense, t)
                return True
        return False

    def _motion(self) -> Motion:
        return Motion(
            times=self._times[: len(self._states)],
            states=tuple(self._states),
            coordinates=np.array(self._coordinates),
            events=tuple(self._found),
            steps=self._steps,
            evaluations=int(self._solver.nfev),
        )

    def _stopped(self, reason: str) -> ConvergenceError:
        t = float(self._solver.t)
        message = (
            f"motion stopped at t = {t:g} s of {self._times[-1]:g} s: {reason}; allow a larger error, or look there"
        )
        record = IncrementRecord(target=t, step=float(self._solver.h_abs), converged=False, residuals=())
        return ConvergenceError(message, [record], self._motion())
