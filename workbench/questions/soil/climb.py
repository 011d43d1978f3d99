"""The rover on slopes of soil: what is asked, what a record of ``workbench climb`` holds.

Verified by tests/unit/test_workbench_climb.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal, get_args

import numpy as np

from soil.carcass import Carcass
from soil.soil import Soil
from soil.steady_wheel import WheelOnSoil
from workbench.execution.task import Task
from workbench.questions.kept import require_numbers

__all__ = ["DIRECTIONS", "RECORD", "STUCK", "Climb", "Climbs", "climb_tasks", "climbs_of", "found_of"]

RECORD = "climb"
Direction = Literal["up", "down", "across"]
DIRECTIONS: tuple[Direction, ...] = get_args(Direction)
STUCK = 0.6
"""Slip from which on a rover counts as stuck: the wheel's pull on the bench grows no more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Climb:
    """One drive on a slope.

    Attributes
    ----------
    angle_deg : of the slope
    slip : of the rover while all its wheels press fresh soil: its speed ahead over that of its rims, from 1 [-]; it
        slides back above 1
    largest : of the slip's means over 5 s from its steady drive on; `STUCK` or more: it does not climb
    drift : speed to the left over that of its rims [-]
    torque : mean of all drives [N m]
    energy : of the drives a metre of way [J/m]; None where it does not come ahead
    slip_in_ruts, energy_in_ruts : once middle and rear wheels run in ruts; None where it does not come so far
    sinkage : deepest of a wheel [m]
    stopped : why there is no number, else empty
    """

    angle_deg: float
    slip: float | None = None
    largest: float | None = None
    drift: float | None = None
    torque: float | None = None
    energy: float | None = None
    slip_in_ruts: float | None = None
    energy_in_ruts: float | None = None
    sinkage: float | None = None
    stopped: str = ""

    @property
    def climbs(self) -> bool:
        """Whether the rover is never stuck."""
        return self.largest is not None and self.largest < STUCK


@dataclass(frozen=True, slots=True, kw_only=True)
class Climbs:
    """All drives on one soil and tire towards one direction, by angle."""

    soil: str
    tire: str
    direction: str
    rows: tuple[Climb, ...]

    @property
    def steepest(self) -> float:
        """Steepest slope driven up to which the rover is never stuck [deg]; 0 if it is on all.

        No line leads to the next drive, as the slip leaps: a rover that slips more sinks more.
        """
        found = 0.0
        for row in self.rows:
            if not row.climbs:
                break
            found = row.angle_deg
        return found

    @property
    def all_climbed(self) -> bool:
        """Whether the rover is stuck on none of the slopes that were driven: the steepest one may lie beyond them."""
        return all(row.climbs for row in self.rows)

    @property
    def shown(self) -> str:
        """The steepest slope in words [deg], as a bound where it may lie beyond what was driven."""
        return f"{'≥' if self.all_climbed else ''}{self.steepest:.1f}"

    def at(self, angle_deg: float) -> Climb | None:
        """The drive at an angle [deg], if there is one."""
        return next((row for row in self.rows if abs(row.angle_deg - angle_deg) < 1e-6), None)


def climb_tasks(
    soils: Sequence[Soil],
    wheels: Mapping[str, tuple[WheelOnSoil, float | None]],
    angles: Sequence[float],
    cell: float,
) -> list[Task]:
    """A task for each soil, tire and direction; ``wheels`` by tire, with the time in which its rim settles [s]."""
    return [
        Task(
            name=f"climb_{soil.name}_{tire}_{direction}",
            function="workbench.questions.soil.climb_task:climb",
            inputs={
                "soil": asdict(soil),
                "wheel": {name: getattr(wheel, name) for name in ("radius", "width", "lug_height", "lugs")},
                "carcass": _values(wheel.carcass),
                "settling": settling,
                "direction": direction,
                "angles": list(angles),
                "cell": cell,
            },
            cost=4.0 * len(angles),
            resumable=True,
        )
        for soil in soils
        for tire, (wheel, settling) in wheels.items()
        for direction in DIRECTIONS
    ]


def _values(carcass: Carcass) -> dict[str, Any]:
    """As `workbench.questions.soil.bench.carcass_of` reads it."""
    return {
        "compliance": list(carcass.compliance),
        "curve": [list(pair) for pair in carcass.curve],
        "load_N": carcass.load,
        "source": carcass.source,
    }


def found_of(climbs: Sequence[Climbs]) -> dict[str, Any]:
    """For the record."""
    return {"climbs": [asdict(one) for one in climbs]}


def climbs_of(found: Mapping[str, Any]) -> tuple[Climbs, ...]:
    """From a record; raises what `kept` turns into a message."""
    climbs = tuple(Climbs(**(one | {"rows": tuple(Climb(**row) for row in one["rows"])})) for one in found["climbs"])
    for one in climbs:
        if not all(isinstance(w, str) for w in (one.soil, one.tire, *(row.stopped for row in one.rows))):
            raise ValueError("soil, tire and stopped are texts")
        if one.direction not in DIRECTIONS:
            raise ValueError(f"a direction is one of {', '.join(DIRECTIONS)}")
        for row in one.rows:
            numbers = [value for name, value in asdict(row).items() if name not in ("angle_deg", "stopped")]
            require_numbers([row.angle_deg, *(value for value in numbers if value is not None)])
    slopes = [[row.angle_deg for row in one.rows] for one in climbs]
    rise = slopes and all(one and np.all(np.diff(one) > 0.0) for one in slopes)
    if not rise or len(set.intersection(*map(set, slopes))) < min(len(one) for one in slopes):
        raise ValueError("climbs are drives on the same slopes, from one on, which rise, and others between them")
    return climbs
