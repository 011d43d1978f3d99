"""``workbench rover`` as a user runs it: two quick scenarios, a rover of one's own, and bad input."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.series import read_series
from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from tests.end_to_end.small_study import run


def test_the_drop_writes_its_series_and_names_both_damper_laws(tmp_path: Path) -> None:
    ended = run("rover", "drop", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    for text in ("damper as printed", "damper builds up", "197.9 N", "2218 N"):
        assert text in ended.stdout
    series = read_series(tmp_path / "series" / "drop_brush.csv", "drop", "brush")
    assert series.time[0] == 0.0
    assert series["rear_left_load_N"][0] == 0.0
    assert 1000.0 < series["rear_left_load_N"].max() < 1200.0
    assert "Figs 18, 19" in series.source


def test_traction_of_a_rover_of_ones_own_beside_an_earlier_series(tmp_path: Path) -> None:
    """On Earth; the mass and so the acceleration by torque change little, the loads by the gravity."""
    text = EXOMARS_ROVER.read_text(encoding="utf-8")
    (tmp_path / "earth.toml").write_text(text.replace("gravity = 3.711", "gravity = 9.81"), encoding="utf-8")
    (tmp_path / "series").mkdir()
    (tmp_path / "series" / "drop_brush.csv").write_text("time_s,a\n0,0\n1,1\n", encoding="utf-8")
    ended = run("rover", "traction", "--rover", tmp_path / "earth.toml", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "front right" in ended.stdout
    series = read_series(tmp_path / "series" / "traction_brush.csv", "traction", "brush")
    mean = sum(series[f"{end}_{side}_load_N"][-1] for end in ("front", "center", "rear") for side in ("left", "right"))
    assert mean == pytest.approx(320.0 * 9.81, rel=1e-3)
    assert (tmp_path / "series" / "drop_brush.csv").is_file()


def test_a_requirement_is_shown_with_its_margin(tmp_path: Path) -> None:
    ended = run("rover", "point_turn", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    row = next(line for line in ended.stdout.splitlines() if "angle turned" in line)
    assert "90 deg" in row
    assert ">= 76.5 deg" in row
    assert "met" in row


def test_a_motion_can_be_played(tmp_path: Path) -> None:
    ended = run("rover", "static", "--animate", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    page = (tmp_path / "static.html").read_text(encoding="utf-8")
    assert "static equilibrium" in page
    assert page.count("UklGR") > 3  # frames as WebP in base64


def test_the_list_names_every_scenario() -> None:
    ended = run("rover", "--list")
    assert ended.returncode == 0, ended.stderr
    for name in ("static", "drop", "load_sweep", "straight", "traction", "slope_up", "step", "point_turn", "stability"):
        assert name in ended.stdout


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ([], "give one of static, drop"),
        (["fly"], "'fly': is not known"),
        (["drop", "--tire", "ancf"], "does not carry the rover"),
        (["drop", "--tire", "rubber"], "'rubber': is not known"),
        (["drop", "--rover", "none.toml"], "none.toml: cannot be read"),
    ],
)
def test_bad_input_is_one_message(tmp_path: Path, arguments: list[str], text: str) -> None:
    ended = run("rover", *arguments, "--out", tmp_path / "o")
    assert ended.returncode == 2
    assert text in ended.stderr
    assert ended.stderr.count("\n") == 1
    assert not (tmp_path / "o").exists()


def test_a_bad_number_in_the_rover_file_is_named(tmp_path: Path) -> None:
    text = EXOMARS_ROVER.read_text(encoding="utf-8")
    (tmp_path / "bad.toml").write_text(text.replace("mass = 246.39796", 'mass = "heavy"'), encoding="utf-8")
    ended = run("rover", "static", "--rover", tmp_path / "bad.toml", "--out", tmp_path / "o")
    assert ended.returncode == 2
    assert "mass" in ended.stderr
    assert "Traceback" not in ended.stderr
