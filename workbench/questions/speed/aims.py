"""Aims for speed, held against kept runs of the benchmarks: ANCF tire, rover on brush tires, rover on ANCF tires.

The names of the numbers serve benchmarks and report. Verified by tests/unit/test_workbench_speed.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from workbench.questions.speed.record import BenchmarkRecord

__all__ = [
    "ARITHMETIC",
    "BARE",
    "BESIDE_EXUDYN",
    "CHRONO",
    "CURVES",
    "DAMPING_RATIOS",
    "FASTER",
    "FORCE",
    "FORCE_AND_TANGENT",
    "PATHS",
    "PEER_TIME",
    "STRAIGHT_PATH",
    "TIME",
    "TIRE",
    "Aim",
    "ancf_aims",
    "flexible_aims",
    "on_its_curves",
    "rover_aims",
    "wheel_case",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Aim:
    """One aim: what was wanted (at least ``limit``, more than it, or at most it), and what was found."""

    title: str
    found: float
    limit: float
    unit: str = "times"
    rule: Literal["at least", "more than", "at most"] = "at least"

    @property
    def met(self) -> bool:
        """Whether the number found lies on the right side of the limit."""
        if self.rule == "at most":
            return self.found <= self.limit
        return self.found >= self.limit if self.rule == "at least" else self.found > self.limit


FASTER = "faster than real time"


TIRE = "8-plate tire"
FORCE, FORCE_AND_TANGENT, CURVES = "force", "force with tangent, a plate", "36 curves of 35 loads, processor time"
ARITHMETIC = {"force": "force over its arithmetic", "tangent": "tangent of a plate over its arithmetic"}
DAMPING_RATIOS = (0.0, 0.02, 0.05)
"""Of the first mode."""
CHRONO = {"force [us]": 2.3, "force with tangent [us]": 94.0, "a step of 1 ms of an 8-plate tire [ms]": 2.6}
"""Project Chrono's plate of the same kind, built from source and measured once, on another machine."""


def wheel_case(ratio: float) -> str:
    """The wheel that stands on its hub's weight, by the damping ratio of its first mode."""
    return f"wheel, damping {ratio:g}"


def ancf_aims(record: BenchmarkRecord) -> list[Aim]:
    """Aims of the kept run of the ANCF tire, one core."""

    def at_most(title: str, metric: str, limit: float, unit: str) -> Aim:
        found = record.row(TIRE, metric).ours
        return Aim(title=title, found=found, limit=limit, unit=unit, rule="at most")

    aims = [
        at_most("ANCF: force of the 8-plate tire, 4 x 4 x 2 points a plate", FORCE, 18.0, "µs"),
        at_most("ANCF: force with tangent, a plate", FORCE_AND_TANGENT, 40.0, "µs"),
        at_most("ANCF: 36 orientations x 35 loads", CURVES, 5.0, "s"),
    ]
    for ratio in DAMPING_RATIOS:
        title = f"ANCF: one wheel faster than real time, {f'{100 * ratio:g} %' if ratio else 'no'} damping"
        aims.append(Aim(title=title, found=record.row(wheel_case(ratio), FASTER).ours, limit=5.0))
    return aims


PATHS = {"straight path, 40 s": 40.0, "random rocks, 30 s": 30.0}
"""Cases, and how long each lasts [s]."""
CURVES_FASTER = dict(zip(PATHS, (100.0, 20.0), strict=True))
"""Aims of the wheel by its curves, over real time."""
BESIDE_EXUDYN, PEER_TIME = "straight path, 40 s, beside EXUDYN", "processor time at equal error"


def on_its_curves(case: str) -> str:
    """The case in which the rover stands on a wheel by its curves."""
    return f"wheel by its curves, {case}"


def rover_aims(record: BenchmarkRecord) -> list[Aim]:
    """Aims of the kept run on brush tires, one core; without EXUDYN in it, those that need none."""
    aims = [
        Aim(title=f"Rover on brush tires: {case}, {FASTER}", found=record.row(case, FASTER).ours, limit=20.0)
        for case in PATHS
    ]
    driven = record.cases(FASTER)
    for case, limit in CURVES_FASTER.items():
        if (own := on_its_curves(case)) in driven:
            title = f"Rover on wheels by their curves: {case}, {FASTER}"
            aims.append(Aim(title=title, found=record.row(own, FASTER).ours, limit=limit))
    for case in record.cases(PEER_TIME):
        title = "Rover on brush tires: faster than EXUDYN at equal error of the place, same model"
        aims.append(Aim(title=title, found=record.row(case, PEER_TIME).ratio or 0.0, limit=2.0))
    return aims


STRAIGHT_PATH, TIME = "straight path, 40 s", "processor time"
BARE = "time over that of the bare kernels"
"""Of the same number of forces and tangents of plates and contact, and of the bodies' equations."""


def flexible_aims(record: BenchmarkRecord) -> list[Aim]:
    """Aims of the kept run on ANCF tires, one core."""
    found = record.row(STRAIGHT_PATH, TIME).ours
    title = "Rover on six ANCF tires, 100 contact points a plate: 40 s of the straight path"
    return [Aim(title=title, found=found, limit=20.0, unit="s", rule="at most")]
