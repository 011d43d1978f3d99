"""How the hub of a wheel that is pressed on the ground is then moved or turned, one way at a time.

Verified by tests/unit/test_hub_travel.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise
from typing import NamedTuple

from contracts.errors import InputError

__all__ = ["OVER_GROUND", "GroundMotion", "HubTravel", "Way"]

_LEVER = 0.05
"""Control parameter of a turn by one radian [m/rad]: its steps move the ends of a contact as those of a travel do."""


class Way(StrEnum):
    """How the hub moves over the ground."""

    FORE_AFT = "fore_aft"
    """Forwards."""
    LATERAL = "lateral"
    """To the left."""
    TURNING = "turning"
    """Counter-clockwise from above about the ground's normal through its centre, as a steered wheel that stands."""
    RADIAL = "radial"
    """Down, pressed on."""
    LEANING = "leaning"
    """To the right about the forward direction through its centre."""
    WIND_UP = "wind_up"
    """Forwards about its axle, as a drive turns it whose wheel the ground holds."""

    @property
    def turns(self) -> bool:
        """Whether it is an angle [rad] that a moment [N m] resists; else a length [m] and a force [N]."""
        return self in (Way.LEANING, Way.WIND_UP, Way.TURNING)

    @property
    def mirrored(self) -> bool:
        """Whether half a wheel stands for the whole: the way is symmetric about the wheel's middle plane."""
        return self in (Way.FORE_AFT, Way.RADIAL, Way.WIND_UP)


OVER_GROUND = (Way.FORE_AFT, Way.LATERAL, Way.TURNING)
"""Ways that leave ground and hub as far apart as they are: what a tire's carcass is known by."""


class GroundMotion(NamedTuple):
    """Motion of the ground since first touch: forward, left, up in its axes [m], and with that about the hub's centre:
    about forward, the axle, up [rad]; one of these turns at most.
    """

    forward: float
    left: float
    up: float
    leant: float = 0.0
    wound: float = 0.0
    turned: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class HubTravel:
    """Deflection first, then a travel at that deflection, both along one control parameter [m].

    Attributes
    ----------
    way : see `Way`
    start : deflection at which it begins [m]
    steps : how far the hub has moved over the ground, ascending from above zero [m; rad of a turn]

    Raises
    ------
    InputError
        For a start or steps that are not finite or do not increase from above zero.
    """

    way: Way
    start: float
    steps: tuple[float, ...]

    def __post_init__(self) -> None:
        if not (math.isfinite(self.start) and self.start > 0.0):
            raise InputError(
                "start of a travel", f"{self.start:g} m", "must be finite and > 0", "press the wheel first"
            )
        rising = all(a < b for a, b in pairwise((0.0, *self.steps)))
        if not self.steps or not rising or not all(math.isfinite(one) for one in self.steps):
            raise InputError("travel", list(self.steps), "must increase from above zero", "sort it and drop repeats")

    @property
    def controls(self) -> tuple[float, ...]:
        """Control parameter at each step [m]."""
        return tuple(self.start + self._scale * step for step in self.steps)

    def at(self, control: float) -> float:
        """How far the hub has moved over the ground at a control parameter [m; rad of a turn]."""
        return max(0.0, control - self.start) / self._scale

    def ground(self, control: float) -> GroundMotion:
        """The ground rises up to the start, and then moves against the hub's travel."""
        up, gone = min(control, self.start), self.at(control)
        match self.way:
            case Way.FORE_AFT:
                return GroundMotion(-gone, 0.0, up)
            case Way.LATERAL:
                return GroundMotion(0.0, -gone, up)
            case Way.TURNING:
                return GroundMotion(0.0, 0.0, up, turned=-gone)
            case Way.WIND_UP:
                return GroundMotion(0.0, 0.0, up, wound=-gone)
            case Way.RADIAL:
                return GroundMotion(0.0, 0.0, up + gone)
            case Way.LEANING:
                return GroundMotion(0.0, 0.0, up, leant=-gone)

    @property
    def _scale(self) -> float:
        return _LEVER if self.way.turns else 1.0
