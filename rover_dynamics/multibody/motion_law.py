"""Functions of time for drives: a value with its first two derivatives.

A drive that follows a speed needs the angle too, so that position, velocity and acceleration agree: every law here is
integrated in closed form. Verified by tests/unit/test_multibody_motion_law.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from contracts.errors import InputError

__all__ = ["Hold", "MotionLaw", "SpeedTrapezoid", "Turn", "UserLaw"]


class MotionLaw(Protocol):
    """Value of a driven coordinate and its derivatives."""

    def at(self, t: float) -> tuple[float, float, float]:
        """Value [rad or m], rate [1/s] and acceleration [1/s^2] at time t [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hold:
    """A coordinate that keeps its value [rad or m]."""

    value: float = 0.0

    def at(self, t: float) -> tuple[float, float, float]:
        """See `MotionLaw`."""
        return self.value, 0.0, 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class UserLaw:
    """A user's own function of time; it returns what `MotionLaw.at` does [rad or m, 1/s, 1/s^2]."""

    function: Callable[[float], tuple[float, float, float]]

    def at(self, t: float) -> tuple[float, float, float]:
        """See `MotionLaw`."""
        return self.function(t)


@dataclass(frozen=True, slots=True, kw_only=True)
class Turn:
    """From ``start`` to ``end`` between two times, by the polynomial 10 s^3 - 15 s^4 + 6 s^5: no jump in acceleration.

    Attributes
    ----------
    start, end : values [rad or m]
    begins : time at which it begins [s]
    lasts : duration > 0 [s]
    """

    start: float = 0.0
    end: float
    begins: float = 0.0
    lasts: float

    def __post_init__(self) -> None:
        _positive("duration of a turn", self.lasts)

    def at(self, t: float) -> tuple[float, float, float]:
        """See `MotionLaw`."""
        s = min(max((t - self.begins) / self.lasts, 0.0), 1.0)
        change = self.end - self.start
        value = self.start + change * s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
        rate = change * 30.0 * (s * (1.0 - s)) ** 2 / self.lasts
        return value, rate, change * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / self.lasts**2


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedTrapezoid:
    """A speed that rises, stays and falls; each change by the cubic 3 s^2 - 2 s^3: no jump in acceleration.

    Attributes
    ----------
    speed : reached speed [rad/s or m/s]
    begins : start of the acceleration [s]
    accelerates, decelerates : durations > 0 [s]
    ends : time of standstill [s]; infinite for a drive that goes on
    start : value before the motion [rad or m]
    """

    speed: float
    begins: float = 0.0
    accelerates: float
    decelerates: float = 1.0
    ends: float = math.inf
    start: float = 0.0

    def __post_init__(self) -> None:
        _positive("acceleration time", self.accelerates)
        _positive("deceleration time", self.decelerates)
        shortest = self.begins + self.accelerates + self.decelerates
        if self.ends < shortest:
            rule = f"must leave time to accelerate and decelerate, {shortest:g} s"
            raise InputError("end of a drive", f"{self.ends:g} s", rule, "let it end later")

    def at(self, t: float) -> tuple[float, float, float]:
        """See `MotionLaw`."""
        up = _ramp((t - self.begins) / self.accelerates)
        down = _ramp((t - self.ends + self.decelerates) / self.decelerates) if math.isfinite(self.ends) else (0.0,) * 3
        travelled = self.accelerates * up[0] - self.decelerates * down[0]
        acceleration = up[2] / self.accelerates - down[2] / self.decelerates
        return self.start + self.speed * travelled, self.speed * (up[1] - down[1]), self.speed * acceleration


def _ramp(s: float) -> tuple[float, float, float]:
    """Integral, value and derivative of the cubic from 0 to 1 over 0 <= s <= 1."""
    if s <= 0.0:
        return 0.0, 0.0, 0.0
    if s >= 1.0:
        return s - 0.5, 1.0, 0.0
    return s**3 - 0.5 * s**4, s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s)


def _positive(what: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(what, f"{value:g} s", "must be finite and > 0", "give e.g. 5 s")
