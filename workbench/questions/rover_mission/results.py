"""The mission's runs on fitted tires and on brush tires.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from workbench.questions.rover.drive import Drive
from workbench.questions.rover_mission.requirements import MissionRow, mission_rows

__all__ = ["Mission"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Mission:
    """Runs on fitted tires and on brush tires, by scenario.

    ``tire`` is the fit's name, ``friction`` that of the study's ground or None.
    """

    fitted: Mapping[str, Drive]
    brush: Mapping[str, Drive]
    tire: str
    friction: float | None

    @property
    def rows(self) -> list[MissionRow]:
        """What is required of each run on fitted tires."""
        return mission_rows(self.fitted, self.brush)
