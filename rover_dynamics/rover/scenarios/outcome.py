"""A number a scenario ends with, and the requirement it is held against, if there is one.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError

__all__ = ["LEAST_FRICTION", "Outcome"]

LEAST_FRICTION = 0.02
"""Smallest coefficient of friction that a search tries [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """A number found.

    Attributes
    ----------
    quantity, value, unit : what it is
    reference : number of the thesis or of a closed form it may be compared with, or None
    limit : what the mission requires, or None for a number nothing is required of
    at_least : whether the value must reach the limit (else it must not exceed it)
    """

    quantity: str
    value: float
    unit: str
    reference: float | None = None
    limit: float | None = None
    at_least: bool = True

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise InputError(self.quantity, f"{self.value:g} {self.unit}", "must be finite", "look at the motion")

    @property
    def margin(self) -> float | None:
        """How far the value lies on the good side of its limit [unit]; negative if not met."""
        if self.limit is None:
            return None
        return self.value - self.limit if self.at_least else self.limit - self.value

    @property
    def met(self) -> bool | None:
        """Whether the requirement is met; None without one."""
        return None if self.margin is None else self.margin >= 0.0
