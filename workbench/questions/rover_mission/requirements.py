"""What runs on ANCF tires say of the mission's requirements, and the checks: one for each number with a limit.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from contracts.records import Check
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.questions.rover.drive import Drive
from workbench.verdict.rules import Claim, at_least, at_most, stated

__all__ = ["MISSION_SOURCE", "TITLES", "MissionRow", "mission_checks", "mission_rows", "plainly"]

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


_FOLDS = re.compile(
    r"a tire folds at t = (?P<time>[-+.\de]+) s.*?: plate \d+ \((?P<part>\w+),.*?\) of wheel (?P<wheel>[\w ]+), "
    r"which carries (?P<load>[.\d]+) N"
)


def plainly(stopped: str) -> str:
    """Why a run stopped, for a reader who does not know the solver; its first clause where it is not a tire that folds.

    The sentence is that of `workbench.questions.rover.tire_shapes.TireShapes`. Verified by
    tests/unit/test_workbench_rover_mission.py.
    """
    found = _FOLDS.search(stopped)
    if found is None:
        return f"ended early: {re.split('[;.] ', stopped)[0]}"
    time = float(found["time"])
    when = f"stops at {time:.3g} s" if time >= 0.0 else "stops before it sets out"
    return f"{when}: a {found['part']} of the {found['wheel']} wheel folds at {found['load']} N"


MISSION_SOURCE = "mission requirements, Samarini 2020, section 1, after Poulakis et al. 2015"


def mission_checks(rows: Iterable[MissionRow], prefix: str, rover: str) -> list[Check]:
    """Findings, named after their scenario: ``{prefix}step``, ``{prefix}step_2``, and so on.

    ``rover`` says in words which it is, ``"Rover on ANCF tires"``.
    """
    before: Counter[str] = Counter()
    checks = []
    for row in rows:
        before[row.name] += 1
        end = f"_{before[row.name]}" if before[row.name] > 1 else ""
        claim = Claim(
            id=f"{prefix}{row.name}{end}",
            title=f"{rover}, {row.title}: {row.quantity}",
            quantity=row.quantity if row.ours else "run",
            unit=row.ours.unit if row.ours else "-",
            role="finding",
            source=MISSION_SOURCE,
        )
        if row.stopped is not None:
            title = f"{rover}, {row.title}: {plainly(row.stopped)}"
            checks.append(stated(replace(claim, title=title), None, None, "the run reaches its end", "undecided"))
            continue
        if row.ours is None:
            checks.append(at_least(claim, lambda: 1.0, 1.0))
            continue
        rule = at_least if row.ours.at_least else at_most
        checks.append(rule(claim, partial(float, row.ours.value), row.ours.limit or 0.0))
    return checks
