"""Steps that keep their length as long as they can, so that one Newton matrix serves for many.

Verified by tests/unit/test_flexible_steps.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError

__all__ = ["EvenSteps"]

_GROW = 0.06
"""Error over its tolerance below which the length is doubled: third order makes it eight times as large."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EvenSteps:
    """Lengths are halved and doubled only.

    Attributes
    ----------
    tolerance : estimated error of a step in joint coordinates and positions of nodes [m, rad]; what the default leaves
        in motions of the rover is in benchmarks/README.md
    first, shortest, longest : steps [s]
    spectral_radius : at infinity, from 0 to 1; below one the highest frequencies are damped [-]

    Raises
    ------
    InputError
        For a length or tolerance that is not above zero, lengths out of order, or a radius that is none.
    """

    tolerance: float = 1e-5
    first: float = 1e-3
    shortest: float = 1e-7
    longest: float = 0.05
    spectral_radius: float = 0.6

    def __post_init__(self) -> None:
        if not (math.isfinite(self.tolerance) and self.tolerance > 0.0):
            value = f"{self.tolerance:g} m or rad"
            raise InputError("error allowed in a step", value, "must be finite and > 0", "give e.g. 1e-5")
        if not (0.0 < self.shortest <= self.first <= self.longest < math.inf):
            value = f"{self.shortest:g}, {self.first:g}, {self.longest:g} s"
            rule = "must be above zero, finite and in this order"
            raise InputError("shortest, first and longest step", value, rule, "give e.g. 1e-7, 1e-3 and 0.05 s")
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise InputError("spectral radius", f"{self.spectral_radius:g}", "must lie in 0 ... 1", "give e.g. 0.6")

    def towards(self, left: float, length: float) -> float:
        """Length with ``left`` to go to the next output: the wish, or less so that equal steps get there [s]."""
        return left / max(1, math.ceil(left / length * (1.0 - 1e-9)))

    def after(self, length: float, dt: float, error: float) -> float:
        """Wish for the next step [s]; ``error`` is infinite for one that failed."""
        if not error <= self.tolerance:
            return 0.5 * dt
        return min(2.0 * length, self.longest) if error < _GROW * self.tolerance and dt > 0.7 * length else length
