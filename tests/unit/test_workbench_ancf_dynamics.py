"""The question of the ANCF wheel in motion: tasks, files, checks, figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.series import read_series
from workbench.questions.ancf_dynamics.question import ANCF_DYNAMICS, AncfMotions
from workbench.questions.ancf_dynamics.task import move_wheel
from workbench.report.series import series_files
from workbench.study.reading import built_in_study, read_study


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> AncfMotions:
    """Computed as the report does, but for a shorter time."""
    study, folders = read_study(built_in_study()), dict[str, Path]()
    for task in ANCF_DYNAMICS.tasks(study):
        folders[task.name] = tmp_path_factory.mktemp(task.name)
        inputs = task.inputs | {"end": 0.15, "points": 15}
        assert move_wheel(inputs, {}, folders[task.name], lambda fraction: None) == 108
    found = ANCF_DYNAMICS.read(study, folders)
    assert isinstance(found, AncfMotions)
    return found


def test_series_begin_as_asked(results: AncfMotions) -> None:
    drop, ride = results["drop"].series, results["ride"].series
    first = {name: float(values[0]) for name, values in drop.columns.items()}
    assert first == pytest.approx(
        {"hub_x_m": 0.0, "hub_z_m": results.radius + 0.010, "load_x_N": 0.0, "load_z_N": 0.0}, abs=1e-9
    )
    assert drop["hub_z_m"][-1] < drop["hub_z_m"][0] - 0.015
    assert ride["hub_x_m"][-1] == pytest.approx(0.5 * 0.15, rel=0.1)
    assert drop.time == pytest.approx(np.linspace(0.0, 0.15, 16))


def test_series_are_published_by_scenario_and_tire(results: AncfMotions) -> None:
    published = series_files(ANCF_DYNAMICS.series(read_study(built_in_study()), results))
    assert list(published) == ["wheel_drop_ancf.csv", "wheel_drop_share_ancf.csv", "wheel_half_round_ancf.csv"]
    assert "25 kg on its hub" in published["wheel_drop_ancf.csv"].source
    assert "48.9 kg on its hub" in published["wheel_drop_share_ancf.csv"].source
    assert not published["wheel_drop_ancf.csv"].partial


def test_a_motion_that_stops_is_marked_partial(tmp_path: Path) -> None:
    """A hub far too heavy for the tire folds it: what was reached is kept and marked."""
    task = next(t for t in ANCF_DYNAMICS.tasks(read_study(built_in_study())) if t.name == "ancf_drop_share")
    move_wheel(task.inputs | {"hub_mass": 300.0, "end": 0.4, "points": 40}, {}, tmp_path, lambda fraction: None)
    series = read_series(tmp_path / "series.csv", "drop_share", "ancf")
    assert series.partial
    assert 5 < len(series.time) < 41


def test_energy_closes_and_integrators_agree(results: AncfMotions) -> None:
    checks = ANCF_DYNAMICS.checks(read_study(built_in_study()), results)
    assert [check.id for check in checks] == ["ancf.energy_drop", "ancf.energy_ride", "ancf.integrators"]
    assert {check.status for check in checks} == {"pass"}


def test_an_open_account_fails_the_gate(results: AncfMotions) -> None:
    """Negative control."""
    drop = results["drop"]
    broken = replace(drop, numbers=replace(drop.numbers, closure=0.02))
    damaged = replace(results, motions=(broken, *results.motions[1:]))
    checks = ANCF_DYNAMICS.checks(read_study(built_in_study()), damaged)
    assert [check.status for check in checks] == ["fail", "pass", "pass"]


def test_a_motion_that_stopped_has_no_account_and_decides_nothing(results: AncfMotions) -> None:
    drop = results["drop"]
    stopped = replace(drop, numbers=replace(drop.numbers, closure=None, stopped="no convergence"))
    checks = ANCF_DYNAMICS.checks(
        read_study(built_in_study()), replace(results, motions=(stopped, *results.motions[1:]))
    )
    assert [(check.status, check.value is None) for check in checks[:2]] == [("error", True), ("pass", False)]


def test_figures_show_load_and_hub(results: AncfMotions) -> None:
    figures = ANCF_DYNAMICS.figures(read_study(built_in_study()), results)
    assert set(figures) == {"drop", "drop_share", "ride"}
    assert "hub above the nominal radius" in figures["ride"]
