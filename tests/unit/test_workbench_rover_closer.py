"""The ANCF tires looked at closely: spectrum, strains, footprint, what the section says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.series import TimeSeries, read_series
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.scenario import ScenarioRun
from tests.unit.test_workbench_tire_animation import TIRE, flexible
from workbench.questions.rover.close_look import PRESSURE, body_series, write_close_look
from workbench.questions.rover.drive import Drive
from workbench.questions.rover_ancf.question import ROVER_ANCF
from workbench.questions.rover_closer.question import ROVER_CLOSER
from workbench.questions.rover_closer.results import CloserLook, Resting
from workbench.report.page import page_environment
from workbench.report.series import series_links
from workbench.study.model_parameters import ancf_preset
from workbench.study.reading import built_in_study, read_study

T = np.arange(0.0, 40.0, 0.02)
STUDY = read_study(built_in_study())
BOUNCE = 1.8
"""Of the vibration below [Hz]."""


def series(ground: str, tire: str, size: float) -> TimeSeries:
    columns = {"body_az_m_s2": size * np.sin(2.0 * np.pi * BOUNCE * T), "body_pitch_rate_rad_s": 0.0 * T}
    if tire == "ancf":
        columns |= {f"{name}_strain_1": 0.2 + 0.05 * np.sin(T) for name in ("front_left", "front_right")}
    return TimeSeries(scenario=f"{ground}_closely", tire=tire, time=T, columns=columns)


def straight() -> Drive:
    loads = TimeSeries(scenario="straight", tire="ancf", time=T, columns={"front_right_load_N": 30.0 + 0.0 * T})
    return Drive(outcomes=(), series=loads, stopped=None, spins=(), wall_s=None)


def resting() -> Resting:
    stiffness = np.full(12, 320.0 * (2.0 * np.pi * BOUNCE) ** 2 / 6.0)
    return Resting(strain=np.linspace(0.17, 0.25, 12), stiffness=stiffness, strain_alike=0.2, mass=320.0)


def look() -> CloserLook:
    found = {
        (g, t): series(g, t, 0.01 if t == "ancf" else 1e-9) for g in ("straight", "rocks") for t in ("brush", "ancf")
    }
    standing = [(0.0, 0.01 * i, 0.02 * j, 1e4, 5e-4) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    rolling = [(15.0, 0.03, 0.0, 4e4, 5e-4), (15.0, -0.02, 0.0, 1e4, 1e-3)]
    return CloserLook(
        series=found,
        pressure=np.array(standing + rolling),
        straight=straight(),
        load=45.0,
        resting=resting(),
        preset=ancf_preset(STUDY),
        of_thesis=True,
        stopped={"rocks": "a tire folds"},
        animation="<p>page</p>",
    )


def statuses(found: CloserLook) -> dict[str, str]:
    checks = ROVER_CLOSER.checks(STUDY, found)
    return {check.id.partition(".")[2]: check.status for check in checks}


def test_a_squeezed_tire_has_its_strain_in_the_series() -> None:
    run = ScenarioRun(scenario=scenario_named("straight"), design=read_rover(), motion=flexible(0.8))
    found = body_series(run, "straight", TIRE)
    np.testing.assert_allclose(found["front_right_strain_1"], 0.5 * (1.0 - 0.8**2), rtol=1e-9)
    assert body_series(run, "straight", None).columns.keys() == {"body_az_m_s2", "body_pitch_rate_rad_s"}


def test_what_is_read_from_the_series() -> None:
    found = look()
    one = found.vibration("straight", "ancf")
    assert one.strongest == pytest.approx(BOUNCE, abs=0.02)
    assert one.amplitude.max() == pytest.approx(0.01, rel=0.05)
    assert one.rms == pytest.approx(0.01 / np.sqrt(2.0), rel=0.01)
    assert one.frequency[-1] == pytest.approx(25.0, rel=0.01)
    assert len(found.vibrations) == 4
    standing, rolling = found.footprints
    assert (standing["load"], standing["points"], standing["length"]) == pytest.approx((45.0, 9.0, 0.02))
    assert (rolling["load"], rolling["pressure"], rolling["length"]) == pytest.approx((30.0, 4e4, 0.05))
    assert found.strain_range == pytest.approx((0.15, 0.25), abs=1e-3)
    assert found.resting.bounce == pytest.approx(BOUNCE)
    assert found.row_frequency == pytest.approx(0.78, abs=0.01)


def test_checks_hold() -> None:
    assert set(statuses(look()).values()) == {"pass"}


@pytest.mark.parametrize(
    ("damaged", "failed"),
    [
        (replace(look(), resting=replace(resting(), stiffness=np.full(12, 8000.0))), "bounce"),
        (replace(look(), resting=replace(resting(), strain_alike=0.205)), "strain_standing"),
        (replace(look(), resting=replace(resting(), strain=np.full(12, 0.3))), "strain_rolling"),
    ],
)
def test_another_patch_tire_or_load_fails_its_check(damaged: CloserLook, failed: str) -> None:
    """Negative control: a point of the patch missing, a tire of another stiffness or strain."""
    assert {name for name, status in statuses(damaged).items() if status != "pass"} == {failed}


def test_a_drive_that_ends_early_leaves_its_checks_open() -> None:
    bare = replace(look(), series={}, pressure=np.zeros((0, 5)))
    assert set(statuses(bare).values()) == {"error"}


def test_a_tire_of_ones_own_that_does_not_carry_the_rover_is_a_finding() -> None:
    """The thesis' must; another one may fold, and the checks that rest on it could not be evaluated."""
    fallen = replace(look(), resting=None, of_thesis=False, stopped={"at rest": "a tire folded"})
    assert {name for name, status in statuses(fallen).items() if status == "error"} == {
        "bounce",
        "strain_standing",
        "strain_rolling",
    }
    roles = {check.role for check in ROVER_CLOSER.checks(STUDY, fallen)}
    assert roles == {"finding"}
    gates = [c.id for c in ROVER_CLOSER.checks(STUDY, replace(look(), of_thesis=False)) if c.role == "gate"]
    assert gates == ["rover_closer.strain_standing"]


def test_the_section_shows_what_there_is() -> None:
    found = look()
    template = page_environment().get_template("rover_closer/evidence.html.j2")
    links = series_links(list(found.series.values()))
    figures = ROVER_CLOSER.figures(STUDY, found)
    text = template.render(results=found, figures=figures, series=links)
    assert "&lt;p&gt;page&lt;/p&gt;" in text
    assert "the drive on ANCF tires" in text
    assert "50 mm long; largest pressure 40.0 kPa" in text
    bare = replace(found, series={}, pressure=np.zeros((0, 5)), stopped={}, animation=None)
    text = template.render(results=bare, figures=ROVER_CLOSER.figures(STUDY, bare), series={})
    assert "iframe" not in text
    fallen = replace(found, resting=None, stopped={"at rest": "a tire folded"})
    text = template.render(results=fallen, figures=figures, series=links)
    assert "at rest: the drive on ANCF tires ended early: a tire folded" in text


def test_the_straight_path_is_driven_once() -> None:
    """The close look takes what the task of the thesis' figures keeps."""
    driven = {task.name: task for task in ROVER_ANCF.tasks(STUDY)}
    beside, drawn = ROVER_CLOSER.tasks(STUDY)
    assert driven["rover_ancf_straight"].inputs["pressed_at"] == [0.0, 15.0]
    assert (beside.needs, drawn.needs) == ((), ("rover_ancf_straight",))
    assert drawn.inputs["motion"] == "rover_ancf_straight"
    none = STUDY.model_copy(update={"rover": STUDY.rover.model_copy(update={"on_ancf_tires": "none"})})
    assert ROVER_CLOSER.applies(STUDY)
    assert not ROVER_CLOSER.applies(none)


def test_a_close_look_is_kept_as_far_as_the_motion_gets(tmp_path: Path) -> None:
    """Pressure is looked for at times within the motion only; nothing touches the ground here."""
    run = ScenarioRun(scenario=scenario_named("straight"), design=read_rover(), motion=flexible(0.8))
    write_close_look(run, "straight", TIRE, [0.0, 1e3], tmp_path)
    assert read_series(tmp_path / "closely.csv", "straight", "ancf").time[0] == 0.0
    assert (tmp_path / "pressure.csv").read_text().splitlines()[-1] == ",".join(PRESSURE)
