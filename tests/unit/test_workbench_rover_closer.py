"""The ANCF tires looked at closely: spectrum, strains, footprint, what the section says."""

from __future__ import annotations

from pathlib import Path

import jinja2
import numpy as np
import pytest

import workbench.report.page
from contracts.series import TimeSeries
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.scenario import ScenarioRun
from tests.unit.test_workbench_tire_animation import TIRE, flexible
from workbench.report.series import series_links
from workbench.study.reading import built_in_study, read_study
from workbench.tasks.rover_closer import body_series
from workbench.topics.rover_closer import ROVER_CLOSER, CloserLook, spectrum

T = np.arange(0.0, 20.0, 0.05)
STUDY = read_study(built_in_study())


def series(ground: str, tire: str, size: float) -> TimeSeries:
    columns = {"body_az_m_s2": size * np.sin(4.0 * np.pi * T), "body_pitch_rate_rad_s": 0.0 * T}
    if tire == "ancf":
        columns |= {f"{name}_strain_1": 0.2 + 0.05 * np.sin(T) for name in ("front_left", "front_right")}
    return TimeSeries(scenario=f"{ground}_closely", tire=tire, time=T, columns=columns)


def look() -> CloserLook:
    found = {
        (g, t): series(g, t, 0.01 if t == "ancf" else 1e-9) for g in ("straight", "rocks") for t in ("brush", "ancf")
    }
    standing = [(0.0, 0.01 * i, 0.02 * j, 1e4, 5.0) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    rolling = [(15.0, 0.03, 0.0, 3e4, 20.0), (15.0, -0.02, 0.0, 1e4, 10.0)]
    return CloserLook(
        series=found, pressure=np.array(standing + rolling), stopped={"rocks": "a tire folds"}, animation="<p>page</p>"
    )


def test_a_sine_has_its_own_amplitude() -> None:
    found = spectrum(T, 3.0 + 0.7 * np.sin(2.0 * np.pi * 2.0 * T))
    assert found.strongest == pytest.approx(2.0)
    assert found.amplitude.max() == pytest.approx(0.7, rel=1e-3)
    assert found.rms == pytest.approx(0.7 / np.sqrt(2.0), rel=1e-3)
    assert found.frequency[-1] == pytest.approx(10.0)


def test_a_squeezed_tire_has_its_strain_in_the_series() -> None:
    run = ScenarioRun(scenario=scenario_named("straight"), design=read_rover(), motion=flexible(0.8))
    found = body_series(run, "straight", TIRE)
    np.testing.assert_allclose(found["front_right_strain_1"], 0.5 * (1.0 - 0.8**2), rtol=1e-9)
    assert body_series(run, "straight", None).columns.keys() == {"body_az_m_s2", "body_pitch_rate_rad_s"}


def test_what_is_read_from_the_series() -> None:
    found = look()
    assert found.vibration("straight", "ancf").rms == pytest.approx(0.01 / np.sqrt(2.0), rel=0.01)
    assert len(found.vibrations) == 4
    standing, rolling = found.footprints
    assert (standing["load"], standing["points"], standing["length"]) == pytest.approx((45.0, 9.0, 0.02))
    assert (rolling["load"], rolling["pressure"], rolling["length"]) == pytest.approx((30.0, 3e4, 0.05))
    assert found.strain_range == pytest.approx((0.15, 0.25), abs=1e-3)
    assert found.row_frequency == pytest.approx(0.78, abs=0.01)


def test_the_section_shows_what_there_is() -> None:
    found = look()
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(workbench.report.page.__file__).parent / "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
    )
    template = environment.get_template("section_rover_closer.html.j2")
    links = series_links(list(found.series.values()))
    figures = ROVER_CLOSER.figures(STUDY, found)
    text = template.render(topic=found, figures=figures, series=links)
    assert "&lt;p&gt;page&lt;/p&gt;" in text
    assert "ended early: a tire folds" in text
    assert "50 mm long; largest pressure 30.0 kPa" in text
    bare = CloserLook(series={}, pressure=np.zeros((0, 5)), stopped={}, animation=None)
    text = template.render(topic=bare, figures=ROVER_CLOSER.figures(STUDY, bare), series={})
    assert "iframe" not in text


def test_one_task_where_the_rover_stands_on_the_wheel() -> None:
    (task,) = ROVER_CLOSER.tasks(STUDY)
    assert task.function == "workbench.tasks.rover_closer:drive_closely"
    short = STUDY.fe.model_copy(update={"max_deflection": 0.006})
    assert ROVER_CLOSER.applies(STUDY)
    assert not ROVER_CLOSER.applies(STUDY.model_copy(update={"fe": short}))
