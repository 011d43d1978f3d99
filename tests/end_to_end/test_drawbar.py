"""``workbench drawbar`` as a user runs it.

Claim: it drives the study's wheel on a named soil or on a file's, writes the columns others read, keeps what it found
of the rim beside the study, and tells what cannot be in one message with exit status 2.
"""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.end_to_end.small_study import tiny_study

ROOT = Path(__file__).parents[2]
SOIL = """
exponent = 1.1
cohesive_modulus = 15600
frictional_modulus = 2.4074e6
cohesion = "0.25 kPa"
friction_angle = "31.9 deg"
density = "1605 kg/m^3"
shear_modulus = ["9.7 mm", "13.1 mm"]
"""


def drawbar(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """The command in a folder of its own."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80"}
    command = [sys.executable, "-m", "workbench", "drawbar", *arguments]
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=600)


def rows(path: Path) -> list[dict[str, str]]:
    """Of the table, without its comment lines."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@pytest.fixture(scope="module")
def studies(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built-in study with what is kept beside it, and a soil of one's own."""
    folder = tmp_path_factory.mktemp("drawbar")
    shutil.copy(ROOT / "studies" / "exomars.toml", folder)
    shutil.copytree(ROOT / "studies" / "exomars.kept", folder / "exomars.kept")
    (folder / "mine.toml").write_text(SOIL, encoding="utf-8")
    return folder


def test_the_built_in_wheel_pulls_by_its_solid_model(studies: Path) -> None:
    run = drawbar("exomars.toml", "--soil", "ding2011", "--load", "200", "--out", "out", cwd=studies)
    assert run.returncode == 0, run.stderr
    assert "largest pull of the flexible wheel less that of the rigid one" in run.stdout
    table = rows(studies / "out" / "drawbar.csv")
    assert list(table[0])[:4] == ["slip", "drawbar_pull_N", "torque_N_m", "sinkage_m"]
    assert [float(row["slip"]) for row in table] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    pulls = [float(row["drawbar_pull_N"]) for row in table]
    assert pulls[2] > pulls[1] > pulls[0]
    assert all(float(row["sinkage_m"]) < float(row["rigid_sinkage_m"]) for row in table[:4])
    assert (studies / "out" / "drawbar.png").read_bytes().startswith(b"\x89PNG")


def test_ones_own_soil_is_the_table_s(studies: Path) -> None:
    for soil, out in (("mine.toml", "a"), ("ding2011", "b")):
        options = ("--soil", soil, "--tire", "rigid", "--slip", "0.3", "--towed", "--out", out)
        run = drawbar("exomars.toml", *options, cwd=studies)
        assert run.returncode == 0, run.stderr
    mine, known = rows(studies / "a" / "drawbar.csv"), rows(studies / "b" / "drawbar.csv")
    assert len(mine) == 2
    for one, other in zip(mine, known, strict=True):
        assert float(one["drawbar_pull_N"]) == pytest.approx(float(other["drawbar_pull_N"]), rel=1e-5)
    assert float(mine[1]["slip"]) < 0.0
    assert abs(float(mine[1]["torque_N_m"])) < 1e-5


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (("--soil", "sahara"), "ding2011, fjs1"),
        (("--soil", "none.toml"), "none.toml"),
        (("--load", "0"), "must be above zero"),
        (("--load", "1e6"), "axle"),
        (("--slip", "0:1:0.1"), "[-1, 1)"),
        (("--slip", "a:b"), "A:B:STEP"),
        (("--slip", "0:0.6:0"), "step > 0"),
        (("--tire", "ancf"), "rigid, brush, fe, ancf_wheel"),
        (("--gravity", "venus"), "mars"),
    ],
)
def test_what_cannot_be_is_one_message(studies: Path, options: tuple[str, ...], word: str) -> None:
    rigid = () if "--tire" in options else ("--tire", "rigid")
    run = drawbar("exomars.toml", *rigid, *options, "--out", "refused", cwd=studies)
    assert (run.returncode, run.stderr.count("\n")) == (2, 1), run.stderr
    assert run.stderr.startswith("workbench: error: ")
    assert word in run.stderr
    assert not (studies / "refused").exists()


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (("frictional_modulus = 2.4074e6", "frictional_modulus = 240.74"), "1 kPa is 1000"),
        (('"0.25 kPa"', '"0.25 mm"'), "cohesion"),
        (('"31.9 deg"', "31.9"), "friction_angle"),
        (("exponent = 1.1", "exponant = 1.1"), "exponant"),
        (('["9.7 mm", "13.1 mm"]', '["13.1 mm", "9.7 mm"]'), "[low, high]"),
        (("exponent = 1.1\n", ""), "exponent"),
        (("exponent = 1.1", "exponent = "), "is not valid TOML"),
        (('["9.7 mm", "13.1 mm"]', "[]"), "[low, high]"),
    ],
)
def test_a_soil_file_that_cannot_be_is_one_message(studies: Path, change: tuple[str, str], word: str) -> None:
    (studies / "odd.toml").write_text(SOIL.replace(*change), encoding="utf-8")
    run = drawbar("exomars.toml", "--tire", "rigid", "--soil", "odd.toml", "--out", "refused", cwd=studies)
    assert (run.returncode, run.stderr.count("\n")) == (2, 1), run.stderr
    assert word in run.stderr


def test_what_a_rigid_wheel_cannot_is_told_before_its_rim_is_computed(studies: Path) -> None:
    (studies / "soft.toml").write_text(SOIL.replace("2.4074e6", "2e4").replace("15600", "0"), encoding="utf-8")
    (studies / "new.toml").write_text((ROOT / "studies" / "first.toml").read_text(encoding="utf-8"), encoding="utf-8")
    run = drawbar("new.toml", "--soil", "soft.toml", "--store", "store", cwd=studies)
    assert (run.returncode, run.stdout) == (2, "")
    assert run.stderr.startswith("workbench: error: load of the wheel = 200 N on soft at slip 0: must be below ")
    assert not (studies / "store").exists()


def test_a_rim_known_by_one_point_of_its_curve_is_used_and_said_to_be(studies: Path) -> None:
    """The run ends at its first point, 27 N or more at 3 mm; the bench asks for 60 N."""
    text = re.sub(r'max_load = "300 N"', 'max_load = "20 N"', tiny_study().replace('"20 N", "10 kN"', '"20 N"'))
    (studies / "short.toml").write_text(text, encoding="utf-8")
    options = ("--soil", "fjs1", "--load", "60", "--slip", "0.2", "--store", "store", "--out", "short")
    run = drawbar("short.toml", *options, cwd=studies)
    assert run.returncode == 0, run.stderr
    (warning,) = run.stderr.splitlines()
    assert re.search(r"short.toml: 60 N lies beyond the wheel's curves, which end at \d+\.\d N: the rim is", warning)
    (row,) = rows(studies / "short" / "drawbar.csv")
    assert float(row["deflection_m"]) > 1e-3


def test_the_kept_rim_names_no_place_of_this_machine() -> None:
    kept = (ROOT / "studies" / "exomars.kept" / "carcass_fe.json").read_text(encoding="utf-8")
    assert '"workbench drawbar --tire fe"' in kept
    assert str(ROOT) not in kept
