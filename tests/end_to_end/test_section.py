"""The planar model, run as a user would run it."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import run


def test_stiffness_of_the_section_model(workspace: Path, tmp_path: Path) -> None:
    ended = run(
        *("stiffness", "study.toml", "--model", "section", "--orientation", "0", "--orientation", "20"),
        *("--out", tmp_path, "--store", tmp_path / "store"),
        folder=workspace,
    )
    assert ended.returncode == 0, ended.stderr
    names = {"section_phi000.csv", "section_phi020.csv", "section_average.csv"}
    assert {p.name for p in (tmp_path / "curves").iterdir()} == names
    curve = read_curve(tmp_path / "curves" / "section_phi000.csv")
    assert "planar" in curve.source
    assert curve.load[-1] > 10.0
    assert curve.columns["force_imbalance"] == pytest.approx(0.0, abs=1e-6)


def test_a_law_without_planar_form_is_refused(workspace: Path, tmp_path: Path) -> None:
    text = (workspace / "study.toml").read_text(encoding="utf-8")
    changed = text.replace('material_law = "st_venant_kirchhoff"', 'material_law = "neo_hookean"')
    (tmp_path / "neo.toml").write_text(changed, encoding="utf-8")
    ended = run("stiffness", "neo.toml", "--model", "section", "--out", "o", "--store", "s", folder=tmp_path)
    assert ended.returncode == 2
    assert "no planar form" in ended.stderr
    assert "Traceback" not in ended.stderr
