"""Lengths of implicit steps.

Verified by tests/unit/test_multibody_implicit_steps.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError
from rover_dynamics.multibody.step_lengths import StepLengths

__all__ = ["ImplicitSteps"]

_SAFETY, _GROWTH, _FAILED = 0.85, 2.0, 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class ImplicitSteps(StepLengths):
    """How steps are chosen: the local error of second-order steps grows with the third power of their length.

    Attributes
    ----------
    fixed : length of all steps, but the last ones before an output, without error control [s]; None for error control

    The others are those of `StepLengths`; the coordinates of the error are those of the joints.

    Raises
    ------
    InputError
        As `StepLengths` does, and for a fixed length that is not above zero.
    """

    fixed: float | None = None

    def __post_init__(self) -> None:
        super(ImplicitSteps, self).__post_init__()
        if self.fixed is not None and not 0.0 < self.fixed < math.inf:
            raise InputError("fixed step", f"{self.fixed:g} s", "must be finite and > 0", "leave it out")

    def accepts(self, error: float) -> bool:
        """Whether a step with this estimated error [m, rad] counts; one that failed has an infinite one."""
        return math.isfinite(error) if self.fixed is not None else error <= self.tolerance

    def towards(self, left: float, length: float) -> float:
        """Step for the wish ``length`` with ``left`` to go to the next output: all or half of it, or the wish [s]."""
        wish = min(length, self.longest) if self.fixed is None else self.fixed
        if wish >= left * (1.0 - 1e-9):
            return left
        return min(wish, 0.5 * left) if self.fixed is None else wish

    def after(self, dt: float, length: float, error: float) -> float:
        """Wish for the next step [s].

        Parameters
        ----------
        dt : step taken or refused [s]
        length : wish before, above dt where an output cut it [s]
        error : its estimated error, infinite if it failed [m, rad]
        """
        if not math.isfinite(error):
            return _FAILED * dt
        best = _SAFETY * dt * math.cbrt(self.tolerance / max(error, 1e-300))
        if error > self.tolerance:
            return max(best, 0.2 * dt)
        return min(best, max(length, _GROWTH * dt), self.longest)
