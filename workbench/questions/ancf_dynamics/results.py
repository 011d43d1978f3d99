"""Motions of one ANCF wheel, as the report reads them.

Verified by tests/unit/test_workbench_ancf_dynamics.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contracts.series import TimeSeries

if TYPE_CHECKING:
    from workbench.questions.ancf_dynamics.records import MotionNumbers

__all__ = ["AncfMotion", "AncfMotions"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfMotion:
    """One motion: what was asked, what was found, and its time series."""

    name: str
    title: str
    numbers: MotionNumbers
    series: TimeSeries


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfMotions:
    """Drop, drop with the rover's share, ride."""

    radius: float
    motions: tuple[AncfMotion, ...]

    def __getitem__(self, name: str) -> AncfMotion:
        return next(motion for motion in self.motions if motion.name == name)

    def drop_of(self, motion: AncfMotion) -> float:
        """Largest deflection of the hub below the nominal radius [m]."""
        return self.radius - motion.numbers.lowest_m
