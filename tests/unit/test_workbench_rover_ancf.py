"""The question of the rover on ANCF tires: runs, what a task leaves, what is read, checks and section."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from contracts.series import TimeSeries
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.execution.result_files import read_result
from workbench.questions.rover.drive import Drive, read_drive
from workbench.questions.rover_ancf.question import LONG, ROVER_ANCF, SHORT, runs_of
from workbench.questions.rover_ancf.results import AncfRover
from workbench.questions.rover_ancf.runs import ancf_run
from workbench.questions.rover_ancf.task import drive_on_ancf_tires
from workbench.report.page import page_environment
from workbench.report.series import series_links
from workbench.study.ancf_tire import tire_values
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

SPIN = 0.1364
TIRE = build_tire(thesis_preset())
FOLDED = "a tire folds at t = 0.3 s"


def _series(name: str, tire: str) -> TimeSeries:
    """Forces and deflections of known period on a smooth course."""
    time = np.linspace(0.0, 2.0, 401) if name.startswith("traction") else np.linspace(0.0, 40.0, 401)
    wave = np.cos(4.0 * SPIN * time)
    columns = {
        "front_right_load_N": 190.0 + 2.0 * time,
        "front_right_deflection_m": 0.026 + (0.002 if tire == "ancf" else 0.0) * wave,
        "front_right_tractive_N": 26.0 + time + 3.0 * np.sin(2.0 * np.pi * 15.0 * time),
        "body_vx_m_s": 0.0187 + 0.0 * time,
    }
    return TimeSeries(scenario=name, tire=tire, time=time, columns=columns)


def _drive(name: str, tire: str) -> Drive:
    outcomes = (
        Outcome(quantity="mean wheel load at the end", value=197.93, unit="N"),
        Outcome(quantity="mean speed between 15 and 35 s", value=0.0187, unit="m/s"),
        *((Outcome(quantity="angle turned", value=86.6, unit="deg", limit=85.5),) if name == "point_turn" else ()),
    )
    if name.startswith("slope") and tire == "ancf":
        return Drive(outcomes=(), series=None, stopped="a tire folds at t = -4.5 s", spins=(), wall_s=3.0)
    stopped = FOLDED if (name, tire) == ("drop", "ancf") else None
    outcomes = () if stopped else outcomes
    return Drive(
        outcomes=outcomes, series=_series(name, tire), stopped=stopped, spins=(SPIN,) * 6, wall_s=3.0, **_account()
    )


def _account() -> dict[str, Any]:
    """Of 2 s: the drives put in 50 W, of which contact damping takes 30 W and motion the rest."""
    time = np.linspace(0.0, 2.0, 41)
    table = np.zeros((41, 9))
    table[:, 0], table[:, 1], table[:, 6], table[:, 8] = time, 20.0 * time, 30.0 * time, 50.0 * time
    return {"account": table, "closures": {"energy": 1e-4, "momentum": 2e-5}}


@pytest.fixture(scope="module")
def results() -> AncfRover:
    """Made up, but for what they stand for."""
    d = np.linspace(0.0, 0.03, 31)
    fe = StiffnessCurve(model="fe", orientation_deg=None, deflection=d, load=7500.0 * d)
    return AncfRover(
        runs={n: _drive(n, "ancf") for n in (*SHORT, "point_turn")},
        brush={n: _drive(n, "brush") for n in (*SHORT, "point_turn")},
        fe=fe,
        preset=thesis_preset(),
        friction=None,
        of_thesis=True,
    )


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def _checks(study: Study, results: AncfRover) -> dict[str, Check]:
    return {check.id: check for check in ROVER_ANCF.checks(study, results)}


def test_a_study_says_what_is_driven(study: Study) -> None:
    assert list(runs_of(study)) == list(SHORT)
    chosen = {
        choice: study.model_copy(update={"rover": study.rover.model_copy(update={"on_ancf_tires": choice})})
        for choice in ("none", "all")
    }
    assert list(runs_of(chosen["all"])) == [*SHORT, *LONG]
    assert not ROVER_ANCF.applies(chosen["none"])
    assert [task.name for task in ROVER_ANCF.tasks(study)] == [f"rover_ancf_{name}" for name in SHORT]


def test_every_run_is_a_scenario_of_its_own_name() -> None:
    design = read_rover()
    for name in (*SHORT, *LONG):
        scenario = ancf_run(name, design, TIRE)
        assert (scenario.name, scenario.tire_model) == (name, "ancf")
    with pytest.raises(InputError, match="'fly': is not known"):
        ancf_run("fly", design, TIRE)


def test_a_fall_leaves_its_series_and_why_it_ended(tmp_path: Path) -> None:
    """The thesis' tires do not catch the rover that falls by 10 mm; what there is of the motion is kept, marked."""
    drive_on_ancf_tires(
        {"run": "drop", "friction": None, **tire_values(TIRE.preset, None)}, {}, tmp_path, lambda fraction: None
    )
    drop = read_drive(tmp_path, "drop", "ancf")
    assert drop.series is not None
    assert drop.series.partial
    assert 0.1 < drop.series.time[-1] < 1.0
    assert drop.outcomes == ()
    assert "a tire folds at t = " in str(drop.stopped)
    assert "failure" not in read_result(tmp_path)  # that of a fall is a finding, not a failed run of the report


def test_period_spin_and_ripple_are_read_from_the_series(results: AncfRover) -> None:
    assert results.spoke_turn == pytest.approx(0.5 * np.pi / SPIN)
    assert results.deflection_period == pytest.approx(results.spoke_turn, rel=2e-3)
    assert results.force_ripple("traction") == pytest.approx(3.0 / np.sqrt(2.0), rel=0.02)
    assert results.strongest_line[0] == pytest.approx(15.0, abs=0.3)


def test_gates_hold_and_a_fold_is_a_finding(study: Study, results: AncfRover) -> None:
    checks = _checks(study, results)
    gates = {name for name, check in checks.items() if check.role == "gate"}
    closed = {f"rover_ancf.{n}_{what}" for n in ("straight", "traction") for what in ("energy", "momentum")}
    assert gates == {"rover_ancf.load", "rover_ancf.period"} | closed
    assert {checks[name].status for name in gates} == {"pass"}
    assert {name: checks[f"rover_ancf.{name}"].status for name in ("drop", "ripple", "ripple_fine_grid")} == {
        "drop": "pass",
        "ripple": "pass",
        "ripple_fine_grid": "pass",
    }
    titles = {check.title: check.status for check in checks.values()}
    (stopped,) = (title for title in titles if title.startswith("Rover on ANCF tires, slope of 25 degrees, upwards"))
    assert titles[stopped] == "undecided"
    assert titles["Rover on ANCF tires, quarter turn on the spot: angle turned"] == "pass"


def test_another_period_or_load_fails_the_gates(study: Study, results: AncfRover) -> None:
    """Negative control: spins of three spokes instead of four, a load of the wrong mass."""
    three = replace(results["straight"], spins=(0.75 * SPIN,) * 6)
    lossy = replace(results["traction"], closures={"energy": 0.002, "momentum": 0.0})
    light = replace(results["static"], outcomes=(replace(results["static"].outcomes[0], value=190.0),))
    damaged = replace(results, runs={**results.runs, "straight": three, "static": light, "traction": lossy})
    checks = _checks(study, damaged)
    names = ("load", "period", "traction_energy")
    assert [checks[f"rover_ancf.{name}"].status for name in names] == ["fail", "fail", "fail"]


def test_what_must_hold_on_the_thesis_tires_is_a_finding_on_ones_that_fold(study: Study, results: AncfRover) -> None:
    """Another tire may fold or hardly pulse; as long as it drives, load, energy and momentum must be right."""
    own = replace(results, of_thesis=False)
    gates = {name for name, check in _checks(study, own).items() if check.role == "gate"}
    closed = {f"rover_ancf.{n}_{what}" for n in ("straight", "traction") for what in ("energy", "momentum")}
    assert gates == {"rover_ancf.load"} | closed
    folded = replace(results["straight"], stopped=FOLDED)
    own = replace(own, runs={**own.runs, "straight": folded, "static": folded})
    gates = {name for name, check in _checks(study, own).items() if check.role == "gate"}
    assert gates == {"rover_ancf.traction_energy", "rover_ancf.traction_momentum"}


def test_three_spokes_follow_on_each_other_after_a_third_of_a_turn(results: AncfRover) -> None:
    three = replace(results, preset=replace(results.preset, spokes=3, circumferential_plates=6))
    assert three.spoke_turn == pytest.approx(2.0 / 3.0 * np.pi / SPIN)


def test_the_section_shows_both_tires_and_what_stopped(study: Study, results: AncfRover) -> None:
    environment = page_environment()
    series, figures = series_links(ROVER_ANCF.series(study, results)), ROVER_ANCF.figures(study, results)
    values = {"results": results, "series": series, "figures": figures}
    short, text = (environment.get_template(f"rover_ancf/{n}.html.j2").render(values) for n in ("section", "evidence"))
    assert "the sweep stops" not in short
    assert results.power == pytest.approx(
        {"drives": 50.0, "contact_damping": 30.0, "kinetic": 20.0, "speed": 0.0187}
        | dict.fromkeys(("strain", "contact", "weight", "damping", "friction"), 0.0)
    )
    for words in (
        "takes 30 W, 60 %",
        "1.0·10⁻⁴",
        "stops at 0.3 s: a tire folds",
        "stops before it sets out: a tire folds",
        "report --full",
        "11.5",
        "not met",
        "met</td>",
    ):
        assert words in text, words
    assert 'href="evidence.html#series/straight_ancf.csv"' in text
    assert "det F" not in text
    assert "slope_up_ancf.csv" not in text
