"""The mission on fitted ANCF tires: runs, checks, what the section says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.tire.preset import thesis_preset
from contracts.series import TimeSeries
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.execution.result_files import FAILURE, read_result, write_result
from workbench.questions.rover.drive import Drive
from workbench.questions.rover.tires import AncfRide
from workbench.questions.rover_ancf.runs import FITTED_DAMPING, SETTLING_DAMPING, fitted_run
from workbench.questions.rover_ancf.task import drive_on_fitted_tires
from workbench.questions.rover_mission.question import ROVER_MISSION, Mission
from workbench.questions.rover_mission.requirements import plainly, tightest
from workbench.report.page import page_environment
from workbench.report.series import series_links
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())
WHEELS = ("front_left", "front_right", "rear_left", "rear_right")


def drive(name: str, tire: str, stopped: str | None = None) -> Drive:
    time = np.linspace(0.0, 20.0, 21)
    columns = {"body_x_m": 0.018 * time} | {f"{wheel}_load_N": 190.0 + time for wheel in WHEELS}
    slip = Outcome(quantity="slip and drift on 25 degrees", value=0.03, unit="-", limit=0.1, at_least=False)
    series = TimeSeries(scenario=f"{name}_fitted", tire=tire, time=time, columns=columns)
    return Drive(outcomes=() if stopped else (slip,), series=series, stopped=stopped, spins=(), wall_s=1.0)


@pytest.fixture(scope="module")
def mission() -> Mission:
    fitted = {"slope_up": drive("slope_up", "ancf"), "step": drive("step", "ancf", "a tire folds at t = 20.3 s")}
    return Mission(
        fitted=fitted, brush={n: drive(n, "brush") for n in ("slope_up", "step")}, tire="six spokes", friction=None
    )


def test_tasks_need_the_fit_that_is_kept() -> None:
    tasks = ROVER_MISSION.tasks(STUDY)
    assert [task.name for task in tasks] == [
        f"rover_fitted_{n}" for n in ("slope_up", "slope_down", "slope_across", "step", "point_turn")
    ]
    assert STUDY.ancf_fit is not None
    assert {task.needs for task in tasks} == {(f"ancf_fit_{STUDY.ancf_fit.kept.name}",)}
    none = STUDY.model_copy(update={"rover": STUDY.rover.model_copy(update={"on_ancf_tires": "none"})})
    assert ROVER_MISSION.applies(STUDY)
    assert not ROVER_MISSION.applies(none)


def test_a_fitted_run_has_the_fits_contact_and_settles_quietly() -> None:
    scenario = fitted_run("rocks", thesis_preset(), read_rover())
    assert isinstance(scenario.ride, AncfRide)
    assert (scenario.name, scenario.ride.settling_damping) == ("rocks_fitted", None)
    assert (scenario.ride.law.stiffness, scenario.ride.law.damping) == (1000.0, FITTED_DAMPING)
    assert "random rocks" in scenario.title
    down = fitted_run("slope_down", thesis_preset(), read_rover())
    assert isinstance(down.ride, AncfRide)
    assert down.ride.settling_damping == SETTLING_DAMPING["slope_down"]
    assert (scenario.friction, scenario.ride.on_ground(scenario).friction) == (None, 0.6)
    icy = fitted_run("slope_down", thesis_preset(), read_rover(), friction=0.1)
    assert isinstance(icy.ride, AncfRide)
    assert icy.ride.on_ground(icy).friction == 0.1


def test_without_a_fit_there_is_no_motion_and_it_says_why(tmp_path: Path) -> None:
    write_result(tmp_path, {FAILURE: "no curve"})
    drive_on_fitted_tires({"run": "slope_up", "fit": "f"}, {"f": tmp_path}, tmp_path, lambda fraction: None)
    assert read_result(tmp_path)["stopped"] == "there is no tire: no curve"


def test_what_is_met_and_what_is_not(mission: Mission) -> None:
    checks = ROVER_MISSION.checks(STUDY, mission)
    assert [check.status for check in checks] == ["pass", "undecided"]
    assert checks[1].title.endswith("step of 0.25 m: stops at 20.3 s: a tire folds")
    assert [check.id for check in checks] == ["rover_mission.slope_up", "rover_mission.step"]
    assert {check.role for check in checks} == {"finding"}


def test_a_run_of_which_nothing_is_required_is_held_to_its_end(mission: Mission) -> None:
    driven = replace(drive("rocks", "ancf"), outcomes=())
    for stopped, status in ((None, "pass"), ("a tire folds at t = 3 s", "undecided")):
        rocks = replace(mission, fitted={"rocks": replace(driven, stopped=stopped)})
        (check,) = ROVER_MISSION.checks(STUDY, rocks)
        assert (check.quantity, check.status) == ("run", status)


@pytest.mark.parametrize(
    ("stopped", "told"),
    [
        (
            "a tire folds at t = 13 s: plate 6 (spoke, volume ratio -0.0027) of wheel rear right, which carries 266 N, "
            "is inverted; lower the load",
            "stops at 13 s: a spoke of the rear right wheel folds at 266 N",
        ),
        (
            "250 N: a tire folds at t = -4.67374 s, where no step converges: plate 5 (rim, volume ratio 4.3e-07) of "
            "wheel rear left, which carries 396 N, gives way; lower the load",
            "stops before it sets out: a rim of the rear left wheel folds at 396 N",
        ),
        ("motion on flexible tires stopped at t = 3 s of 9 s: no step", "stops at 3 s: no step converges there"),
        ("explicit motion broke down at 0.34 s with a step of 3e-4 s: plates fold (x)", "stops at 0.34 s: plates fold"),
        ("no step converges; try another. No tire is near folding", "ended early: no step converges"),
    ],
)
def test_why_a_run_stopped_is_told_without_the_solvers_words(stopped: str, told: str) -> None:
    assert plainly(stopped) == told


def test_the_section_draws_each_run_and_says_where_it_ends(mission: Mission) -> None:
    environment = page_environment()
    figures, series = ROVER_MISSION.figures(STUDY, mission), series_links(list(ROVER_MISSION.series(STUDY, mission)))
    assert set(figures) == {f"mission_{n}_{what}" for n in ("slope_up", "step") for what in ("load", "place")}
    values = {"results": mission, "figures": figures, "series": series}
    short, text = (
        environment.get_template(f"rover_mission/{n}.html.j2").render(values) for n in ("section", "evidence")
    )
    for words in (
        "stops at 20.3 s: a tire folds",
        "met</td><td>met",
        'href="evidence.html#series/step_fitted_ancf.csv"',
        "undecided",
    ):
        assert words in text, words
    assert "stops at 20.3 s: a tire folds; on brush tires slip and drift on 25 degrees" in short
    assert short.count("<tr>") == 1 + len(mission.decided)
    assert ("t = 20.3" in short, "t = 20.3" in text) == (False, False)


def test_what_decides_is_what_is_not_met_or_nearest_to_its_limit() -> None:
    def one(value: float, limit: float, *, at_least: bool = True) -> Outcome:
        return Outcome(quantity=f"{value:g}", value=value, unit="-", limit=limit, at_least=at_least)

    counted, wide, near = one(6.0, 6.0), one(0.01, 0.1, at_least=False), one(9.0, 10.0, at_least=False)
    assert tightest([counted, wide, near]) is near
    assert tightest([counted, wide, one(3.0, 6.0), near]).value == 3.0
    assert tightest([counted]) is counted
