"""``workbench rover --study``: the rover drives on the study's tires and ground; what cannot be its tire is refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from contracts.series import TimeSeries, read_series
from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from tests.end_to_end.small_study import run
from workbench.questions.rover.motion_file import read_motion
from workbench.study.reading import built_in_study

LOAD = 197.92
"""A sixth of 320 kg on Mars [N]."""
WHEELS = [f"{end}_{side}" for end in ("front", "center", "rear") for side in ("left", "right")]


def study(folder: Path, *changes: tuple[str, str], more: str = "") -> Path:
    """The built-in study with lines exchanged and sections added."""
    text = built_in_study().read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    (folder / "own.toml").write_text(f"{text}\n{more}", encoding="utf-8")
    return folder / "own.toml"


def mean(series: TimeSeries, what: str) -> float:
    """Over the wheels, at the end."""
    return float(np.mean([series[f"{wheel}_{what}"][-1] for wheel in WHEELS]))


def test_the_deflection_follows_the_studys_radial_stiffness(tmp_path: Path) -> None:
    """Closed form: load over stiffness, 24.0 mm on Table II's tire and 39.6 mm on this one."""
    soft = study(tmp_path, ('radial_stiffness = "8250 N/m"', 'radial_stiffness = "5000 N/m"'))
    for arguments, stiffness in (((), 8250.0), (("--study", soft), 5000.0)):
        ended = run("rover", "static", *arguments, "--out", tmp_path / "o")
        assert ended.returncode == 0, ended.stderr
        series = read_series(tmp_path / "o" / "series" / "static_brush.csv", "static", "brush")
        assert mean(series, "load_N") == pytest.approx(LOAD, rel=1e-6)
        assert mean(series, "deflection_m") == pytest.approx(LOAD / stiffness, rel=1e-6)


@pytest.mark.parametrize("tire", ["brush", "rigid"])
def test_friction_of_the_ground_bounds_the_traction_on_a_slope(tmp_path: Path, tire: str) -> None:
    """With 0.3 the rover stays back on 25 degrees, whose tangent is 0.466, and each wheel pulls with 0.3 of its load.

    The steepest slope it climbs is atan 0.3 = 16.7 degrees at most.
    """
    icy = study(tmp_path, more="[ground]\nfriction = 0.3\n")
    ended = run("rover", "slope_up", "--study", icy, "--tire", tire, "--out", tmp_path / "o")
    assert ended.returncode == 0, ended.stderr
    series = read_series(tmp_path / "o" / "series" / f"slope_up_{tire}.csv", "slope_up", tire)
    assert "friction 0.3" in series.source
    pull = np.array([series[f"{wheel}_tractive_N"] / series[f"{wheel}_load_N"] for wheel in WHEELS])
    assert np.abs(pull).max() == pytest.approx(0.3, rel=1e-3)
    assert series["body_vx_m_s"][-1] < 0.0
    line = next(line for line in ended.stdout.splitlines() if "steepest slope" in line)
    steepest = float(line.split("│")[2].split()[0])
    assert 15.0 < steepest < math.degrees(math.atan(0.3))


@pytest.mark.long
def test_the_ancf_tire_is_the_studys(tmp_path: Path) -> None:
    """Twice as stiff a plate: the rover stands less deep than on the thesis' tire, 27.2 mm between two spokes.

    Plates from a smaller hub on would weigh more than the wheel whose mass they take over; lighter ones do not.
    """
    changes = (('young_modulus = "280 kPa"', 'young_modulus = "560 kPa"'), ("thesis_preset = true", ""))
    heavy = study(tmp_path, ('hub_radius = "50 mm"                # inferred', 'hub_radius = "45 mm"'))
    refused = run("rover", "static", "--study", heavy, "--tire", "ancf", "--out", tmp_path / "o")
    assert refused.returncode == 2
    assert "must hold more than its tire of 4.516 kg; make the tire lighter" in refused.stderr
    changes = (*changes, ('density = "1500 kg/m^3"', 'density = "1300 kg/m^3"'))
    stiff = study(tmp_path, *changes, ('hub_radius = "50 mm"                # inferred', 'hub_radius = "45 mm"'))
    ended = run("rover", "static", "--study", stiff, "--tire", "ancf", "--out", tmp_path / "o")
    assert ended.returncode == 0, ended.stderr
    series = read_series(tmp_path / "o" / "series" / "static_ancf.csv", "static", "ancf")
    assert mean(series, "load_N") == pytest.approx(LOAD, rel=2e-3)
    assert mean(series, "deflection_m") < 0.022
    motion = read_motion(tmp_path / "o" / "motions" / "static_ancf.npz")
    assert motion.tire is not None
    preset = motion.tire["preset"]
    assert (preset["young_modulus"], preset["hub_radius"], preset["outer_radius"]) == (560e3, 0.045, 0.1425)


def test_a_tire_that_is_not_the_rovers_is_refused_in_one_line(tmp_path: Path) -> None:
    amalia = built_in_study().parent / "amalia.toml"
    (tmp_path / "icy").mkdir()
    icy = study(tmp_path / "icy", more="[ground]\nfriction = 0\n")
    wide = study(
        tmp_path,
        ('[ancf]\nouter_radius = "142.5 mm"', '[ancf]\nouter_radius = "150 mm"'),
        ("thesis_preset = true", ""),
        ('radial_stiffness = "8250 N/m"', 'radial_stiffness = "1200 N/m"'),
    )
    for arguments, words in (
        (("--study", amalia), "study's wheel = 90 mm: is not that of the rover's wheels, 142.5 mm; give --rover FILE"),
        (("--study", wide, "--tire", "ancf"), "142.5 mm: is not that of the ANCF tire, 150 mm; use --tire brush"),
        (("--study", wide), "tires = 164.9 mm: at rest must be below the wheel's radius, 142.5 mm; give more radial"),
        (("--study", tmp_path / "none.toml"), "none.toml: does not exist"),
        (("--study", icy), "ground.friction = 0: must be greater than 0"),
    ):
        ended = run("rover", "static", *arguments, "--out", tmp_path / "o")
        told = [line for line in ended.stderr.splitlines() if "warning" not in line]
        assert (ended.returncode, len(told)) == (2, 1), ended.stderr
        assert words in told[0]


def test_a_rover_with_the_studys_wheels_drives_on_it(tmp_path: Path) -> None:
    text = EXOMARS_ROVER.read_text(encoding="utf-8")
    (tmp_path / "small.toml").write_text(text.replace("radius = 0.1425", "radius = 0.09"), encoding="utf-8")
    amalia = built_in_study().parent / "amalia.toml"
    bare = run("rover", "static", "--study", amalia, "--rover", tmp_path / "small.toml", "--out", tmp_path / "none")
    assert (bare.returncode, "[brush]: is not in the study" in bare.stderr) == (2, True)
    brush = "[brush]" + built_in_study().read_text(encoding="utf-8").split("[brush]")[1].split("[rover]")[0]
    text = amalia.read_text(encoding="utf-8") + brush.replace('"8250 N/m"', '"16500 N/m"')
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    (tmp_path / "amalia_fe.csv").write_bytes(amalia.with_name("amalia_fe.csv").read_bytes())
    ended = run(
        "rover", "static", "--study", tmp_path / "own.toml", "--rover", tmp_path / "small.toml", "--out", tmp_path / "o"
    )
    assert ended.returncode == 0, ended.stderr
    series = read_series(tmp_path / "o" / "series" / "static_brush.csv", "static", "brush")
    assert mean(series, "deflection_m") == pytest.approx(LOAD / 16500.0, rel=1e-6)
