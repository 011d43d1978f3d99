"""Question: the mission's requirements on fitted ANCF tires, beside the brush tires.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from contracts.records import Check
from contracts.series import TimeSeries
from workbench.execution.task import Task
from workbench.questions.ancf_fit.graph import fit_name
from workbench.questions.question import Question
from workbench.questions.rover.drive import read_drive
from workbench.questions.rover_crosscheck.question import ROVER_CROSSCHECK
from workbench.questions.rover_mission.figures import mission_figures
from workbench.questions.rover_mission.requirements import mission_checks
from workbench.questions.rover_mission.results import Mission
from workbench.study.model import Study, stated
from workbench.study.sections import runs_on_ancf_tires

__all__ = ["ROVER_MISSION"]

SHORT = {"slope_up": 9.0, "slope_down": 12.0, "slope_across": 9.0, "step": 14.0, "point_turn": 20.0}
LONG = {"crevasse": 120.0, "rocks": 110.0}
"""Run -> processor time it takes about [s]."""


def _runs(study: Study) -> Sequence[str]:
    return runs_on_ancf_tires(study.rover, SHORT, LONG)


def _kept(study: Study) -> str:
    return stated(study.ancf_fit, "ancf_fit").kept.name


def _tasks(study: Study) -> Sequence[Task]:
    fit = fit_name(_kept(study))
    return [
        Task(
            name=f"rover_fitted_{name}",
            function="workbench.questions.rover_ancf.task:drive_on_fitted_tires",
            inputs={"run": name, "fit": fit, "friction": study.ground.friction},
            needs=(fit,),
            cost=(SHORT | LONG)[name],
            resumable=True,
        )
        for name in _runs(study)
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> Mission:
    return Mission(
        fitted={n: read_drive(folders[f"rover_fitted_{n}"], f"{n}_fitted", "ancf") for n in _runs(study)},
        brush={n: read_drive(folders[t], n, "brush") for n in _runs(study) if (t := f"rover_{n}") in folders},
        tire=_kept(study).replace("_", " "),
        friction=study.ground.friction,
    )


def _checks(study: Study, results: Mission) -> Sequence[Check]:
    """Findings: what the mission asks for, met or not."""
    return mission_checks(results.rows, "rover_mission.", "Rover on fitted ANCF tires")


def _series(study: Study, results: Mission) -> Sequence[TimeSeries]:
    return [drive.series for drive in results.fitted.values() if drive.series is not None]


ROVER_MISSION = Question(
    name="rover_mission",
    title="Mission on ANCF tires",
    group="Rover",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=mission_figures,
    series=_series,
    applies=lambda study: bool(_runs(study)) and ROVER_CROSSCHECK.applies(study),
    budget=620,
)
