"""``workbench climb`` as a user runs it."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run
from workbench.study.reading import built_in_study


def driven(folder: Path, angle: str) -> tuple[dict[tuple[str, float], dict[str, str]], str]:
    """Rows of ``climb.csv`` by direction and angle [deg], and what was printed, of rigid wheels on one soil."""
    study = folder / "mine.toml"
    shutil.copy(built_in_study(), study)
    asked = ("climb", study, "--soil", "ding2011", "--tire", "rigid", "--angle", angle)
    ended = run(*asked, "--out", folder / "out", "--store", folder / "store")
    assert ended.returncode == 0, ended.stderr
    with (folder / "out" / "climb.csv").open(encoding="utf-8") as stream:
        return {(row["direction"], float(row["angle_deg"])): row for row in csv.DictReader(stream)}, ended.stdout


@pytest.mark.slow
def test_slopes_are_driven_kept_and_drawn(tmp_path: Path) -> None:
    rows, told = driven(tmp_path, "10")
    assert len(rows) == 3
    assert 0.05 < float(rows["up", 10.0]["slip"]) < float(rows["up", 10.0]["largest_slip"]) < 0.4
    assert 0.5 < float(rows["up", 10.0]["energy_in_ruts_J_m"]) / float(rows["up", 10.0]["energy_J_m"]) < 0.95
    assert float(rows["down", 10.0]["torque_N_m"]) < 2.0 < 6.0 < float(rows["up", 10.0]["torque_N_m"])
    assert float(rows["across", 10.0]["drift"]) < -0.02
    assert "≥10.0" in told
    assert (tmp_path / "out" / "climb.png").is_file()
    assert (tmp_path / "mine.kept" / "climb.json").is_file()


@pytest.mark.long
def test_the_steepest_slope_is_looked_for_between_two(tmp_path: Path) -> None:
    rows, told = driven(tmp_path, "0:20:20")
    largest = {angle: float(row["largest_slip"]) for (direction, angle), row in rows.items() if direction == "up"}
    assert len(largest) == 5
    steepest = max(angle for angle, slip in largest.items() if slip < 0.6)
    stuck = min(angle for angle, slip in largest.items() if slip >= 0.6)
    assert stuck - steepest == pytest.approx(2.5)
    assert largest[0.0] < 0.1 < 0.6 < largest[20.0]
    assert f"{steepest:.1f} " in told


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--angle", "a"], "angle = 'a': must be A:B:STEP"),
        (["--angle", ""], "angle = '': must be A:B:STEP"),
        (["--angle", "0:60:5"], "must lie in 0 to 40 degrees"),
        (["--angle", "0:nan:5"], "must be A:B:STEP"),
        (["--tire", "ancf"], "tire on soil = 'ancf'"),
        (["--soil", "moon"], "soil = 'moon'"),
        (["--soil", "fjs1", "--soil", "fjs1"], "are two of one name"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path: Path, arguments: list[str], told: str) -> None:
    study = tmp_path / "mine.toml"
    shutil.copy(built_in_study(), study)
    ended = run("climb", study, *arguments, "--out", tmp_path / "out", "--store", tmp_path / "store")
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stderr
    assert told in ended.stderr
