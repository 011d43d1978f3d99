"""``workbench rover --tire fe``: the rover stands and drives on the wheel that was meshed and solved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from contracts.series import read_series
from tests.end_to_end.small_study import run, small_study_text

LOAD = 197.92
"""A sixth of 320 kg on Mars [N]."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study with four orientations around its wheel, and the rover's drive on it."""
    folder = tmp_path_factory.mktemp("rover_fe")
    before, fe, behind = small_study_text().partition("[fe]")
    shallow = 'max_deflection = "6 mm"\npoints = 2 '
    assert shallow in behind
    text = before + fe + behind.replace(shallow, 'max_deflection = "36 mm"\npoints = 6 ', 1)
    text = text.replace("inner_contact = true", "inner_contact = false")
    step = 'orientation_step = "5 deg"'
    assert text.count(step) == 1
    text = text.replace(step, 'orientation_step = "30 deg"')
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.mark.long
def test_at_rest_every_wheel_is_on_its_curve_and_on_the_way_the_rover_is_carried(folder: Path) -> None:
    """The brake holds position 0 down: load and deflection are a point of that curve."""
    where = ("--out", "o", "--store", "s")
    ended = run("rover", "straight", "--study", "study.toml", "--tire", "fe", *where, folder=folder)
    assert ended.returncode == 0, ended.stderr
    series = read_series(folder / "o" / "series" / "straight_fe.csv", "straight", "fe")
    again = run("stiffness", "study.toml", "--orientation", "0", *where, folder=folder)
    assert (again.returncode, "0 tasks computed" in again.stdout) == (0, True), again.stderr
    curve = read_curve(folder / "o" / "curves" / "fe_phi000.csv", "fe", 0.0)
    for wheel in ("front_left", "center_right", "rear_left"):
        deflection, load = series[f"{wheel}_deflection_m"][0], series[f"{wheel}_load_N"][0]
        assert load == pytest.approx(curve.load_at(deflection), rel=0.01)
    loads = np.array([series[f"{wheel}_load_N"] for wheel in ("front_left", "center_left", "rear_left")])
    assert loads.sum(axis=0).mean() == pytest.approx(3.0 * LOAD, rel=2e-3)
