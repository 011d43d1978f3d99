"""How the hub of a wheel that is pressed on the ground is then moved or turned, in straight legs.

Verified by tests/unit/test_hub_travel.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import accumulate, pairwise
from typing import NamedTuple

from contracts.errors import InputError

__all__ = ["OVER_GROUND", "GroundMotion", "HubPlace", "HubTravel", "Leg", "Way"]

_LEVER = 0.05
"""Control parameter of a turn by one radian [m/rad]: its steps move the ends of a contact as those of a travel do."""
_FEWEST = 4
"""Steps of a leg of a path."""


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
    """Motion of the ground since first touch: forward, left, up in its axes [m], and with that about the hub's centre.

    That is a turn by one rotation vector: about forward, the axle, up [rad].
    """

    forward: float
    left: float
    up: float
    leant: float = 0.0
    wound: float = 0.0
    turned: float = 0.0


class HubPlace(NamedTuple):
    """Where the hub is, by the names of `Way`: lengths [m] and turns [rad] since first touch."""

    fore_aft: float = 0.0
    lateral: float = 0.0
    radial: float = 0.0
    leaning: float = 0.0
    wind_up: float = 0.0
    turning: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """A straight part of a travel.

    Attributes
    ----------
    rates : change of the hub's place for a unit of the leg
    scale : control parameter for a unit of the leg
    steps : where it stops, ascending from above zero [m; rad where it turns one way alone]

    Raises
    ------
    InputError
        For steps that are not finite or do not increase from above zero.
    """

    rates: HubPlace
    scale: float
    steps: tuple[float, ...]

    def __post_init__(self) -> None:
        rising = all(a < b for a, b in pairwise((0.0, *self.steps)))
        if not self.steps or not rising or not all(math.isfinite(one) for one in self.steps):
            raise InputError("travel", list(self.steps), "must increase from above zero", "sort it and drop repeats")

    @classmethod
    def along(cls, way: Way, steps: Sequence[float], sense: float = 1.0) -> Leg:
        """One way alone, or with a sense of -1 against it."""
        scale = _LEVER if way.turns else 1.0
        return cls(rates=HubPlace(**{way.value: sense}), scale=scale, steps=tuple(steps))

    @classmethod
    def between(cls, begin: HubPlace, end: HubPlace, longest: float) -> Leg:
        """From one place to another in equal steps, four at least, of at most so much of the control parameter [m].

        Raises
        ------
        InputError
            If both are the same place.
        """
        changes = {way: getattr(end, way) - getattr(begin, way) for way in Way}
        moved = {way: change for way, change in changes.items() if change}
        if not moved:
            raise InputError("leg of a path", "", "ends where it begins", "leave it out")
        size = math.hypot(*(change * (_LEVER if way.turns else 1.0) for way, change in moved.items()))
        count = max(_FEWEST, math.ceil(size / longest * (1.0 - 1e-9)))
        if len(moved) > 1:
            rates = HubPlace(**{way.value: change / size for way, change in moved.items()})
            return cls(rates=rates, scale=1.0, steps=tuple(size * k / count for k in range(1, count + 1)))
        (way, change) = next(iter(moved.items()))
        return cls.along(way, [abs(change) * k / count for k in range(1, count + 1)], math.copysign(1.0, change))

    def after(self, begin: HubPlace, gone: float) -> HubPlace:
        """Where the hub is so far along the leg [its unit]."""
        return HubPlace(*(place + rate * gone for place, rate in zip(begin, self.rates, strict=True)))


@dataclass(frozen=True, slots=True, kw_only=True)
class HubTravel:
    """Deflection first, then a travel from there, both along one control parameter [m].

    Attributes
    ----------
    start : deflection at which it begins [m]
    legs : one behind the other

    Raises
    ------
    InputError
        For a start that is not finite or not above zero, and without a leg.
    """

    start: float
    legs: tuple[Leg, ...]

    def __post_init__(self) -> None:
        if not (math.isfinite(self.start) and self.start > 0.0):
            raise InputError(
                "start of a travel", f"{self.start:g} m", "must be finite and > 0", "press the wheel first"
            )
        if not self.legs:
            raise InputError("travel", "", "goes nowhere", "give it a leg")

    @classmethod
    def along(cls, *, way: Way, start: float, steps: Sequence[float]) -> HubTravel:
        """One way [m; rad of a turn]."""
        return cls(start=start, legs=(Leg.along(way, steps),))

    @classmethod
    def through(cls, places: Sequence[Mapping[Way, float]], longest: float) -> HubTravel:
        """Straight from place to place, each of which says the ways that change to where [m; rad].

        longest : step [m of the control parameter]

        Raises
        ------
        InputError
            For a first place that is not the deflection alone.
        """
        if not places or places[0].keys() != {Way.RADIAL}:
            raise InputError("path", "", "must begin with the radial way alone", "press the wheel first: radial 10 mm")
        start = places[0][Way.RADIAL]
        at, legs = HubPlace(radial=start), list[Leg]()
        for place in places[1:]:
            end = at._replace(**{way.value: value for way, value in place.items()})
            legs.append(Leg.between(at, end, longest))
            at = end
        return cls(start=start, legs=tuple(legs))

    @property
    def ways(self) -> tuple[Way, ...]:
        """In which it moves."""
        return tuple(way for way in Way if any(getattr(leg.rates, way) for leg in self.legs))

    @property
    def slides(self) -> bool:
        """Whether it moves along the ground, or winds the wheel up against it: without friction nothing resists."""
        return any(way in (*OVER_GROUND, Way.WIND_UP) for way in self.ways)

    @property
    def controls(self) -> tuple[float, ...]:
        """Control parameter at each step [m]."""
        begins = self._begins()
        return tuple(begins[i] + leg.scale * step for i, leg in enumerate(self.legs) for step in leg.steps)

    def at(self, control: float) -> float:
        """How far along its present leg the hub is at a control parameter [m; rad of a turn]."""
        i, begin = self._leg(control)
        return max(0.0, control - begin) / self.legs[i].scale

    def place(self, control: float) -> HubPlace:
        """Where the hub is at a control parameter; it ends no leg but the last beyond its last step."""
        if control <= self.start:
            return HubPlace(radial=control)
        i, place = self._leg(control)[0], HubPlace(radial=self.start)
        for leg in self.legs[:i]:
            place = leg.after(place, leg.steps[-1])
        return self.legs[i].after(place, self.at(control))

    def ground(self, control: float) -> GroundMotion:
        """The ground rises up to the start, and then moves against the hub's travel."""
        hub = self.place(control)
        return GroundMotion(
            0.0 - hub.fore_aft,
            0.0 - hub.lateral,
            hub.radial,
            leant=0.0 - hub.leaning,
            wound=0.0 - hub.wind_up,
            turned=0.0 - hub.turning,
        )

    def _begins(self) -> tuple[float, ...]:
        """Control parameter at which each leg begins [m]."""
        return tuple(accumulate((leg.scale * leg.steps[-1] for leg in self.legs[:-1]), initial=self.start))

    def _leg(self, control: float) -> tuple[int, float]:
        """Number of the leg at a control parameter, and where it begins [m]."""
        begins = self._begins()
        i = max(0, sum(begin < control for begin in begins) - 1)
        return i, begins[i]
