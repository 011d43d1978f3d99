"""The topic of the ANCF wheel in motion: tasks, files, checks, figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from workbench.study_file import built_in_study, read_study
from workbench.tasks_ancf_dynamics import move_wheel
from workbench.topic_ancf_dynamics import ANCF_DYNAMICS, AncfMotions


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
    np.testing.assert_allclose(drop[0], [0.0, 0.0, results.radius + 0.010, 0.0, 0.0], atol=1e-9)
    assert drop[-1, 2] < drop[0, 2] - 0.015
    assert ride[-1, 1] == pytest.approx(0.5 * 0.15, rel=0.1)
    assert drop[:, 0] == pytest.approx(np.linspace(0.0, 0.15, 16))


def test_energy_closes_and_integrators_agree(results: AncfMotions) -> None:
    checks = ANCF_DYNAMICS.checks(read_study(built_in_study()), None, results)  # type: ignore[arg-type]
    assert [check.id for check in checks] == ["ancf.energy_drop", "ancf.energy_ride", "ancf.integrators"]
    assert {check.status for check in checks} == {"pass"}


def test_an_open_account_fails_the_gate(results: AncfMotions) -> None:
    """Negative control."""
    drop = results["drop"]
    broken = replace(drop, numbers={**drop.numbers, "closure": 0.02})
    damaged = replace(results, motions=(broken, *results.motions[1:]))
    checks = ANCF_DYNAMICS.checks(read_study(built_in_study()), None, damaged)  # type: ignore[arg-type]
    assert [check.status for check in checks] == ["fail", "pass", "pass"]


def test_figures_show_load_and_hub(results: AncfMotions) -> None:
    figures = ANCF_DYNAMICS.figures(read_study(built_in_study()), results)
    assert set(figures) == {"drop", "drop_share", "ride"}
    assert "hub above the nominal radius" in figures["ride"]
