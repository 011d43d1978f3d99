"""The mission's runs on fitted tires and on brush tires.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from workbench.questions.rover.drive import Drive
from workbench.questions.rover_mission.requirements import MissionRow, mission_rows, tightest

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

    @property
    def decided(self) -> list[tuple[str, MissionRow, int]]:
        """A row for each scenario: its title, what decides it on fitted tires, how many things are required of it."""
        found: dict[str, list[MissionRow]] = {}
        for row in self.rows:
            found.setdefault(row.title, []).append(row)
        return [(title, self._deciding(rows), len(rows)) for title, rows in found.items()]

    @staticmethod
    def _deciding(rows: Sequence[MissionRow]) -> MissionRow:
        ended = [row for row in rows if row.ours is None]
        if ended:
            return ended[0]
        last = tightest([row.ours for row in rows if row.ours is not None])
        return next(row for row in rows if row.ours is last)
