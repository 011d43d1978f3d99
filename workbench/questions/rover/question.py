"""Question: the rover on brush tires. The thesis' scenarios and the mission's requirements, with their figures.

Verified by tests/unit/test_workbench_rover.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from contracts.records import Check, Role
from contracts.series import TimeSeries
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters
from workbench.execution.task import Task
from workbench.questions.kept import kept
from workbench.questions.models.driving_brush import driving_brush, driving_inputs
from workbench.questions.question import Question
from workbench.questions.rover.drive import Drive, read_drive
from workbench.questions.rover.peer import RECORD, RoverPeer, peer_checks, rover_peer, rows_of
from workbench.questions.rover_mission.requirements import MISSION_SOURCE, TITLES, MissionRow, mission_checks, tightest
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_least, at_most, near

__all__ = ["ROVER", "RoverResults"]

THESIS = {
    "static": ("static equilibrium", "Fig. 15"),
    "drop": ("drop of 10 mm", "Figs 18, 19"),
    "drop_printed": ("drop of 10 mm, damper as printed", "Figs 18, 19"),
    "load_sweep": ("wheel load from 160 to 250 N", "Fig. 20"),
    "straight": ("straight path at 70 m/h", "Figs 23, 24"),
    "traction": ("3.5 N m on each drive", "Fig. 25"),
}
MISSION = {
    **{name: title for name, title in TITLES.items() if name != "rocks"},
    "stability": "static stability, 40 degrees",
}
"""Scenario -> what it is called; names as in `rover_dynamics.rover.scenarios.catalogue`."""

THESIS_TORQUE = 3.5
"""Moment on each drive in the thesis' section 3.5 [N m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RoverResults:
    """All scenarios by name, the brush tire they were driven on with its carcass or None, see `DrivingBrush`, friction
    of the ground or None, a still, the rover in another code or None."""

    by_name: Mapping[str, Drive]
    tire: BrushTireParameters
    carcass: tuple[float, float] | None
    friction: float | None
    picture: Path
    peer: RoverPeer | None = None

    @property
    def on_table_two(self) -> bool:
        """Whether the tire's numbers are those of Table II."""
        return self.carcass is None and replace(self.tire, source=THESIS_BRUSH.source) == THESIS_BRUSH

    @property
    def first_touch(self) -> float:
        """Force of the damper as printed as the wheel meets the ground, c sqrt(2 g h) [N]."""
        from rover_dynamics.rover.scenarios.level_ground import DROP_HEIGHT

        return float(self.tire.radial_damping * math.sqrt(2.0 * read_rover().gravity * DROP_HEIGHT))

    def __getitem__(self, name: str) -> Drive:
        return self.by_name[name]

    @property
    def requirements(self) -> list[tuple[str, Outcome]]:
        """The mission's: title of the scenario, outcome with its limit."""
        return [(title, o) for name, title in MISSION.items() for o in self[name].outcomes if o.limit is not None]

    @property
    def tightest(self) -> list[tuple[str, Sequence[Outcome], Outcome]]:
        """Of each scenario of the mission that came to its end: title, what has limits, the one that decides."""
        found = {title: [o for o in self[name].outcomes if o.limit is not None] for name, title in MISSION.items()}
        return [(title, limited, tightest(limited)) for title, limited in found.items() if limited]

    @property
    def stated(self) -> list[tuple[str, Outcome]]:
        """Torques and slips the mission's scenarios took, and what hangs on the tractive force's lever."""
        words = ("largest torque", "largest longitudinal slip", "wheel load at the end")
        return [
            (title, o) for name, title in MISSION.items() for o in self[name].outcomes if o.quantity.startswith(words)
        ]


def _tasks(study: Study) -> Sequence[Task]:
    still = Task(name="rover_still", function="workbench.questions.rover.still:draw", inputs={}, cost=5.0)
    tires = driving_inputs(study)
    scenarios = [
        Task(
            name=f"rover_{name}",
            function="workbench.questions.rover.task:drive_rover",
            inputs={"scenario": name, **tires},
            cost=2.0,
        )
        for name in (*THESIS, *MISSION)
    ]
    return [still, *scenarios]


def _read(study: Study, folders: Mapping[str, Path]) -> RoverResults:
    found = {name: read_drive(folders[f"rover_{name}"], name, "brush") for name in (*THESIS, *MISSION)}
    picture = folders["rover_still"] / "rover.png"
    tire, carcass = driving_brush(study)
    return RoverResults(
        by_name=found,
        tire=tire,
        carcass=carcass,
        friction=study.ground.friction,
        picture=picture,
        peer=rover_peer(study),
    )


def _claim(name: str, title: str, outcome: str, unit: str, source: str, *, gate: bool = False) -> Claim:
    role: Role = "gate" if gate else "finding"
    return Claim(id=f"rover.{name}", title=f"Rover, {title}", quantity=outcome, unit=unit, role=role, source=source)


_ONE_WHEEL = "one wheel integrated apart"
CLOSED_FORMS = (
    ("load", "static", "mean wheel load at the end", "static equilibrium", "320 kg on Mars, six wheels", 1e-3),
    ("drop", "drop", "largest wheel load", "drop of 10 mm, damper that builds up", _ONE_WHEEL, 1e-3),
    ("drop_printed", "drop_printed", "largest wheel load", "drop, damper as printed", _ONE_WHEEL, 0.01),
    ("traction", "traction", "mean tractive force", "3.5 N m on each drive", "balance of wheels and rover", 5e-4),
    (
        "traction_wheel",
        "traction",
        "tractive force of",
        "3.5 N m, front right wheel",
        "(T - f N r - I alpha) / R",
        1e-4,
    ),
)
"""Name, scenario, outcome, title, source of the reference beside the outcome, and tolerance. All in N."""
ANY_TIRE = ("load", "drop")
"""Closed forms that are gates on every brush tire. The others hold to their tolerances on that of Table II: a damper
as printed that is four times as strong jumps by 2 % within a step, an undamped rover rocks by 0.1 % to the end."""


def _checks(study: Study, results: RoverResults) -> Sequence[Check]:
    checks = []
    for name, scenario, quantity, title, source, tolerance in CLOSED_FORMS:
        gate = results.on_table_two or name in ANY_TIRE
        claim, result = _claim(name, title, quantity, "N", source, gate=gate), results[scenario]
        checks.append(near(claim, partial(result.value, quantity), result.reference(quantity), tolerance))
    for model, largest, gate in (("rigid", 0.06, True), ("brush", 2.0, False)):
        title = f"wheel loads against the centre of mass, {model} tires"
        source = "statics on rigid wheels, printed to 0.1 N"
        table = _claim(f"table_{model}", title, "largest difference", "N", source, gate=gate)
        checks.append(at_most(table, partial(_largest_miss, results["static"], model), largest))
    speed = "mean speed between 15 and 35 s"
    path = _claim("speed", "straight path: speed between 15 and 35 s", "speed", "m/s", "Samarini 2020, section 3.4")
    checks.append(near(path, lambda: results["straight"].value(speed), 70.0 / 3600.0, 0.01))
    checks += [_torque_check(name, results[name]) for name in ("slope_up", "step")]
    checks += [check for name in MISSION for check in _requirements(name, results[name])]
    return [*checks, *peer_checks(results.peer)]


def _torque_check(name: str, result: Drive) -> Check:
    """Largest torque of a drive against the only one that is published; no part of what the mission requires."""
    quantity, source = "largest torque of a drive", "Samarini 2020, section 3.5: the moment on each drive"
    claim = _claim(f"torque_{name}", f"{MISSION[name]}: {quantity}", quantity, "N m", source)
    return at_most(claim, partial(result.value, quantity), THESIS_TORQUE)


def _largest_miss(static: Drive, model: str) -> float:
    """Of the loads on one kind of tires from those of statics [N]; raises InputError if there are none."""
    static.outcome(f"{model} tires")
    rows = [one for one in static.outcomes if one.quantity.startswith(f"{model} tires")]
    return max(abs(one.value - one.reference) for one in rows if one.reference is not None)


def _requirements(name: str, result: Drive) -> list[Check]:
    """One check for each number the scenario has a limit for; without any, one that could not be evaluated."""
    limited = [outcome for outcome in result.outcomes if outcome.limit is not None]
    if not limited:
        claim = _claim(f"mission_{name}", MISSION[name], "requirement", "-", MISSION_SOURCE)
        return [at_least(claim, lambda: result.value("requirement"), 0.0)]
    rows = [MissionRow(name=name, title=MISSION[name], quantity=one.quantity, ours=one) for one in limited]
    return mission_checks(rows, "rover.mission_", "Rover")


def _figures(study: Study, results: RoverResults) -> Mapping[str, str]:
    from workbench.charts.packing import picture_link
    from workbench.questions.rover.figures import rover_figures
    from workbench.questions.rover.scene import rover_scene

    scene = rover_scene(read_rover(), picture_link(results.picture))
    return {"rover_scene": scene, **rover_figures({one.scenario: one for one in _series(study, results)})}


def _series(study: Study, results: RoverResults) -> Sequence[TimeSeries]:
    return [result.series for result in results.by_name.values() if result.series is not None]


def _asked(study: Study) -> bool:
    """Its kept record is read here, before anything is computed."""
    if study.rover is None:
        return False
    kept(study, RECORD, rows_of)
    return True


ROVER = Question(
    name="rover",
    title="Rover",
    group="Rover",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=_figures,
    series=_series,
    applies=_asked,
    budget=1260,
)
