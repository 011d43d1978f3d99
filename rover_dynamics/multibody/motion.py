"""Motions in time: explicit or implicit steps with error control, samples, and events.

Verified by tests/verification/test_multibody_benchmarks.py and tests/verification/test_multibody_implicit.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from rover_dynamics.multibody.explicit_steps import ExplicitStepper, StepControl
from rover_dynamics.multibody.formulation import Course, Equations, NoStep
from rover_dynamics.multibody.implicit_stepper import ImplicitStepper
from rover_dynamics.multibody.implicit_steps import ImplicitSteps
from rover_dynamics.multibody.singular_position import SingularPosition
from rover_dynamics.multibody.state import State

__all__ = ["Event", "EventRecord", "ImplicitSteps", "Motion", "StepControl", "integrate"]

FloatArray = NDArray[np.float64]


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
    summed_error : of the accepted implicit steps, the estimated errors added up [m, rad]: what the whole motion may
        err by where neighbouring motions do not part; None for explicit and for fixed steps
    """

    times: FloatArray
    states: tuple[State, ...]
    coordinates: FloatArray
    events: tuple[EventRecord, ...]
    steps: int
    evaluations: int
    summed_error: float | None = None


def integrate(
    formulation: Equations,
    times: FloatArray,
    control: StepControl | ImplicitSteps | None = None,
    events: Sequence[Event] = (),
) -> Motion:
    """Integrate from ``times[0]``, where the model starts, to ``times[-1]``.

    Parameters
    ----------
    formulation : equations of motion, e.g. `TreeCoordinates`, the only one for implicit steps
    times : (n,) ascending [s]
    control : error allowed, or a fixed step; its type decides between explicit and implicit steps, which are for stiff
        springs, dampers and contacts; without it `StepControl()`
    events : looked for between the ends of each step; found to 1e-12 s

    Raises
    ------
    InputError
        If the times do not ascend, or implicit steps are asked for in other than joint coordinates.
    ConvergenceError
        If the step falls below what numbers can resolve, or the constraints cannot be met; it carries the motion up to
        there.
    """
    if len(times) < 2 or not np.all(np.diff(times) > 0.0):
        raise InputError("times of a motion", times, "must be two or more and ascend", "give e.g. numpy.linspace(0, 1)")
    wanted = np.asarray(times, dtype=np.float64)
    span = float(wanted[0]), float(wanted[-1])
    stepper: Stepper
    if isinstance(control, ImplicitSteps):
        stepper = ImplicitStepper(formulation, span, control)
    else:
        stepper = ExplicitStepper(formulation, span, control or StepControl())
    return _Run(formulation, wanted, stepper, events).to_its_end()


class Stepper(Protocol):
    """Takes the steps of one motion.

    Attributes
    ----------
    t, t_old : where the last step ended and where it began [s]
    y : (N,) float, at t
    length : of the step in hand, for messages [s]
    evaluations : of the equations of motion, so far
    summed_error : see `Motion`
    """

    @property
    def t(self) -> float: ...
    @property
    def t_old(self) -> float: ...
    @property
    def y(self) -> FloatArray: ...
    @property
    def length(self) -> float: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def summed_error(self) -> float | None: ...

    def step(self) -> Course:
        """Take a step; y within it as a function of time. Raises NoStep where there is none."""

    def settle(self, course: Course) -> None:
        """Bring y to the constraints, once the step's course is no longer needed. Raises NoStep if it cannot be."""


class _Run:
    """One integration under way."""

    def __init__(self, formulation: Equations, times: FloatArray, stepper: Stepper, events: Sequence[Event]) -> None:
        self._equations, self._times, self._events, self._stepper = formulation, times, events, stepper
        self._coordinates = [stepper.y]
        self._states = [formulation.state(times[0], stepper.y)]
        self._found: list[EventRecord] = []
        self._signs = [event.function(times[0], self._states[0]) for event in events]
        self._steps = 0

    def to_its_end(self) -> Motion:
        try:
            while self._stepper.t < self._times[-1]:
                course = self._stepper.step()
                self._steps += 1
                if self._look(course):
                    break
                self._sample(course, self._stepper.t)
                self._stepper.settle(course)
        except NoStep as reason:
            raise self._stopped(str(reason)) from reason
        return self._motion()

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
        begins, ends = self._stepper.t_old, self._stepper.t
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
            evaluations=self._stepper.evaluations,
            summed_error=self._stepper.summed_error,
        )

    def _stopped(self, reason: str) -> ConvergenceError:
        t = self._stepper.t
        message = (
            f"motion stopped at t = {t:g} s of {self._times[-1]:g} s: {reason}; allow a larger error, or look there"
        )
        record = IncrementRecord(target=t, step=self._stepper.length, converged=False, residuals=())
        return ConvergenceError(message, [record], self._motion())
