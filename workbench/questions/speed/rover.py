"""Aims for the speed of the rover on brush tires, held against a kept run of its benchmark.

The names of the numbers serve benchmark and report. Verified by tests/unit/test_workbench_speed.py.
"""

from __future__ import annotations

from workbench.questions.speed.aim import Aim
from workbench.questions.speed.record import BenchmarkRecord

__all__ = ["BESIDE_EXUDYN", "FASTER", "PATHS", "PEER_TIME", "rover_aims"]

PATHS = {"straight path, 40 s": 40.0, "random rocks, 30 s": 30.0}
"""Cases, and how long each lasts [s]."""
FASTER = "faster than real time"
BESIDE_EXUDYN, PEER_TIME = "straight path, 40 s, beside EXUDYN", "processor time at equal error"
_REAL_TIME, _RATIO = 20.0, 2.0


def rover_aims(record: BenchmarkRecord) -> list[Aim]:
    """Aims of the kept run, one core; without EXUDYN in it, those that need none."""
    aims = [
        Aim(title=f"Rover on brush tires: {case}, {FASTER}", found=record.row(case, FASTER).ours, limit=_REAL_TIME)
        for case in PATHS
    ]
    for case in record.cases(PEER_TIME):
        title = "Rover on brush tires: faster than EXUDYN at equal error of the place, same model"
        aims.append(Aim(title=title, found=record.row(case, PEER_TIME).ratio or 0.0, limit=_RATIO))
    return aims
