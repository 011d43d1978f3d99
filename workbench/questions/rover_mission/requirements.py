"""The mission's requirements: what runs say of them, and the checks: one for each number with a limit.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

from contracts.records import Check
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.questions.rover.drive import Drive
from workbench.verdict.rules import Claim, at_least, at_most, stated

__all__ = ["MISSION", "MISSION_SOURCE", "TITLES", "MissionRow", "mission_checks", "mission_rows", "plainly", "tightest"]

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
MISSION = tuple(name for name in TITLES if name != "rocks")
"""What is required of the rover on every kind of tire; of the rocks nothing is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionRow:
    """One requirement.

    Attributes
    ----------
    name, title : of the scenario, ``"slope_up"``, and what it is called
    quantity : what is required
    ours : number found on ANCF tires; None where the run stopped or nothing is required
    theirs : the same on brush tires, where ``ours`` is None what decides there; None where there is no such run
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
            limited = [one for one in theirs.values() if one.limit is not None]
            rows.append(
                MissionRow(
                    name=name,
                    title=title,
                    quantity="the run reaches its end",
                    theirs=tightest(limited) if limited else None,
                    stopped=run.stopped,
                )
            )
        rows += [
            MissionRow(name=name, title=title, quantity=one.quantity, ours=one, theirs=theirs.get(one.quantity))
            for one in ours
        ]
    return rows


def tightest(outcomes: Sequence[Outcome]) -> Outcome:
    """Of one scenario the number that decides: the first that is not met, else the one nearest to its limit.

    A number that stands on its limit because it is counted, six wheels of six, is passed over if there is another.
    """
    unmet = [one for one in outcomes if not one.met]
    open_ = [one for one in outcomes if one.margin] or list(outcomes)
    return unmet[0] if unmet else min(open_, key=_room)


def _room(one: Outcome) -> float:
    """Margin over the larger of value and limit [-]."""
    assert one.margin is not None
    assert one.limit is not None
    return one.margin / (max(abs(one.value), abs(one.limit)) or 1.0)


_FOLDS = re.compile(
    r"a tire folds at t = (?P<time>[-+.\de]+) s.*?: plate \d+ \((?P<part>\w+),.*?\) of wheel (?P<wheel>[\w ]+), "
    r"which carries (?P<load>[.\d]+) N"
)

_STANDS = re.compile(r"asked for a mean wheel load of (?P<asked>\d+) N, found (?P<found>up to \d+ N|none)")
"""The sentence of `rover_dynamics.flexible.quasi_static`."""
_STOPS = re.compile(r"(?:stopped|broke down|folds) at (?:t = )?(?P<time>[-+.\de]+) s")
_REASONS = {"plates fold": "plates fold", "a tire folds": "a tire folds"}
"""What a message says -> why, in words; that no step converges, else."""


def plainly(stopped: str) -> str:
    """Why a run stopped, for a reader who does not know the solver; its first clause where that is not known.

    The sentence is that of `workbench.questions.rover.tire_shapes.TireShapes`. Verified by
    tests/unit/test_workbench_rover_mission.py.
    """
    folds, stops, stands = _FOLDS.search(stopped), _STOPS.search(stopped), _STANDS.search(stopped)
    if stands is not None:
        return f"does not stand: {stands['asked']} N a wheel asked for, {stands['found']} found"
    if folds is not None:
        part, wheel, load = folds["part"], folds["wheel"], folds["load"]
        return f"{_when(folds['time'])}: a {part} of the {wheel} wheel folds at {load} N"
    if stops is not None:
        why = next((words for said, words in _REASONS.items() if said in stopped), "no step converges there")
        return f"{_when(stops['time'])}: {why}"
    return f"ended early: {re.split('[;.] ', stopped)[0]}"


def _when(time: str) -> str:
    return f"stops at {float(time):.3g} s" if float(time) >= 0.0 else "stops before it sets out"


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
