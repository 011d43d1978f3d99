"""``workbench rover --soil``: a drive on soil as a user runs it, its files, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.series import read_series
from contracts.terrain_cover import check_covered
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from tests.end_to_end.small_study import run
from workbench.study.terrain_file import read_height_field

OWN = """
exponent = 1.0
cohesive_modulus = 1400
frictional_modulus = 820000
cohesion = "0.2 kPa"
friction_angle = "38 deg"
density = "1500 kg/m^3"
shear_modulus = "18 mm"
"""


@pytest.mark.slow
def test_a_drive_on_a_soil_of_ones_own(tmp_path: Path) -> None:
    soil, out = tmp_path / "my soil.toml", tmp_path / "out"
    soil.write_text(OWN, encoding="utf-8")
    ended = run("rover", "straight", "--tire", "brush", "--soil", soil, "--cell", "20 mm", "--out", out)
    assert ended.returncode == 0, ended.stderr
    assert "deepest" in ended.stdout
    assert "ruts:" in ended.stdout
    series = read_series(out / "series" / "straight_brush.csv", "straight", "brush")
    assert 0.01 < series["rear_left_sinkage_m"][-1] < 0.06
    assert np.abs(series["front_left_slip"]).max() < 1.0
    field = read_height_field(out / "ruts" / "straight_brush.npz")
    assert -0.06 < field.heights.min() < -0.01
    assert field.spacing == pytest.approx((0.02, 0.02))
    design, path = read_rover(), SCENARIOS["straight"].path
    assert path is not None
    check_covered(field, path(design), design.wheel_radius)  # the same drive can be driven in its ruts
    assert (out / "ruts" / "straight_brush.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.slow
def test_soil_lies_as_a_height_field_does(tmp_path: Path) -> None:
    x = np.arange(-2.5, 3.01, 0.1)
    heights = 0.05 * np.sin(1.5 * x)[:, None] + 0.04 * x + 1.0
    np.savez(tmp_path / "dunes.npz", heights=heights, spacing=[0.1, 0.1], origin=[-2.5, -2.5])
    drive = ("straight", "--soil", "ding2011", "--tire", "rigid", "--cell", "20 mm")
    ended = run("rover", *drive, "--terrain", tmp_path / "dunes.npz", "--out", tmp_path / "out")
    assert ended.returncode == 0, ended.stderr
    series = read_series(tmp_path / "out" / "series" / "straight_rigid.csv", "straight", "rigid")
    for leg in ("front_left", "front_right", "center_left", "center_right", "rear_left", "rear_right"):
        assert 0.005 < series[f"{leg}_sinkage_m"].min() < series[f"{leg}_sinkage_m"].max() < 0.05
    before, left = (read_height_field(tmp_path / name) for name in ("dunes.npz", "out/ruts/straight_rigid.npz"))
    x, y = (begin + 0.02 * np.arange(n) for begin, n in zip(left.origin, left.heights.shape, strict=True))
    depth = before.height(x[:, None] + 0.0 * y, y + 0.0 * x[:, None]) - left.heights
    assert -1e-9 < depth.min() < 1e-9
    assert 0.01 < depth.max() < 0.05


@pytest.mark.slow
@pytest.mark.parametrize("how", [("traction",), pytest.param(("straight", "--walk"), marks=pytest.mark.long)])
def test_what_is_not_driven_by_its_speed_tells_no_slip(tmp_path: Path, how: tuple[str, ...]) -> None:
    ended = run("rover", *how, "--tire", "rigid", "--soil", "fjs1", "--cell", "20 mm", "--out", tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "deepest rut" in ended.stdout
    assert "slip of the rover" not in " ".join(ended.stdout.split())


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["straight", "--soil", "moon"], "soil = 'moon': is not known"),
        (["straight", "--soil", "ding2011", "--tire", "ancf"], "tire on soil = 'ancf': is not known there"),
        (["straight", "--soil", "ding2011", "--cell", "10 kg"], "cell of the soil"),
        (["straight", "--soil", "ding2011", "--tire", "rigid", "--cell", "1 m"], "must be at most 20 mm"),
        (["straight", "--soil", "ding2011", "--tire", "rigid", "--cell", "1 um"], "cells of the soil"),
        (["straight", "--cell", "10 mm"], "is of no soil"),
        (["straight", "--soil", "ding2011", "--rocks", "1"], "has no rocks"),
        (["straight", "--soil", "ding2011", "--start", "1", "2"], "is a place on a height field"),
        (["step", "--soil", "ding2011", "--tire", "rigid"], "has a ground of its own"),
        (["drop", "--soil", "ding2011", "--tire", "rigid"], "or does not drive"),
    ],
)
def test_what_cannot_be_driven_is_refused(tmp_path: Path, arguments: list[str], told: str) -> None:
    ended = run("rover", *arguments, "--out", tmp_path / "out")
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stderr
    assert told in ended.stderr
    assert not (tmp_path / "out" / "series").exists()
