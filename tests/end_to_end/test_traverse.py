"""``workbench traverse`` as a user runs it: killed on its way, gone on, reused; bad input."""

from __future__ import annotations

import csv
import json
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment, run, said, small_study_text
from workbench.questions.traverse.results import traverse_of


@pytest.mark.long
def test_a_killed_drive_goes_on_where_it_was_and_a_second_one_drives_nothing(tmp_path: Path) -> None:
    study, out = tmp_path / "own.toml", tmp_path / "out"
    study.write_text(small_study_text(), encoding="utf-8")
    asked = ("--distance", "21", "--speed", "400", "--seed", "3", "--abundance", "0.1")
    words = ("traverse", study, *asked, "--store", tmp_path / "store", "--out", out)
    first = subprocess.Popen(
        command(*words, "--workers", "1"), stdout=subprocess.PIPE, text=True, cwd=ROOT, env=environment()
    )
    assert first.stdout is not None
    assert "computed in" in first.stdout.readline()
    first.kill()
    first.wait()
    first.stdout.close()
    assert not (tmp_path / "own.kept").exists()
    after, again = run(*words), run(*words)
    assert after.returncode == again.returncode == 0, after.stderr
    assert after.stdout.count("reused") >= 1
    assert (again.stdout.count("reused"), again.stdout.count("computed in")) == (2, 0)
    record = json.loads((tmp_path / "own.kept" / "traverse.json").read_text(encoding="utf-8"))
    options = "--tire brush --distance 21 --abundance 0.1 --seed 3 --speed 400"
    assert record["command"] == f"workbench traverse {study} {options}"
    found = traverse_of(record["found"])
    drive = found.runs["brush"]
    assert drive.way == pytest.approx(21.0, abs=0.03) or drive.ends
    with (out / "cycles_brush.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    cycles = sum(float(row["front_left"]) for row in rows if row["of"] == "load_N")
    assert cycles == pytest.approx(sum(drive.load_cycles[found.wheels.index("front_left")]), rel=1e-4)
    assert cycles > 1.0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--abundance", "0"), "abundance = 0: must lie in [0.001, 0.4]"),
        (("--abundance", "0.41"), "abundance = 0.41"),
        (("--distance", "-5"), "distance = -5 m"),
        (("--speed", "0"), "speed = 0 m/h"),
        (("--tire", "wood"), "tire of the traverse = 'wood': is not known; give brush or fe"),
    ],
)
def test_what_cannot_be_driven_is_one_message(tmp_path: Path, options: tuple[str, str], words: str) -> None:
    study = tmp_path / "own.toml"
    study.write_text(small_study_text(), encoding="utf-8")
    found = said("traverse", study, *options, folder=tmp_path)
    assert (found.returncode, words in found.stderr) == (2, True), found.stderr
    assert not (tmp_path / "own.kept").exists()
