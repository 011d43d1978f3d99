"""Implicit steps for any model in joint coordinates: generalised-alpha on its independent velocities.

The equations of motion give the accelerations v' = f(t, q, v) of all joints, loops and drives included
(`tree_coordinates`). The method (`generalised_alpha`) is applied to the independent ones; the dependent coordinates and
velocities follow from the loops' equations at each iteration, so that these hold at position and velocity level as
exactly as they are solved, and at acceleration level by f. No multiplier is integrated, and the order stays two.
Unknown are the independent accelerations a of a step's end:

    r = f_i(q(a), v(a)) - a = 0,     (1 - dt gamma / c  D - dt^2 beta / c  K) da = r

with c = (1 - alpha_m) / (1 - alpha_f), K = df_i / dq_i and D = df_i / dv_i by differences, whatever the forces are,
kept from step to step as long as the iteration converges. Verified by tests/verification/test_multibody_implicit.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.multibody.formulation import Course, Equations, NoStep
from rover_dynamics.multibody.generalised_alpha import generalised_alpha, newmark, rescaled_rates, step_frames
from rover_dynamics.multibody.implicit_steps import ImplicitSteps
from rover_dynamics.multibody.singular_position import SingularPosition
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.tree_kernels import advance, coordinate_rates

__all__ = ["ImplicitStepper"]

FloatArray = NDArray[np.float64]
_EndOf = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""y and A at the step's end for the accelerations there."""
_End = tuple[FloatArray, FloatArray, FloatArray]
"""y, a and A at the step's end."""

ITERATIONS = 12
"""Newton iterations of a step before it is tried shorter."""
NEWTON_SHARE = 0.01
"""Change at which they end, over the error allowed in the step."""
_SLOW = 0.2
"""Ratio of two changes above which K and D are computed anew."""
_DIFFERENCE = 1e-7
"""Of a joint's displacement [rad, m] and velocity [1/s]."""
_DETOURS = (0.9, 1.2, 0.75, 1.5, 0.6, 2.0, 4.0, 8.0)
"""Lengths tried, of the one wanted, where a step would end in a singular position."""
_DETOUR_ERROR = 100.0
"""Error allowed in such a step, over that in others."""


class ImplicitStepper:
    """Steps of one motion; see `motion.Stepper`.

    Raises
    ------
    InputError
        If the formulation is another than `TreeCoordinates`.
    """

    def __init__(self, formulation: Equations, span: tuple[float, float], steps: ImplicitSteps) -> None:
        if not isinstance(formulation, TreeCoordinates):
            hint = "give TreeCoordinates(model), or explicit steps by StepControl"
            raise InputError("formulation for implicit steps", type(formulation).__name__, "must be in joints", hint)
        self._equations, self._steps, self._ends = formulation, steps, span[1]
        self._method = generalised_alpha(steps.spectral_radius, NEWTON_SHARE * steps.tolerance, ITERATIONS)
        self._n_q = int(formulation.tree.q_at[-1])
        self._linear: tuple[FloatArray, FloatArray] | None = None
        self._last = 0.0
        self.evaluations, self.length = 0, steps.first
        self.summed_error: float | None = 0.0 if steps.fixed is None else None
        self.t = self.t_old = span[0]
        self.y = formulation.corrected(self.t, formulation.start())
        self._a = self._accelerations(self.t, self.y)
        self._A = self._a.copy()

    def step(self) -> Course:
        """See `motion.Stepper`."""
        while True:
            dt = self._steps.towards(self._ends - self.t, self.length)
            try:
                error, end, limit = *self._tried(dt), self._steps.tolerance
            except SingularPosition as found:
                dt, error, end = self._detour(dt, found)
                limit = _DETOUR_ERROR * self._steps.tolerance
            self.length = self._steps.after(dt, self.length, error)
            if self._steps.accepts(error * self._steps.tolerance / limit):
                if self.summed_error is not None:
                    self.summed_error += error
                return self._taken(dt, *end)
            if self.length < self._steps.shortest or self._steps.fixed is not None:
                shortest = self._steps.fixed or self._steps.shortest
                raise NoStep(f"no implicit step down to {shortest:g} s converges")

    def settle(self, course: Course) -> None:
        """See `motion.Stepper`; a step's end meets the constraints already."""
        independent = self._equations.independent
        self._equations.accepted(self.t, self.y, None)
        if not np.array_equal(independent, self._equations.independent):
            self._linear = None

    def _taken(self, dt: float, y: FloatArray, a: FloatArray, A: FloatArray) -> Course:
        left, end = self._ends - self.t, self.t + dt
        f, f_end = self._rates(self.t, self.y, self._a), self._rates(end, y, a)
        course = _hermite(self.t, dt, (self.y, y, f, f_end))
        self.t_old, self.t = self.t, self._ends if dt == left else end
        self.y, self._a, self._A, self._last = y, a, A, dt
        return course

    def _detour(self, dt: float, found: SingularPosition) -> tuple[float, float, _End]:
        """Length, error and end of a step that does not end in a singular position."""
        for factor in _DETOURS:
            length = min(factor * dt, self._ends - self.t)
            try:
                error, end = self._tried(length)
            except SingularPosition:
                continue
            if self._steps.accepts(error / _DETOUR_ERROR):
                return length, error, end
        raise NoStep(f"{found}, and no step gets past it")

    def _tried(self, dt: float) -> tuple[float, _End]:
        """Estimated error of a step, infinite if Newton's method fails, and y, a and A at its end."""
        method, free = self._method, self._equations.free
        A_n = rescaled_rates(self._a, self._A, dt / self._last) if self._last > 0.0 else self._A
        q, v = self.y[: self._n_q], self.y[self._n_q :]
        start = step_frames(self._equations.tree, q, v)

        def end_of(a: FloatArray) -> tuple[FloatArray, FloatArray]:
            m, f = method.alpha_m, method.alpha_f
            A = ((1.0 - f) * a + f * self._a - m * A_n) / (1.0 - m)
            moved = newmark(self._equations.tree, (q, v, A_n), A, start, (dt, method))
            return self._equations.corrected(self.t + dt, np.concatenate(moved)), A

        try:
            converged, a = self._solved(dt, end_of)
            if not converged:
                return np.inf, (self.y, self._a, self._A)
            y, A = end_of(a)
        except (ConvergenceError, np.linalg.LinAlgError):
            return np.inf, (self.y, self._a, self._A)
        error = method.error * dt * dt * float(np.max(np.abs((A - A_n)[free]), initial=0.0))
        return error if np.isfinite(error) else np.inf, (y, a, A)

    def _solved(self, dt: float, end_of: _EndOf) -> tuple[bool, FloatArray]:
        """Whether Newton's iteration converged, and the accelerations of all joints at the step's end."""
        i, limit = self._equations.independent, self._method.tolerance
        a, last = self._a.copy(), np.inf  # predictor: accelerations stay
        for k in range(ITERATIONS):
            y, _ = end_of(a)
            found = self._accelerations(self.t + dt, y)
            if self._linear is None:
                self._linear = self._derivatives(self.t + dt, y, found)
            change = np.linalg.solve(self._matrix(dt), found[i] - a[i])
            found[i] = a[i] + change
            a = found
            before, last = last, dt * dt * float(np.max(np.abs(change), initial=0.0))
            ratio = last / before if k else 1.0
            if last <= 0.1 * limit or (ratio < 1.0 and last * ratio / (1.0 - ratio) <= limit):
                return True, a
            if not np.isfinite(last):
                break
            if k and ratio > _SLOW:
                self._linear = None
        self._linear = None
        return False, a

    def _matrix(self, dt: float) -> FloatArray:
        """Derivative of a - f_i by a."""
        assert self._linear is not None
        method, (K, D) = self._method, self._linear
        c = (1.0 - method.alpha_m) / (1.0 - method.alpha_f)
        return np.asarray(np.eye(len(K)) - (dt * method.gamma / c) * D - (dt * dt * method.beta / c) * K)

    def _derivatives(self, t: float, y: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
        """K and D by forward differences, with the loops closed."""
        n_q, i, tree, h = self._n_q, self._equations.independent, self._equations.tree, _DIFFERENCE
        frames = self._equations.motion(t, y).frames
        K, D = np.empty((len(i), len(i))), np.empty((len(i), len(i)))
        for column, e in enumerate(h * np.eye(len(a))[i]):
            turned = np.concatenate([advance(tree, y[:n_q], e, frames), y[n_q:]])
            faster = np.concatenate([y[:n_q], y[n_q:] + e])
            for out, moved in ((K, turned), (D, faster)):
                found = self._accelerations(t, self._equations.corrected(t, moved))
                out[:, column] = (found - a)[i] / h
        return K, D

    def _accelerations(self, t: float, y: FloatArray) -> FloatArray:
        self.evaluations += 1
        return self._equations.accelerations(t, self._equations.motion(t, y)).joints

    def _rates(self, t: float, y: FloatArray, a: FloatArray) -> FloatArray:
        """y'."""
        frames, n_q = self._equations.motion(t, y).frames, self._n_q
        return np.concatenate([coordinate_rates(self._equations.tree, y[:n_q], y[n_q:], frames), a])


def _hermite(t: float, dt: float, ends: tuple[FloatArray, ...]) -> Course:
    """Cubic of y and y' at both ends of a step."""
    y, y_end, f, f_end = ends

    def at(time: float) -> FloatArray:
        s = (time - t) / dt
        inner = (1.0 - 2.0 * s) * (y_end - y) + dt * ((s - 1.0) * f + s * f_end)
        return (1.0 - s) * y + s * y_end + s * (s - 1.0) * inner

    return at
