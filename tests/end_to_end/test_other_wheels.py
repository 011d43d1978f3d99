"""The studies of docs/how_to/other_wheels.md, run as a user would run them: cells, tapered leaves, a tread."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, read_curve
from tests.end_to_end.small_study import ROOT, run

COARSE = {
    r'max_deflection = "[^"]*"': 'max_deflection = "2 mm"',
    r"points = \d+": "points = 2",
    r"snapshot_loads = .*\n": "",
    r"\[mesh_study\][^\[]*\[[^\n]*\n[^\n]*\n": "",
}
"""Pattern in a study -> what a short one has."""


def written(folder: Path, study: str, changes: dict[str, str]) -> None:
    """A shipped study with other numbers, ``study.toml`` in the folder."""
    text = (ROOT / "studies" / f"{study}.toml").read_text(encoding="utf-8")
    for pattern, new in changes.items():
        text, count = re.subn(pattern, new, text, count=1)
        assert count or pattern in COARSE, pattern
    (folder / "study.toml").write_text(text, encoding="utf-8")


def curve(folder: Path, *options: str, at: str = "0") -> StiffnessCurve:
    """At one orientation [deg]; forces are in balance."""
    ended = run("stiffness", "study.toml", "--orientation", at, *options, "--out", "o", "--store", "s", folder=folder)
    assert ended.returncode == 0, ended.stderr
    (path,) = (folder / "o" / "curves").glob("*_phi*.csv")
    found = read_curve(path)
    shutil.rmtree(folder / "o")
    assert np.all(np.abs(found.columns["force_imbalance"]) < 1e-6)
    return found


def test_mesh_of_the_honeycomb(tmp_path: Path) -> None:
    """Volume of every part to 2e-6, no cell worse than a joint's corner, one CAD solid of the whole lattice."""
    written(tmp_path, "honeycomb", {"cells = 16": "cells = 8", 'axial_size = "15 mm"': 'axial_size = "30 mm"'})
    ended = run("mesh", "study.toml", "--out", "m", "--store", "s", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    for mesh in json.loads((tmp_path / "m" / "summary.json").read_text(encoding="utf-8")).values():
        assert set(mesh["parts"]) == {"tire", "lattice", "lattice_joints", "outer_hub"}
        for part in mesh["parts"].values():
            assert part["volume"] == pytest.approx(part["volume_closed_form"], rel=2e-6)
        assert mesh["quality"]["min_scaled_jacobian"] > 0.7
    step = (tmp_path / "m" / "wheel.step").read_text(encoding="utf-8")
    assert step.count("PRODUCT('lattice','lattice'") == 1
    assert "lattice_joints" not in step


@pytest.mark.long
def test_honeycomb_repeats_itself_and_is_its_mirror_image(tmp_path: Path) -> None:
    """After 22.5 degrees the same load, none of it forwards; the solid model says what the section model says."""
    coarse = {'axial_size = "15 mm"': 'axial_size = "30 mm"', r'max_deflection = "[^"]*"': 'max_deflection = "1 mm"'}
    written(tmp_path, "honeycomb", COARSE | coarse)
    first, turned = (curve(tmp_path, "--model", "section", at=angle) for angle in ("0", "22.5"))
    assert first.load[-1] > 35.0
    np.testing.assert_allclose(turned.load, first.load, rtol=1e-5)  # measured: 3e-6
    assert np.all(np.abs(first.columns["force_forward_N"]) < 1e-6 * first.load.max())
    np.testing.assert_allclose(first.load[1:], curve(tmp_path).load[1:], rtol=0.01)


@pytest.mark.long
def test_tapered_leaves_lie_between_even_ones(tmp_path: Path) -> None:
    """Of the thickness at the rim, and of that at the hub; the solid model says what the section model says."""
    taper = r'thickness_middle = "0.5 mm".*\nthickness_hub = "0.8 mm".*\n'
    loads = {}
    for name, new in (("thin", ""), ("thick", 'thickness_hub = "0.8 mm"\nthickness_middle = "0.8 mm"\n')):
        even = {r'thickness = "0.5 mm"  ': 'thickness = "0.8 mm"  '} if name == "thick" else {}
        written(tmp_path, "leaves", COARSE | even | {taper: new})
        loads[name] = curve(tmp_path, "--model", "section").load[-1]
    written(tmp_path, "leaves", COARSE)
    section, solid = (curve(tmp_path, *options).load for options in (("--model", "section"), ()))
    assert 1.2 * loads["thin"] < section[-1] < 0.7 * loads["thick"]
    np.testing.assert_allclose(section[1:], solid[1:], rtol=0.02)


@pytest.mark.long
def test_a_tread_takes_part_of_the_deflection(tmp_path: Path) -> None:
    """The wheel with its tread is softer than that with a tread as stiff as steel; its energy is the ground's work."""
    coarse = {'element_size = "10 mm"': 'element_size = "16 mm"', 'axial_size = "25 mm"': 'axial_size = "50 mm"'}
    short = COARSE | coarse | {r"points = \d+": "points = 8"}
    written(tmp_path, "tread", short)
    rubber = curve(tmp_path)
    stored = rubber.columns["stored_energy_J"][-1]
    assert stored == pytest.approx(np.trapezoid(rubber.load, rubber.deflection), rel=0.02)
    written(tmp_path, "tread", short | {'width = "90 mm".*\nmaterial = "rubber"': 'material = "Ti-6Al-4V"'})
    text = (tmp_path / "study.toml").read_text(encoding="utf-8")
    begin, end = text.index("[materials.rubber]"), text.index("# --- Finite")
    without = re.sub(r'"materials.rubber.*\n', "", text[:begin] + text[end:])
    (tmp_path / "study.toml").write_text(without, encoding="utf-8")
    assert rubber.load[-1] < 0.9 * curve(tmp_path).load[-1]
