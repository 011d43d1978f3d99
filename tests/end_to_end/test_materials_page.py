"""A wheel of several laws as a user asks for it: the shipped study of the how-to, coarser, and what is refused of it.

The page's own commands run in tests/end_to_end/test_documented_commands.py.
"""

from __future__ import annotations

import csv
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, read_curve
from tests.end_to_end.small_study import ROOT, run, said

STUDY = ROOT / "studies" / "rubber_tread.toml"
COARSER = {r'element_size = "[^"]*"': 'element_size = "24 mm"', r"points = \d+": "points = 3"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    text = STUDY.read_text(encoding="utf-8")
    for pattern, new in COARSER.items():
        text, count = re.subn(pattern, new, text, count=1)
        assert count == 1, pattern
    path = tmp_path_factory.mktemp("materials")
    (path / "tread.toml").write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def pressed(folder: Path) -> subprocess.CompletedProcess[str]:
    return run("stiffness", folder / "tread.toml", "--out", folder / "out", "--store", folder / "store")


def _curve(folder: Path, name: str) -> StiffnessCurve:
    return read_curve(folder / "out" / "curves" / f"{name}.csv")


@pytest.mark.long
def test_the_way_back_is_a_curve_of_its_own(folder: Path, pressed: subprocess.CompletedProcess[str]) -> None:
    assert pressed.returncode == 0, pressed.stderr
    there, back = _curve(folder, "fe_phi000"), _curve(folder, "fe_unloading_phi000")
    assert back.load[0] == 0.0
    assert back.deflection[0] > 1e-4
    assert back.load[-1] == there.load[-1]
    assert np.all(back.load[1:-1] < there.load_at(back.deflection[1:-1]))
    set_mm, lost = (float(n) for n in re.findall(r"permanent set ([\d.]+) mm, ([\d.]+) J lost", pressed.stdout)[0])
    assert set_mm == pytest.approx(1e3 * back.deflection[0], abs=5e-4)
    loop = float(np.trapezoid(there.load, there.deflection) - np.trapezoid(back.load, back.deflection))
    assert lost == pytest.approx(loop, rel=5e-3)
    assert back.columns["plastic_dissipation_J"][0] == pytest.approx(loop, rel=0.2)  # over three points


@pytest.mark.long
def test_rubber_bears_and_is_not_judged(folder: Path, pressed: subprocess.CompletedProcess[str]) -> None:
    there = _curve(folder, "fe_phi000")
    assert 0.0 < there.columns["max_von_mises_tread_Pa"][-1] < 5e6
    assert "max_plastic_strain_tread" not in there.columns
    with (folder / "out" / "fe_peak_stress.csv").open(encoding="utf-8") as file:
        assert {row["part"] for row in csv.DictReader(file)} == {"tire", "springs"}


@pytest.mark.long
def test_a_report_tells_the_set_and_who_is_not_judged(folder: Path, pressed: subprocess.CompletedProcess[str]) -> None:
    found = run("report", folder / "tread.toml", "--out", folder / "report", "--store", folder / "store")
    assert found.returncode == 0, found.stdout + found.stderr
    page, evidence = ((folder / "report" / f"{name}.html").read_text() for name in ("report", "evidence"))
    assert "Not judged, for want of a yield strength: tread." in page
    assert "none up to" in page
    set_mm = f"{1e3 * _curve(folder, 'fe_unloading_phi000').deflection[0]:.3f}"
    assert re.search(rf"<h3>The way back</h3>.*>{set_mm}<", evidence, re.S)
    assert (folder / "report" / "curves" / "fe_unloading_phi000.csv").exists()


@pytest.mark.parametrize(
    ("command", "told"),
    [
        (("stiffness", "--model", "section"), "materials.rubber.law.kind = mooney_rivlin: has no planar form"),
        (("stiffness", "--model", "ancf_wheel"), "wheel.tread: is not in the ANCF model of the wheel"),
        (("calibrate", "--target", "8 N/mm"), "materials.rubber.law.kind = mooney_rivlin: has no planar form"),
    ],
)
def test_what_a_model_does_not_have_is_refused(command: tuple[str, ...], told: str, tmp_path: Path) -> None:
    name, *options = command
    asked = said(name, STUDY, *options, "--out", tmp_path / "out", "--store", tmp_path / "store")
    assert asked.returncode == 2
    assert f"error: {STUDY}: {told}" in asked.stderr
    assert len(asked.stderr.strip().splitlines()) == 1


def test_a_rover_does_not_drive_on_a_wheel_that_yields(tmp_path: Path) -> None:
    law = '\n[materials."Ti-6Al-4V".law]\nkind = "j2_plasticity"\n'
    text = (ROOT / "studies" / "first.toml").read_text(encoding="utf-8")
    (tmp_path / "yields.toml").write_text(text + law, encoding="utf-8")
    options = ("--study", tmp_path / "yields.toml", "--tire", "fe", "--store", tmp_path / "store")
    asked = said("rover", "straight", *options, "--out", tmp_path / "out")
    assert asked.returncode == 2
    assert "materials.Ti-6Al-4V.law.kind = j2_plasticity: is not in a rover's wheel" in asked.stderr
