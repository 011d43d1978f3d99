"""``workbench calibrate brush``, run as a user would run it: the table, the record, and the rover that drives on it."""

from __future__ import annotations

import csv
import json
import subprocess
from pathlib import Path

import pytest

from contracts.series import read_series
from tests.end_to_end.small_study import run, said, tiny_study

COARSE = """
[full]
orientation_step = "90 deg"

[ancf_wheel]
element_size = "40 mm"
axial_size = "40 mm"
"""
LOAD = 40.0
"""The tiny study's curves end at 6 mm [N]."""
WEIGHT = 320.0 * 3.711 / 6.0
COMMAND = ("calibrate", "brush", "study.toml", "--model", "ancf_wheel", "--load", f"{LOAD:g}")

type Calibrated = tuple[Path, subprocess.CompletedProcess[str]]


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory: pytest.TempPathFactory) -> Calibrated:
    """A folder with a study of one orientation that drives on its wheel, and what the command said."""
    folder = tmp_path_factory.mktemp("brush")
    text = tiny_study()
    assert text.count("\n[rover]\n") == 1
    (folder / "study.toml").write_text(text.replace("\n[rover]\n", '\n[rover]\nbrush = "wheel"\n') + COARSE)
    unknown = said("rover", "static", "--study", "study.toml", folder=folder)
    assert unknown.returncode == 2
    assert 'rover.brush = "wheel": has no numbers beside the study; run workbench calibrate brush' in unknown.stderr
    return folder, run(*COMMAND, "--out", "o", "--store", "s", folder=folder)


@pytest.mark.long
def test_the_table_stands_beside_table_two(calibrated: Calibrated) -> None:
    folder, ended = calibrated
    assert ended.returncode == 0, ended.stderr
    assert "brush tire of the wheel at 40 N" in ended.stdout
    assert "850 N/deg" in ended.stdout
    with (folder / "o" / "brush_of_wheel.csv").open(encoding="utf-8") as file:
        rows = {row["parameter"]: row for row in csv.DictReader(file)}
    record = json.loads((folder / "study.kept" / "brush.json").read_text(encoding="utf-8"))
    assert record["command"] == " ".join(["workbench", *COMMAND])
    for name, key in (("radial stiffness", "radial"), ("standing stiffness forwards", "forward")):
        assert float(rows[name]["wheel"]) == pytest.approx(record["found"][f"{key}_N_per_m"])
    assert [float(rows["radial stiffness"][one]) for one in ("table_ii", "ratio")] == pytest.approx(
        [8250.0, record["found"]["radial_N_per_m"] / 8250.0]
    )
    assert len(rows) == len(record["found"]["table"]) == 14
    assert all(None not in row for row in rows.values())
    assert (rows["contact length"]["wheel"], rows["contact length"]["unit"]) == ("", "m")
    assert 0.0 < record["found"]["forward_N_per_m"] < record["found"]["sideways_N_per_m"] < 275e3


@pytest.mark.long
def test_the_same_again_is_found_in_the_store(calibrated: Calibrated) -> None:
    folder, _ = calibrated
    before = (folder / "study.kept" / "brush.json").read_text(encoding="utf-8")
    again = run(*COMMAND, "--out", "o", "--store", "s", folder=folder)
    assert (again.returncode, "0 tasks computed" in again.stdout) == (0, True), again.stderr
    after = (folder / "study.kept" / "brush.json").read_text(encoding="utf-8")
    assert json.loads(after)["found"] == json.loads(before)["found"]
    assert "replace" not in again.stderr
    other = json.loads(after) | {"command": "workbench calibrate brush study.toml --load 41", "inputs": "0"}
    (folder / "study.kept" / "brush.json").write_text(json.dumps(other), encoding="utf-8")
    told = run(*COMMAND, "--out", "o", "--store", "s", folder=folder).stderr
    assert "this will replace the kept record of `workbench calibrate brush study.toml --load 41`" in told


@pytest.mark.long
def test_the_rover_stands_as_deep_as_the_record_says(calibrated: Calibrated) -> None:
    """Closed form: a sixth of its weight over the stiffness of the record."""
    folder, _ = calibrated
    ended = run("rover", "static", "--study", "study.toml", "--out", "r", folder=folder)
    assert ended.returncode == 0, ended.stderr
    series = read_series(folder / "r" / "series" / "static_brush.csv", "static", "brush")
    found = json.loads((folder / "study.kept" / "brush.json").read_text(encoding="utf-8"))["found"]
    wheels = [series[name][-1] for name in series.columns if name.endswith("_deflection_m")]
    assert sum(wheels) / 6.0 == pytest.approx(WEIGHT / found["radial_N_per_m"], rel=1e-4)


def test_numbers_of_another_wheel_are_not_driven_on(calibrated: Calibrated, tmp_path: Path) -> None:
    folder, _ = calibrated
    text = (folder / "study.toml").read_text(encoding="utf-8")
    assert text.count('thickness = "0.6 mm"') == 1
    (tmp_path / "study.toml").write_text(text.replace('thickness = "0.6 mm"', 'thickness = "0.7 mm"'))
    (tmp_path / "study.kept").mkdir()
    (tmp_path / "study.kept" / "brush.json").write_bytes((folder / "study.kept" / "brush.json").read_bytes())
    for command in (("rover", "static", "--study", "study.toml"), ("check", "study.toml")):
        ended = said(*command, folder=tmp_path)
        assert ended.returncode == 2
        assert "of another wheel than the study's is now; run workbench calibrate brush" in ended.stderr


def test_what_lies_in_the_records_place_is_told_before_anything_is_computed(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(tiny_study() + COARSE)
    (tmp_path / "study.kept").mkdir()
    (tmp_path / "study.kept" / "brush.json").write_text("my notes")
    ended = said(*COMMAND, "--store", "s", folder=tmp_path)
    assert ended.returncode == 2
    assert "brush.json: cannot be read" in ended.stderr
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--model", "brush"), "has no hub that could be moved"),
        (("--load", "0"), "load = 0 N: must lie between 0.1 N and fe.max_load, 300 N"),
        (("--load", "nan"), "load = nan N: must lie between"),
    ],
)
def test_bad_input_ends_with_one_message(tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    (tmp_path / "study.toml").write_text(tiny_study() + COARSE)
    ended = said("calibrate", "brush", "study.toml", *arguments, folder=tmp_path)
    assert ended.returncode == 2
    assert message in " ".join(ended.stderr.split())
    assert not (tmp_path / "study.kept").exists()
