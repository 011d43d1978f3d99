"""Implicit motion of an ANCF wheel: generalised-alpha with adaptive steps, contact found within each Newton step.

The method and its local error are those of `ancf_reduced.motion.implicit` (Chung & Hulbert 1993). Newton's matrix is
the plates' alone, the hub's three rows and columns are eliminated, and the touching set is found on it as in statics
(`contact_step`), so that a step costs one to three factorisations. Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.wheel.static import Mixed
from ancf_reduced.wheel_motion.bordered import HUB
from ancf_reduced.wheel_motion.newton import Factored
from ancf_reduced.wheel_motion.rolling import Linearised, Motion, RollingWheel
from contracts.errors import ConvergenceError, InputError

__all__ = ["Account", "TravelSettings", "travel"]

Array = NDArray[np.float64]
_GROWTH, _SHRINKING = 1.5, 0.35
_KEPT, _GROWTH_FROM = 0.92, 1.3
"""Shares of the step within which the next one stays as it is, and the factors with it [-]."""
_DIVERGING = 1.2
"""Times the step before, in places: from there Newton's iteration has not come back [-]."""
_TURNED = 0.01
"""Turning of a strip from which the damping matrix is made anew [rad]."""
_ASTRAY = 0.03
"""Of the wheel's radius: after a first step of more a shorter time step is cheaper [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TravelSettings:
    """Choices of the integrator.

    Attributes
    ----------
    tolerance : local error of a place in one step [m]
    spectral_radius : rho at infinite frequency [-]
    first_step, smallest_step, largest_step : [s]
    newton_tolerance : largest error of a place that ends the iteration, relative to ``tolerance`` [-]
    newton_iterations : after so many the step is cut
    """

    tolerance: float = 2e-6
    spectral_radius: float = 0.8
    first_step: float = 1e-4
    smallest_step: float = 1e-7
    largest_step: float = 2e-2
    newton_tolerance: float = 1e-2
    newton_iterations: int = 7

    def __post_init__(self) -> None:
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise InputError("spectral radius", self.spectral_radius, "must lie in 0..1", "0.8 is usual")
        for name in (one.name for one in fields(self) if one.name != "spectral_radius"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(name.replace("_", " "), getattr(self, name), "must be finite and > 0", "leave it out")


@dataclass(slots=True)
class Account:
    """Energy of the whole wheel along a motion [J].

    Rows of time, kinetic, strain, weight, contact, damping, friction, drive. The last three are work since the start,
    by the trapezoidal rule; damping and friction are dissipated.
    """

    rows: list[tuple[float, ...]] = field(default_factory=list)
    _last: tuple[float, tuple[float, ...], tuple[float, ...]] | None = None

    @property
    def totals(self) -> Array:
        """What must stay constant (n,) [J]."""
        table = np.array(self.rows)
        return np.asarray(table[:, 1:7].sum(axis=1) - table[:, 7])

    def closure(self) -> float:
        """Spread of the totals over the largest change of one part [-]; 0 before anything has changed."""
        change = float(np.ptp(np.array(self.rows)[:, 1:], axis=0).max())
        return float(np.ptp(self.totals)) / change if change > 0.0 else 0.0

    def add(self, wheel: RollingWheel, here: Step) -> None:
        """One row more."""
        powers = wheel.powers(here.motion, here.found)
        time, before, works = self._last or (here.motion.time, powers, (0.0, 0.0, 0.0))
        share = 0.5 * (here.motion.time - time)
        gone = tuple(w + share * (a + b) for w, a, b in zip(works, before, powers, strict=True))
        self._last = here.motion.time, powers, gone
        self.rows.append((here.motion.time, *wheel.energies(here.motion, here.found, here.step), *gone))


def travel(
    wheel: RollingWheel,
    start: Motion,
    times: Sequence[float],
    settings: TravelSettings | None = None,
    account: Account | None = None,
    watch: Callable[[Motion], None] | None = None,
) -> Iterator[Motion]:
    """States at the wanted times [s].

    account : gets a row at every step; watch : is called with every step's state

    Raises
    ------
    InputError
        For times that are not finite or do not increase from the start.
    ConvergenceError
        If a step would have to be cut below the smallest one.
    """
    wanted = np.array([start.time, *times])
    if not (np.isfinite(wanted).all() and (np.diff(wanted) > 0.0).all()):
        raise InputError("times", f"{list(times)[:4]} s", "must be finite and increase from the start", "sort them")
    run = _Run(wheel, settings or TravelSettings())
    here = run.begin(start)
    if account is not None:
        account.add(wheel, here)
    h = run.settings.first_step
    for time in times:
        while here.motion.time < time * (1.0 - 1e-12):
            left = time - here.motion.time
            step = left if h * (1.0 + 1e-6) >= left else min(h, 0.5 * left) if 2.0 * h > left else h
            found = run.advance(here, step)
            error = np.inf if found is None else run.error(here, found, step)
            if found is None or error > 1.0:
                h = step * (_SHRINKING if found is None else max(_SHRINKING, 0.9 * error ** (-1.0 / 3.0)))
                if h < run.settings.smallest_step:
                    why = "Newton's iteration does not converge" if found is None else "its error stays too large"
                    what = f"motion of the ANCF wheel stopped at {here.motion.time:.4g} s: {why}"
                    raise ConvergenceError(f"{what} at a step of {h:.3g} s; raise the tolerance", [], here.motion)
                continue
            if account is not None:
                account.add(wheel, found)
            here = found
            grown = 0.9 * max(error, 1e-9) ** (-1.0 / 3.0)
            if step == h and not _KEPT <= grown <= _GROWTH_FROM:
                h = min(step * min(_GROWTH, grown), run.settings.largest_step)
            if watch is not None:
                watch(here.motion)
        yield here.motion


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A state, its auxiliary accelerations; the equations a Newton step before, where, and their factors; pulls."""

    motion: Motion
    auxiliary: Array
    found: Linearised
    at: Motion
    pull: Array
    factored: Factored | None = None

    @property
    def step(self) -> Array:
        """From where the equations are linearised to the state (n_free + 3,)."""
        return self.motion.y - self.at.y


class _Run:
    """One integration."""

    def __init__(self, wheel: RollingWheel, settings: TravelSettings) -> None:
        self.wheel, self.settings = wheel, settings
        rho = settings.spectral_radius
        self.alpha_m, self.alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
        self.gamma = 0.5 - self.alpha_m + self.alpha_f
        self.beta = 0.25 * (self.gamma + 0.5) ** 2
        self._braking: tuple[Array, csc_array] | None = None
        places = np.zeros(wheel.problem.wheel.plates.reference.shape, dtype=bool)
        places[:, 0] = True
        slopes = np.zeros_like(places)
        slopes[:, 1:3] = True
        self._slopes = np.flatnonzero(slopes.ravel())
        touched = np.abs(wheel.basis.T @ places.ravel().astype(float)) > 0.0
        self._astray = _ASTRAY * float(np.linalg.norm(wheel.problem.wheel.plates.reference[:, 0], axis=1).max())
        self._places = np.concatenate([np.flatnonzero(touched), wheel.size - HUB + np.arange(2)])

    def begin(self, start: Motion) -> Step:
        """Consistent accelerations."""
        a = self.wheel.accelerations(start)
        motion = Motion(time=start.time, y=start.y, v=start.v, a=a, pressed=start.pressed)
        none: Mixed = *self.wheel.problem.extrapolated(start.y[:-HUB], 0.0 * start.y[:-HUB]), start.pressed
        found = self.wheel.linearised(motion, none, self._damping(start.y))
        return Step(motion, a, found, motion, self._pull(found, 0.0 * a))

    def advance(self, here: Step, h: float) -> Step | None:
        """One step [s]; None if Newton's iteration does not converge.

        The iteration begins at the places of the state before, not at those that its rates lead to: a straight step
        there would stretch strips that turn. What was linearised last serves it.
        """
        last, beta, gamma = here.motion, self.beta, self.gamma
        share = (1.0 - self.alpha_m) / (1.0 - self.alpha_f)
        weights = by_v, by_a = gamma / (h * beta), share / (h * h * beta)
        auxiliary = self._auxiliary(here, last.a)
        ahead = h * last.v + h * h * ((0.5 - beta) * here.auxiliary + beta * auxiliary)
        v = last.v + h * ((1.0 - gamma) * here.auxiliary + gamma * auxiliary) - by_v * ahead
        y, a, at = last.y, last.a - by_a * ahead, here.at
        factored, before, pressed = here.factored, 0.0, last.pressed
        if factored is None or factored.weights != weights:
            factored = Factored.of(here.found, last.pressed[here.found.system.near] > 0.0, weights)
        damping = self._damping(last.y)
        for _ in range(self.settings.newton_iterations):
            done = None if factored is None else factored.step((y - at.y, v - at.v, a - at.a))
            if factored is None or done is None:
                return None
            (step, forces), found = done, factored.found
            pressed = np.zeros_like(last.pressed)
            pressed[found.system.near] = forces
            size = float(np.abs(step[self._places]).max())
            apart = size if before else float(np.abs((step - ahead)[self._places]).max())
            if not apart < (_DIVERGING * before if before else self._astray):
                return None
            mixed: Mixed = *self.wheel.problem.extrapolated(y[:-HUB], step[:-HUB]), pressed
            pull = self._pull(found, v + by_v * step - at.v)
            y, v, a = y + step, v + by_v * step, a + by_a * step
            # what is left if steps go on shrinking as they do (Hairer & Wanner, Solving ODEs II, IV.8, from memory)
            left, begun, before = size * min(1.0, size / before) if before else np.inf, at, size
            at = Motion(time=last.time + h, y=y, v=v, a=a, pressed=pressed)
            if left < self.settings.newton_tolerance * self.settings.tolerance:
                return Step(at, self._auxiliary(here, a), found, begun, pull, factored)
            found = self.wheel.linearised(at, mixed, damping, pull)
            factored = Factored.of(found, pressed[found.system.near] > 0.0, weights)
        return None

    def error(self, here: Step, found: Step, h: float) -> float:
        """Local error relative to its tolerance [-]."""
        change = np.abs((found.auxiliary - here.auxiliary)[self._places]).max()
        return float(h * h * abs(self.beta - 1.0 / 6.0) * change / self.settings.tolerance)

    def _damping(self, y: Array) -> csc_array:
        """The wheel's, as it is or was where no strip had turned by more than `_TURNED` since."""
        if self._braking is not None:
            change = self.wheel.basis @ (y - self._braking[0])[:-HUB]
            if np.abs(change[self._slopes]).max() <= _TURNED:
                return self._braking[1]
        self._braking = y, self.wheel.damping(y)
        return self._braking[1]

    def _pull(self, found: Linearised, rates: Array) -> Array:
        """Of the ground at all contacts with it (n_ground, 3) [-] after a step that changes the rates."""
        pull, ground = np.zeros((self.wheel.problem.counts[0], 3)), found.system.ground
        if found.rubbing is not None:
            pull[ground.points[found.rubs]] = found.rubbing.after(rates)
        return pull

    def _auxiliary(self, here: Step, a: Array) -> Array:
        weighted = self.alpha_f * here.motion.a + (1.0 - self.alpha_f) * a - self.alpha_m * here.auxiliary
        return np.asarray(weighted / (1.0 - self.alpha_m))
