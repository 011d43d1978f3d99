"""``workbench calibrate``, run as a user would run it, on a coarse study."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, said
from workbench.questions.calibration import strip_thicknesses
from workbench.study.reading import read_study


@pytest.mark.long
def test_calibrate_finds_a_thickness_the_solid_model_confirms(workspace: Path, tmp_path: Path) -> None:
    """From strips tuned for about 8 N/mm on the mean to 5 N/mm at one orientation: the solid model meets it to 1 %."""
    arguments = ("calibrate", "study.toml", "--target", "5 N/mm", "--out", tmp_path / "out", "--store", "store")
    ended = run(*arguments, folder=workspace)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert ended.stderr == ""
    found = json.loads((tmp_path / "out" / "calibration.json").read_text(encoding="utf-8"))
    assert found["target_N_per_m"] == 5000.0
    assert abs(found["difference"]) < 0.01
    assert found["corrected"]["solid_tangent_N_per_m"] == pytest.approx(5000.0, rel=0.01)
    assert found["first"]["section_tangent_N_per_m"] == pytest.approx(5000.0, rel=6e-4)
    old, new = read_study(workspace / "study.toml"), read_study(tmp_path / "out" / "study_calibrated.toml")
    assert strip_thicknesses(new) == found["corrected"]["thickness_m"]
    assert new.wheel.tire.thickness < old.wheel.tire.thickness
    assert new.fe == old.fe
    for text in ("solid - target", "5.0000 N/mm", "study_calibrated.toml"):
        assert text in ended.stdout
    again = run(*arguments, folder=workspace)
    assert again.returncode == 0
    assert "computed in" not in again.stdout  # every run is found in the store


@pytest.mark.parametrize(
    ("target", "text"),
    [("8.25", "needs its unit"), ("fast", "begin with a number"), ("-5 N/mm", "greater than zero"), ("3 mm", "not")],
)
def test_bad_targets_are_refused(workspace: Path, tmp_path: Path, target: str, text: str) -> None:
    ended = said("calibrate", "study.toml", "--target", target, "--out", tmp_path / "o", folder=workspace)
    assert ended.returncode == 2
    assert "target" in ended.stderr
    assert text in ended.stderr
    assert "Traceback" not in ended.stderr
    assert not (tmp_path / "o").exists()
