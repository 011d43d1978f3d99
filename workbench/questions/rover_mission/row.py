"""What runs on ANCF tires say of the mission's requirements.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.questions.rover.drive import Drive

__all__ = ["TITLES", "Mission", "MissionRow", "mission_rows"]

TITLES = {
    "slope_up": "slope of 25 degrees, upwards",
    "slope_down": "slope of 25 degrees, downwards",
    "slope_across": "slope of 25 degrees, across",
    "step": "step of 0.25 m",
    "crevasse": "crevasse of 0.15 m",
    "point_turn": "quarter turn on the spot",
    "rocks": "straight path over random rocks",
}
"""Scenario -> in words, in the order of the report."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionRow:
    """One requirement.

    Attributes
    ----------
    name, title : of the scenario, ``"slope_up"``, and what it is called
    quantity : what is required
    ours : number found on ANCF tires; None where the run stopped or nothing is required
    theirs : the same on brush tires; None where there is no such run
    stopped : why the run on ANCF tires stopped, if ``ours`` is None for that
    """

    name: str
    title: str
    quantity: str
    ours: Outcome | None = None
    theirs: Outcome | None = None
    stopped: str | None = None


def mission_rows(driven: Mapping[str, Drive], brush: Mapping[str, Drive]) -> list[MissionRow]:
    """Of all runs that are scenarios of the mission, by name; one row for a run nothing is required of, or stopped."""
    rows = []
    for name, title in TITLES.items():
        if name not in driven:
            continue
        run, theirs = driven[name], {one.quantity: one for one in brush[name].outcomes} if name in brush else {}
        ours = [one for one in run.outcomes if one.limit is not None]
        if run.stopped or not ours:
            rows.append(MissionRow(name=name, title=title, quantity="the run reaches its end", stopped=run.stopped))
        rows += [
            MissionRow(name=name, title=title, quantity=one.quantity, ours=one, theirs=theirs.get(one.quantity))
            for one in ours
        ]
    return rows


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
