"""Checks of the mission's requirements: one for each number a scenario has a limit for.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import partial

from contracts.records import Check
from workbench.questions.rover_mission.row import MissionRow
from workbench.verdict.rules import Claim, at_least, at_most

__all__ = ["MISSION_SOURCE", "mission_checks"]

MISSION_SOURCE = "mission requirements, Samarini 2020, section 1, after Poulakis et al. 2015"


def mission_checks(rows: Iterable[MissionRow], prefix: str, tires: str) -> list[Check]:
    """Findings, named after their scenario: ``{prefix}step``, ``{prefix}step_2``, and so on.

    ``tires`` says in words what the rover drives on, ``"ANCF tires"``.
    """
    before: Counter[str] = Counter()
    checks = []
    for row in rows:
        before[row.name] += 1
        end = f"_{before[row.name]}" if before[row.name] > 1 else ""
        claim = Claim(
            id=f"{prefix}{row.name}{end}",
            title=f"Rover on {tires}, {row.title}: {row.quantity}",
            quantity=row.quantity if row.ours else "run",
            unit=row.ours.unit if row.ours else "-",
            role="finding",
            source=MISSION_SOURCE,
        )
        if row.ours is None:
            checks.append(at_least(claim, partial(float, row.stopped is None), 1.0))
            continue
        rule = at_least if row.ours.at_least else at_most
        checks.append(rule(claim, partial(float, row.ours.value), row.ours.limit or 0.0))
    return checks
