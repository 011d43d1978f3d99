"""Aims for the speed of the rover on ANCF tires, held against a kept run of its benchmark.

The names of the numbers serve benchmark and report. Verified by tests/unit/test_workbench_speed.py.
"""

from __future__ import annotations

from workbench.questions.speed.aim import Aim
from workbench.questions.speed.record import BenchmarkRecord

__all__ = ["BARE", "FASTER", "STRAIGHT_PATH", "TIME", "flexible_aims"]

STRAIGHT_PATH, TIME, FASTER = "straight path, 40 s", "processor time", "faster than real time"
BARE = "time over that of the bare kernels"
"""Of the same number of forces and tangents of plates and contact, and of the bodies' equations."""
_SECONDS = 20.0


def flexible_aims(record: BenchmarkRecord) -> list[Aim]:
    """Aims of the kept run, one core."""
    found = record.row(STRAIGHT_PATH, TIME).ours
    title = "Rover on six ANCF tires, 100 contact points a plate: 40 s of the straight path"
    return [Aim(title=title, found=found, limit=_SECONDS, unit="s", rule="at most")]
