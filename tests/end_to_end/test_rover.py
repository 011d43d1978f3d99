"""``workbench rover`` as a user runs it: two quick scenarios, a rover of one's own, and bad input."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.series import read_series
from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from tests.end_to_end.small_study import run, said


def test_the_drop_writes_its_series_and_names_both_damper_laws(tmp_path: Path) -> None:
    ended = run("rover", "drop", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    for text in ("damper builds up", "197.9 N", "1066 N"):
        assert text in ended.stdout
    printed = run("rover", "drop_printed", "--out", tmp_path)
    assert printed.returncode == 0, printed.stderr
    for text in ("damper as printed", "2202 N"):
        assert text in printed.stdout
    series = read_series(tmp_path / "series" / "drop_brush.csv", "drop", "brush")
    assert series.time[0] == 0.0
    assert series["rear_left_load_N"][0] == 0.0
    assert 1000.0 < series["rear_left_load_N"].max() < 1200.0
    assert "Figs 18, 19" in series.source


def test_a_drive_over_a_terrain_of_ones_own(tmp_path: Path) -> None:
    """A ramp of 5 degrees from a file in a map's coordinates, on rigid tires; what does not carry the path is said."""
    x = np.arange(0.0, 4.01, 0.05)
    heights = np.repeat(np.tan(np.radians(5.0)) * x[:, None], 60, axis=1)
    np.savez(tmp_path / "ramp.npz", heights=heights, spacing=(0.05, 0.05), origin=(5000.0, 300.0))
    drive = ("rover", "straight", "--terrain", tmp_path / "ramp.npz", "--out", tmp_path)
    ended = run(*drive, "--start", "5001", "301.5", "--tire", "rigid")
    assert ended.returncode == 0, ended.stderr
    series = read_series(tmp_path / "series" / "straight_rigid.csv", "straight", "rigid")
    way = np.array([series[f"body_{axis}_m"][-1] - series[f"body_{axis}_m"][0] for axis in "xyz"])
    assert way[2] / way[0] == pytest.approx(np.tan(np.radians(5.0)), rel=1e-3)
    slip = 320.0 * 3.711 * np.sin(np.radians(5.0)) / (6.0 * 8250.0)
    assert np.linalg.norm(way) == pytest.approx((1.0 - slip) * 35.0 * 70.0 / 3600.0, rel=5e-4)
    beside = run(*drive)
    assert (beside.returncode, beside.stderr.count("\n")) == (2, 1)
    assert "must lie 0.1425 m inside the terrain, x 5000..5004 m" in beside.stderr
    heights[3, 3] = np.nan
    np.savez(tmp_path / "ramp.npz", heights=heights, spacing=(0.05, 0.05))
    gap = run(*drive)
    assert (gap.returncode, gap.stderr.count("\n")) == (2, 1)
    assert "NaN" in gap.stderr


def test_rocks_and_gravity_by_name(tmp_path: Path) -> None:
    ended = run("rover", "straight", "--rocks", "1", "--gravity", "earth", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "random rocks, seed 1" in " ".join(ended.stdout.split())
    series = read_series(tmp_path / "series" / "straight_brush.csv", "straight", "brush")
    loads = [series[f"{end}_{side}_load_N"] for end in ("front", "center", "rear") for side in ("left", "right")]
    assert np.sum(loads, axis=0).mean() == pytest.approx(320.0 * 9.81, rel=0.01)
    assert np.ptp(loads) > 100.0


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
    assert ">= 85.5 deg" in row
    assert "met" in row


@pytest.mark.long
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


def test_a_straight_path_is_walked_beside_the_driven_one(tmp_path: Path) -> None:
    ended = run("rover", "straight", "--walk", "--tire", "rigid", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    for text in ("walked instead", "energy of the deployment joints", "driven instead: way ahead"):
        assert text in " ".join(ended.stdout.split())
    series = read_series(tmp_path / "series" / "straight_walk_rigid.csv", "straight_walk", "rigid")
    assert series["body_x_m"][-1] - series["body_x_m"][0] == pytest.approx(0.8, rel=1e-4)
    assert series.time[-1] == 160.0


def test_six_ancf_tires_carry_the_rover(tmp_path: Path) -> None:
    ended = run("rover", "static", "--tire", "ancf", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    series = read_series(tmp_path / "series" / "static_ancf.csv", "static", "ancf")
    loads = [series[f"{end}_{side}_load_N"][-1] for end in ("front", "center", "rear") for side in ("left", "right")]
    assert np.mean(loads) == pytest.approx(197.92, rel=2e-3)
    assert series["front_right_deflection_m"][-1] > 0.025  # free wheels roll off their spokes


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ([], "give one of static, drop"),
        (["fly"], "'fly': is not known"),
        (
            ["drop", "--tire", "rubber"],
            "'rubber': is not known; give rigid, brush, fe,",
        ),
        (["drop", "--rover", "none.toml"], "none.toml: does not exist"),
        (["drop", "--gravity", "moon"], "'moon': is not known; give mars or earth"),
        (["straight", "--terrain", "none.npz"], "none.npz: does not exist"),
        (["straight", "--terrain", "none.npz", "--rocks", "1"], "two grounds"),
        (["straight", "--rocks", "-1"], "rock seed = -1"),
        (["straight", "--start", "1", "1"], "start = (1.0, 1.0) m"),
        (["step", "--rocks", "1"], "has a ground of its own"),
        (["step", "--rocks", "1", "--walk"], "has a ground of its own"),
        (["drop", "--walk"], "is not driven straight ahead; walk one of straight"),
    ],
)
def test_bad_input_is_one_message(tmp_path: Path, arguments: list[str], text: str) -> None:
    ended = said("rover", *arguments, "--out", tmp_path / "o")
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


def test_what_stands_in_the_way_is_told_before_anything_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from workbench.commands import rover

    monkeypatch.setattr(rover, "run_scenario", None)
    (tmp_path / "series").write_text("mine", encoding="utf-8")
    ended = said("rover", "static", "--out", tmp_path)
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
    assert f"{tmp_path / 'series'}: is not a folder" in ended.stderr
    (tmp_path / "series").rename(tmp_path / "motions")
    assert f"{tmp_path / 'motions'}: is not a folder" in said("rover", "static", "--out", tmp_path).stderr
