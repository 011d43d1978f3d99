"""Lengths of implicit steps.

Verified by tests/unit/test_multibody_implicit_steps.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError

__all__ = ["ImplicitSteps"]

_SAFETY, _GROWTH, _FAILED = 0.85, 2.0, 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class ImplicitSteps:
    """How steps are chosen: the local error of second-order steps grows with the third power of their length.

    Attributes
    ----------
    tolerance : estimated error of a step in the joint coordinates [m, rad]
    first, shortest, longest : steps [s]
    spectral_radius : at infinity, from 0 to 1; below one the highest frequencies are damped [-]
    fixed : length of all steps, but the last ones before an output, without error control [s]; None for error control

    Raises
    ------
    InputError
        For a length or tolerance that is not above zero, lengths out of order, or a radius that is none.
    """

    tolerance: float = 1e-6
    first: float = 1e-4
    shortest: float = 1e-9
    longest: float = 0.02
    spectral_radius: float = 0.6
    fixed: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.tolerance) and self.tolerance > 0.0):
            value = f"{self.tolerance:g} m or rad"
            raise InputError("error allowed in a step", value, "must be finite and > 0", "give e.g. 1e-6")
        if not (0.0 < self.shortest <= self.first <= self.longest < math.inf):
            value = f"{self.shortest:g}, {self.first:g}, {self.longest:g} s"
            rule = "must be above zero, finite and in this order"
            raise InputError("shortest, first and longest step", value, rule, "give e.g. 1e-9, 1e-4 and 0.02 s")
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise InputError("spectral radius", f"{self.spectral_radius:g}", "must lie in 0 ... 1", "give e.g. 0.6")
        if self.fixed is not None and not 0.0 < self.fixed < math.inf:
            raise InputError("fixed step", f"{self.fixed:g} s", "must be finite and > 0", "leave it out")

    def accepts(self, error: float) -> bool:
        """Whether a step with this estimated error counts; one that failed has an infinite one."""
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
