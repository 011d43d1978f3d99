"""Aims for the speed of the ANCF tire, held against a kept run of its benchmark.

The names of the numbers serve benchmark and report. Verified by tests/unit/test_workbench_speed.py.
"""

from __future__ import annotations

from workbench.questions.speed.aim import Aim
from workbench.questions.speed.record import BenchmarkRecord

__all__ = [
    "ARITHMETIC",
    "CHRONO",
    "CURVES",
    "DAMPING_RATIOS",
    "FORCE",
    "FORCE_AND_TANGENT",
    "REAL_TIME",
    "TIRE",
    "ancf_aims",
    "wheel_case",
]

TIRE = "8-plate tire"
FORCE, FORCE_AND_TANGENT, CURVES = "force", "force with tangent, a plate", "36 curves of 35 loads, processor time"
ARITHMETIC = {"force": "force over its arithmetic", "tangent": "tangent of a plate over its arithmetic"}
REAL_TIME = "faster than real time"
DAMPING_RATIOS = (0.0, 0.02, 0.05)
"""Of the first mode."""
CHRONO = {"force [us]": 2.3, "force with tangent [us]": 94.0, "a step of 1 ms of an 8-plate tire [ms]": 2.6}
"""Project Chrono's plate of the same kind, built from source and measured once, on another machine."""


def wheel_case(ratio: float) -> str:
    """The wheel that stands on its hub's weight, by the damping ratio of its first mode."""
    return f"wheel, damping {ratio:g}"


def ancf_aims(record: BenchmarkRecord) -> list[Aim]:
    """Aims of the kept run, one core."""

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
        aims.append(Aim(title=title, found=record.row(wheel_case(ratio), REAL_TIME).ours, limit=5.0))
    return aims
