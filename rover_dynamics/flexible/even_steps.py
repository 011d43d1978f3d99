"""Steps that keep their length as long as they can, so that one Newton matrix serves for many.

Verified by tests/unit/test_flexible_steps.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rover_dynamics.multibody.step_lengths import StepLengths

__all__ = ["EvenSteps"]

_GROW = 0.06
"""Error over its tolerance below which the length is doubled: third order makes it eight times as large."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EvenSteps(StepLengths):
    """Lengths are halved and doubled only; fields as in `StepLengths`.

    What the default tolerance leaves in motions of the rover is in benchmarks/README.md. The coordinates of its error
    are those of the joints and the positions of nodes.
    """

    tolerance: float = 1e-5
    first: float = 1e-3
    shortest: float = 1e-7
    longest: float = 0.05

    def towards(self, left: float, length: float) -> float:
        """Length with ``left`` to go to the next output: the wish, or less so that equal steps get there [s]."""
        return left / max(1, math.ceil(left / length * (1.0 - 1e-9)))

    def after(self, length: float, dt: float, error: float) -> float:
        """Wish for the next step [s]; ``error`` is infinite for one that failed."""
        if not error <= self.tolerance:
            return 0.5 * dt
        return min(2.0 * length, self.longest) if error < _GROW * self.tolerance and dt > 0.7 * length else length
