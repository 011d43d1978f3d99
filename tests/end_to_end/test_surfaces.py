"""The ANCF tire's surfaces as a user gets them."""

from __future__ import annotations

from pathlib import Path

from tests.end_to_end.small_study import run


def test_mesh_of_the_ancf_tire(workspace: Path, tmp_path: Path) -> None:
    """Unloaded and at two deflections; a second run reuses the first."""
    options = ["--model", "ancf", "--orientation", "45", "--deflection", "5 mm", "--deflection", "10 mm"]
    for _ in range(2):
        ended = run("mesh", "study.toml", *options, "--out", tmp_path, "--store", "store", folder=workspace)
        assert ended.returncode == 0, ended.stderr
        assert ended.stdout.count("nm off at most") == 3
    assert "computed" not in ended.stdout
    assert {p.name for p in tmp_path.iterdir()} == {"ancf.step", "ancf_phi045_5mm.step", "ancf_phi045_10mm.step"}
    assert (tmp_path / "ancf.step").read_bytes().startswith(b"ISO-10303-21")


def test_a_deflection_out_of_reach_is_refused(workspace: Path, tmp_path: Path) -> None:
    ended = run(
        *("mesh", "study.toml", "--model", "ancf", "--deflection", "200 mm"),
        *("--out", tmp_path / "new", "--store", "store"),
        folder=workspace,
    )
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
    assert "the plane would reach the hub" in ended.stderr
    assert not (tmp_path / "new").exists()
