"""The ANCF tire's surfaces as a user gets them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from geometry.step_surfaces import read_surfaces_step
from geometry.surface_step import write_surfaces_step
from tests.end_to_end.small_study import run, small_study_text


def test_mesh_of_the_ancf_tire(workspace: Path, tmp_path: Path) -> None:
    """Unloaded and at two deflections; a second run reuses the first."""
    options = ["--model", "ancf", "--orientation", "45", "--deflection", "5 mm", "--deflection", "10 mm"]
    for _ in range(2):
        ended = run("mesh", "study.toml", *options, "--out", tmp_path, "--store", "store", folder=workspace)
        assert ended.returncode == 0, ended.stderr
        assert ended.stdout.count("nm off at most") == 3
    assert "computed" not in ended.stdout
    assert {p.name for p in tmp_path.glob("[!.]*")} == {"ancf.step", "ancf_phi045_5mm.step", "ancf_phi045_10mm.step"}
    assert (tmp_path / "ancf.step").read_bytes().startswith(b"ISO-10303-21")


@pytest.mark.long
def test_a_tire_from_its_own_step_file_gives_its_own_curve(workspace: Path, tmp_path: Path) -> None:
    """What `workbench mesh` writes is what a study may read; a changed file is computed again, an unchanged one not."""
    store = ("--store", tmp_path / "store")
    ended = run("mesh", "study.toml", "--model", "ancf", "--out", tmp_path, *store, folder=workspace)
    assert ended.returncode == 0, ended.stderr
    text = small_study_text().replace("[ancf]\n", '[ancf]\nsurfaces = "ancf.step"\n')
    (tmp_path / "drawn.toml").write_text(text, encoding="utf-8")
    curve = ("--model", "ancf", "--orientation", "45", *store)
    for study, out in ((workspace / "study.toml", "own"), ("drawn.toml", "drawn")):
        ended = run("stiffness", study, *curve, "--out", out, folder=tmp_path)
        assert ended.returncode == 0, ended.stderr
        assert "1 tasks computed, 0 reused" in ended.stdout
    own, drawn = (read_curve(tmp_path / out / "curves" / "ancf_phi045.csv") for out in ("own", "drawn"))
    np.testing.assert_array_equal(drawn.deflection, own.deflection)
    np.testing.assert_allclose(drawn.load, own.load, atol=1e-9 * own.load.max())
    assert own.load.max() > 100.0
    ended = run("stiffness", "drawn.toml", *curve, "--out", "drawn", folder=tmp_path)
    assert "0 tasks computed, 1 reused" in ended.stdout
    surfaces = read_surfaces_step(tmp_path / "ancf.step")
    wider = [replace(s, control_points=s.control_points * [1.0, 1.001, 1.0]) for s in surfaces]
    write_surfaces_step(wider, tmp_path / "ancf.step")
    ended = run("stiffness", "drawn.toml", *curve, "--out", "wider", folder=tmp_path)
    assert "1 tasks computed, 0 reused" in ended.stdout
    wide = read_curve(tmp_path / "wider" / "curves" / "ancf_phi045.csv")
    assert np.abs(wide.load - own.load).max() > 1e-5 * own.load.max()


def test_a_step_file_that_makes_no_tire_is_one_message(workspace: Path, tmp_path: Path) -> None:
    (tmp_path / "drawn.toml").write_text(
        small_study_text().replace("[ancf]\n", '[ancf]\nsurfaces = "none.step"\n'), encoding="utf-8"
    )
    ended = run("stiffness", "drawn.toml", "--model", "ancf", "--out", tmp_path / "new", folder=tmp_path)
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
    assert "drawn.toml: ancf.surfaces = none.step: does not exist; check its path" in ended.stderr
    assert not (tmp_path / "new").exists()


def test_a_deflection_out_of_reach_is_refused(workspace: Path, tmp_path: Path) -> None:
    ended = run(
        *("mesh", "study.toml", "--model", "ancf", "--deflection", "200 mm"),
        *("--out", tmp_path / "new", "--store", "store"),
        folder=workspace,
    )
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
    assert "the plane would reach the hub" in ended.stderr
    assert not (tmp_path / "new").exists()
