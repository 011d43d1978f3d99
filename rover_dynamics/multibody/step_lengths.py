"""What every choice of implicit steps has: an error allowed, three lengths, and damping at the highest frequencies.

Verified by tests/unit/test_multibody_implicit_steps.py and tests/unit/test_flexible_steps.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError

__all__ = ["StepLengths"]


@dataclass(frozen=True, slots=True, kw_only=True)
class StepLengths:
    """Error allowed in a step, and the lengths it may have.

    Attributes
    ----------
    tolerance : estimated error of a step in its coordinates [m, rad]
    first, shortest, longest : steps [s]
    spectral_radius : at infinity, from 0 to 1; below one the highest frequencies are damped [-]

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

    def __post_init__(self) -> None:
        defaults = type(self).__dataclass_fields__
        usual = [f"{defaults[name].default:g}" for name in ("tolerance", "shortest", "first", "longest")]
        if not (math.isfinite(self.tolerance) and self.tolerance > 0.0):
            value = f"{self.tolerance:g} m or rad"
            raise InputError("error allowed in a step", value, "must be finite and > 0", f"give e.g. {usual[0]}")
        if not (0.0 < self.shortest <= self.first <= self.longest < math.inf):
            value = f"{self.shortest:g}, {self.first:g}, {self.longest:g} s"
            rule, advice = "must be above zero, finite and in this order", f"give e.g. {', '.join(usual[1:])} s"
            raise InputError("shortest, first and longest step", value, rule, advice)
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise InputError("spectral radius", f"{self.spectral_radius:g}", "must lie in 0 ... 1", "give e.g. 0.6")
