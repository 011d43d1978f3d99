"""Question: the mission's requirements on every kind of tire, by the record of `workbench mission`.

Nothing is driven here; a study without a record is not asked. Verified by
tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from contracts.records import Check
from workbench.questions.kept import OF_ANOTHER, Kept, State, kept
from workbench.questions.models.between import Between
from workbench.questions.models.wheel_tasks import ROCK_RADIUS
from workbench.questions.question import Question
from workbench.questions.rover_mission.graph import mission_tasks
from workbench.questions.rover_mission.requirements import MISSION, MISSION_SOURCE, TITLES
from workbench.questions.rover_mission.results import Mission, mission_of
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_least, at_most, undecided

__all__ = ["RECORD", "ROVER_MISSION", "TIRE_WORDS", "HeldMission"]

RECORD = "mission"
_BETWEEN, _ROCK = 0.01, 0.05
"""Of the load, ours [-]."""
TIRE_WORDS = {
    "rigid": "rigid wheels",
    "brush": "brush tires",
    "fe": "the wheel by its solid model",
    "ancf_wheel": "the wheel by its ANCF model",
    "ancf": "the thesis' ANCF tires",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldMission:
    """The record, whether it is about the study as it is, and what it says."""

    record: Kept
    state: State
    mission: Mission

    @property
    def words(self) -> Mapping[str, str]:
        """Tires and requirements in words."""
        return {**TIRE_WORDS, **TITLES}


def _read(study: Study, folders: Mapping[str, Path]) -> HeldMission:
    record = kept(study, RECORD, mission_of)
    assert record is not None  # else it is not asked
    mission = mission_of(record.found)
    state = record.state_of(lambda: mission_tasks(study, mission.tires))
    return HeldMission(record=record, state=state, mission=mission)


def _asked(study: Study) -> bool:
    """A record that cannot be read is told here, before anything is computed."""
    return study.rover is not None and kept(study, RECORD, mission_of) is not None


def _checks(study: Study, results: HeldMission) -> Sequence[Check]:
    mission = results.mission
    checks = [_of_tire(mission, tire) for tire in mission.tires]
    if mission.tried:
        claim = Claim(
            id="rover_mission.torque",
            title="Mission: requirements the ANCF wheel meets with 1.05 times the torque found on the solid",
            quantity="share",
            unit="-",
            role="finding",
            source="our own solid model of the same wheel under the same rover",
        )
        tried = mission.tried
        checks.append(at_least(claim, lambda: sum(bool(one.confirmed) for one in tried) / len(tried), 1.0))
    for tire, one in mission.between.items():
        what = "load half way between the orientations it goes through"
        checks.append(_apart(f"between_{tire}", tire, one, (what, "the same model solved there"), _BETWEEN))
    if mission.rock is not None:
        what = f"load on a half-round of {1e3 * ROCK_RADIUS:g} mm by its tangent plane"
        checks.append(_apart("rock", "fe", mission.rock, (what, "the same model solved on the half-round"), _ROCK))
    if results.state != "stale":
        return checks
    return [undecided(check, OF_ANOTHER) for check in checks]


def _apart(name: str, tire: str, found: Between, words: tuple[str, str], limit: float) -> Check:
    """What a tire's load differs by; ``words`` say of what, and by whom it is known."""
    what, source = words
    claim = Claim(
        id=f"rover_mission.{name}",
        title=f"Tire of {TIRE_WORDS[tire]}: {what}",
        quantity="difference",
        unit="-",
        role="finding",
        source=source,
    )
    return at_most(claim, lambda: abs(found.difference), limit)


def _of_tire(mission: Mission, tire: str) -> Check:
    """How many requirements are met; undecided where runs stopped and none missed one."""
    cells = mission.of_tire(tire)
    claim = Claim(
        id=f"rover_mission.{tire}",
        title=f"Mission on {TIRE_WORDS[tire]}: requirements met",
        quantity="requirements met",
        unit="-",
        role="finding",
        source=MISSION_SOURCE,
    )
    check = at_least(claim, lambda: float(sum(cell.decided == "met" for cell in cells)), float(len(MISSION)))
    open_ = any(cell.decided == "undecided" for cell in cells) and all(cell.decided != "not met" for cell in cells)
    return replace(check, status="undecided") if open_ else check


ROVER_MISSION = Question(
    name="rover_mission",
    title="Mission",
    group="Rover",
    read=_read,
    checks=_checks,
    applies=_asked,
    budget=620,
)
