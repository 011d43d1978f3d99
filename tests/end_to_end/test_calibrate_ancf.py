"""``workbench calibrate ancf``, run as a user would run it, on a coarse study; and the older form beside it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, small_study_text
from workbench.study.reading import read_study


@pytest.mark.long
def test_the_fitted_tire_lands_in_a_study(workspace: Path, tmp_path: Path) -> None:
    """One orientation to 6 mm: four spokes follow it within 3 %; the study written holds the tire found.

    A doubled mesh carries another load, so that the tire is marked, and the command ends with 1.
    """
    arguments = ("calibrate", "ancf", "study.toml", "--tire", "four_spokes", "--out", tmp_path / "out")
    ended = run(*arguments, "--store", "store", folder=workspace)
    assert ended.returncode == 1, ended.stdout + ended.stderr
    assert "four_spokes: " in ended.stderr
    assert "twice as many plates" in ended.stderr
    found = json.loads((tmp_path / "out" / "ancf_fit.json").read_text(encoding="utf-8"))
    (tire,) = found["tires"]
    assert found["kept"] == tire["name"] == "four_spokes"
    assert abs(tire["average"]["largest"]) < 0.03 < abs(found["own"]["average"]["largest"])
    assert any("twice as many plates" in reason for reason in tire["not_to_be_trusted"])
    assert tire["flexible_mass_kg"] == pytest.approx(4.44157)
    assert {p["name"] for p in tire["parameters"]} >= {"young_modulus", "thickness", "outer_radius"}
    old, new = read_study(workspace / "study.toml"), read_study(tmp_path / "out" / "study_fitted.toml")
    assert new.ancf.young_modulus == pytest.approx(tire["preset"]["young_modulus"], rel=1e-5)
    assert new.ancf.outer_radius == pytest.approx(tire["preset"]["outer_radius"], rel=1e-5)
    assert new.ancf.datum_radius == pytest.approx(old.ancf.outer_radius)
    assert new.ancf.orientations == old.fe.orientations
    assert not new.ancf.thesis_preset
    assert (new.fe, new.wheel) == (old.fe, old.wheel)
    assert (tmp_path / "out" / "curves" / "ancf_four_spokes_phi000.csv").is_file()
    for text in ("average: largest", "young_modulus", "study_fitted.toml"):
        assert text in ended.stdout
    again = run(*arguments, "--store", "store", folder=workspace)
    assert "computed in" not in again.stdout  # every run is found in the store
    curves = run("stiffness", tmp_path / "out" / "study_fitted.toml", "--model", "ancf", "--out", tmp_path / "c",
                 "--store", "store", folder=workspace)  # fmt: skip
    assert curves.returncode == 0, curves.stderr


BOUNDS = "[ancf_fit.bounds]"
TRAVEL = '[ancf_fit.travel]\nways = ["lateral", "turning"]\nload = "30 N"\nweight = 1\n\n'


@pytest.mark.long
def test_stiffnesses_against_travel_are_data_and_told(workspace: Path, tmp_path: Path) -> None:
    """One orientation under 30 N: FE's and every tire's stiffness in the file and in the printed table."""
    (tmp_path / "study.toml").write_text(small_study_text().replace(BOUNDS, TRAVEL + BOUNDS, 1), encoding="utf-8")
    arguments = ("calibrate", "ancf", tmp_path / "study.toml", "--tire", "four_spokes", "--store", "store")
    ended = run(*arguments, "--out", tmp_path / "out", folder=workspace)
    assert ended.returncode in (0, 1), ended.stdout + ended.stderr
    found = json.loads((tmp_path / "out" / "ancf_fit.json").read_text(encoding="utf-8"))
    (tire,) = found["tires"]
    for numbers in (found["own"], tire):
        assert numbers["travel_load_N"] == 30.0
        assert [(row["way"], row["unit"]) for row in numbers["travels"]] == [("lateral", "N/m"), ("turning", "N m/rad")]
    for row, own in zip(tire["travels"], found["own"]["travels"], strict=True):
        assert row["fe"] == own["fe"] > 0.0
        assert row["difference"] == pytest.approx(row["tire"] / row["fe"] - 1.0)
    for text in ("hub's travel under 30 N", "lateral", "N m/rad", f"{tire['travels'][1]['fe']:.4g}"):
        assert text in ended.stdout


@pytest.mark.long
def test_a_load_that_a_curve_never_reaches_is_one_message(workspace: Path, tmp_path: Path) -> None:
    text = small_study_text().replace(BOUNDS, TRAVEL.replace("30 N", "240 N") + BOUNDS, 1)
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    arguments = ("calibrate", "ancf", tmp_path / "study.toml", "--store", "store", "--out", tmp_path / "o")
    ended = run(*arguments, folder=workspace)
    assert ended.returncode == 2, ended.stdout + ended.stderr
    assert "240 N" in ended.stderr
    assert "Traceback" not in ended.stderr


@pytest.mark.parametrize(
    ("arguments", "old", "new", "text"),
    [
        (("--tire", "nine_spokes"), "", "", "none of the study's (four_spokes, six_spokes)"),
        ((), "[ancf_fit]", "[ancf_fits]", "not a known key"),
        ((), 'load_range = ["20 N"', 'load_range = ["240 N"', "beyond the end of the FE average"),
        ((), BOUNDS, TRAVEL.replace("lateral", "sideways") + BOUNDS, "ancf_fit.travel.ways"),
        ((), BOUNDS, TRAVEL.replace("30 N", "10 N") + BOUNDS, "must lie within ancf_fit.load_range"),
        ((), BOUNDS, TRAVEL.replace("weight = 1", "weight = 0") + BOUNDS, "ancf_fit.travel.weight"),
    ],
)
@pytest.mark.usefixtures("first_report")
def test_bad_input_ends_with_status_2(
    workspace: Path, tmp_path: Path, arguments: tuple[str, ...], old: str, new: str, text: str
) -> None:
    study = tmp_path / "study.toml"
    study.write_text(small_study_text().replace(old, new, 1) if old else small_study_text(), encoding="utf-8")
    ended = run("calibrate", "ancf", study, *arguments, "--out", tmp_path / "o", "--store", "store", folder=workspace)
    assert ended.returncode == 2
    assert text in ended.stderr
    assert "Traceback" not in ended.stderr
    assert not (tmp_path / "o" / "ancf_fit.json").exists()


def test_a_study_without_the_section_is_told_so(workspace: Path, tmp_path: Path) -> None:
    text = small_study_text()
    start, end = text.index("[ancf_fit]"), text.index("# --- The brush tire")
    (tmp_path / "study.toml").write_text(text[:start] + text[end:], encoding="utf-8")
    ended = run("calibrate", "ancf", tmp_path / "study.toml", "--out", tmp_path / "o", folder=workspace)
    assert ended.returncode == 2
    assert "[ancf_fit]" in ended.stderr
    shown = run("calibrate", "--help")
    assert shown.returncode == 0
    assert all(name in shown.stdout for name in ("thickness", "ancf"))
