"""Question: the rover's ANCF tires looked at closely: pressure, strain, vibration beside the brush tire, animation.

Verified by tests/unit/test_workbench_rover_closer.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from contracts.csv_table import TableRule, read_table
from contracts.errors import InputError
from contracts.records import Check, Role
from contracts.series import TimeSeries, read_series
from rover_dynamics.rover.rover_file import read_rover
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.models.driving_brush import driving_inputs
from workbench.questions.question import Question
from workbench.questions.rover.drive import read_drive
from workbench.questions.rover_closer.figures import closer_figures
from workbench.questions.rover_closer.results import GROUNDS, CloserLook, Resting
from workbench.questions.rover_crosscheck.question import ROVER_CROSSCHECK
from workbench.study.model import Study
from workbench.study.model_parameters import on_tire_of_thesis, rover_ancf, rover_on_ancf
from workbench.verdict.rules import Claim, near

__all__ = ["ROVER_CLOSER"]

TASK, ANIMATION, STRAIGHT = "rover_closer", "rover_animation", "rover_ancf_straight"
_RULE = TableRule(what="pressure file", first=("time_s",), units="give SI units")


def _tasks(study: Study) -> Sequence[Task]:
    """Beside the straight path on ANCF tires, whose task is another question's."""
    return [
        Task(
            name=TASK,
            function="workbench.questions.rover_closer.task:drive_closely",
            inputs={"lasts": 20.0, "rocks": 3, **driving_inputs(study), **rover_on_ancf(study)},
            cost=14.0,
        ),
        Task(
            name=ANIMATION,
            function="workbench.questions.rover_closer.task:animate",
            inputs={"motion": STRAIGHT, "frames": 60, "title": "Straight path at 70 m/h on ANCF tires"},
            needs=(STRAIGHT,),
            cost=14.0,
        ),
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> CloserLook:
    folder, straight, design = folders[TASK], folders[STRAIGHT], read_rover()
    files = {(g, t): folder / f"{g}_{t}.csv" for g in GROUNDS for t in ("brush", "ancf")}
    files["straight", "ancf"] = straight / "closely.csv"
    result, page, pressure = read_result(folder), folders[ANIMATION] / "animation.html", straight / "pressure.csv"
    stands = result["stands"]
    return CloserLook(
        series={
            (ground, tire): read_series(path, f"{ground}_closely", tire)
            for (ground, tire), path in files.items()
            if path.exists()
        },
        pressure=read_table(pressure, _RULE).values if pressure.exists() else np.zeros((0, 5)),
        straight=(drive := read_drive(straight, "straight", "ancf")),
        load=design.static_load,
        resting=None
        if stands is None
        else Resting(
            strain=np.array(stands["strain"]),
            stiffness=np.array(stands["stiffness"]),
            strain_alike=stands["strain_alike"],
            mass=design.mass,
        ),
        preset=rover_ancf(study),
        of_thesis=on_tire_of_thesis(study),
        stopped=result["stopped"] | ({"straight": drive.stopped} if drive.stopped else {}),
        animation=page.read_text(encoding="utf-8") if page.exists() else None,
    )


def _claim(name: str, title: str, quantity: str, unit: str, source: str, role: Role) -> Claim:
    title = f"ANCF tires, closely, {title}"
    return Claim(id=f"rover_closer.{name}", title=title, quantity=quantity, unit=unit, role=role, source=source)


def _checks(study: Study, results: CloserLook) -> Sequence[Check]:
    bounce, apart = "bounce of the rover on its tires, sqrt(6 k / m) / (2 pi)", "the rover at rest, solved apart"
    line = _claim("bounce", "strongest vibration of the body", "frequency", "Hz", bounce, "finding")
    driven = results.resting is not None and results.straight.stopped is None
    role: Role = "gate" if results.of_thesis or driven else "finding"  # a tire of one's own may fold
    start = _claim("strain_standing", "strain before it sets out", "largest strain", "-", apart, role)
    ride = _claim("strain_rolling", "strain at 70 m/h", "largest strain", "-", apart, "finding")
    rest = results.resting
    bounces, alike, strained = (rest.bounce, rest.strain_alike, float(rest.strain.max())) if rest else (0.0, 0.0, 0.0)
    beside_rest = partial(partial, _beside_rest, results)
    return [
        near(line, beside_rest(lambda: results.vibration("straight", "ancf").strongest), bounces, 0.05),
        near(start, beside_rest(lambda: results.strain_at_start), alike, 0.01),
        near(ride, beside_rest(lambda: results.strain_range[1]), strained, 0.1),
    ]


def _beside_rest(results: CloserLook, number: Callable[[], float]) -> float:
    """A number that is held against the rover at rest; InputError if it does not stand."""
    if results.resting is None:
        raise InputError("rest", "none", "was found", results.stopped.get("at rest", "look at the tire"))
    return number()


def _series(study: Study, results: CloserLook) -> Sequence[TimeSeries]:
    return list(results.series.values())


def _asked(study: Study) -> bool:
    """Of a study that drives on ANCF tires."""
    return study.rover is not None and study.rover.on_ancf_tires != "none" and ROVER_CROSSCHECK.applies(study)


ROVER_CLOSER = Question(
    name="rover_closer",
    title="ANCF tires, closely",
    group="Rover",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=closer_figures,
    series=_series,
    applies=_asked,
)
