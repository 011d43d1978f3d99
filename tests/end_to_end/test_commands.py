"""The other commands, run as a user would run them."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import meshio
import pytest

from contracts.curves import read_curve
from contracts.footprint import read_footprint
from tests.end_to_end.small_study import run, said
from workbench.cli import _run
from workbench.execution.load_checks import CHECKS


def test_help_and_wrong_usage() -> None:
    shown = run("--help")
    assert shown.returncode == 0
    for name in ("report", "mesh", "stiffness", "compare", "doctor"):
        assert name in shown.stdout
    wrong = run("report", "--nonsense")
    assert wrong.returncode == 2
    assert "--nonsense" in wrong.stderr
    assert "Traceback" not in wrong.stderr
    assert run("paint").returncode == 2
    assert run("report", "--workers", "0").returncode == 2


def test_a_dry_run_lists_what_is_reused_and_what_is_not(
    workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    assert first_report.returncode == 0
    there = run("report", "study.toml", "--dry-run", "--store", "store", folder=workspace)
    rows = [line.split() for line in there.stdout.splitlines()]
    assert {row[0] for row in rows} == {"reuse"}
    assert {(workspace / "store" / key[:2] / key).is_dir() for _, _, key in rows} == {True}
    none = run("report", workspace / "study.toml", "--dry-run", "--store", "none", "--out", "out", folder=tmp_path)
    assert [line.split() for line in none.stdout.splitlines()] == [["compute", *row[1:]] for row in rows]
    assert list(tmp_path.iterdir()) == []
    (workspace / "colder.toml").write_text(
        (workspace / "study.toml").read_text(encoding="utf-8").replace('"-40 degC"', '"-41 degC"'), encoding="utf-8"
    )
    colder = run("report", "colder.toml", "--dry-run", "--store", "store", folder=workspace)
    changed = [line.split()[1] for line in colder.stdout.splitlines() if line.startswith("compute")]
    assert changed
    assert all(name.startswith("environment_") for name in changed)


def test_doctor_finds_what_the_tests_run_on() -> None:
    ended = run("doctor")
    assert ended.returncode == 0, ended.stdout
    for name in ("dolfinx-solver-real", "gmsh", "python"):
        assert name in ended.stdout
    assert "missing" not in ended.stdout
    for check in CHECKS:
        assert f"{check.name} " in ended.stdout


def test_mesh_writes_every_file(
    workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    ended = run("mesh", "study.toml", "--out", tmp_path, "--store", "store", folder=workspace)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr == ""
    assert "1 tasks computed, 2 reused" in ended.stdout
    names = {"wheel.msh", "wheel.vtu", "wheel.step", "wheel.png", "solved.msh", "solved.vtu", "summary.json"}
    assert {p.name for p in tmp_path.glob("[!.]*")} == names
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["wheel"]["quality"]["min_scaled_jacobian"] > 0.2
    mesh = meshio.read(tmp_path / "wheel.vtu")
    assert sum(len(block.data) for block in mesh.cells) == summary["wheel"]["quality"]["n_cells"]
    assert (tmp_path / "wheel.step").read_bytes().startswith(b"ISO-10303-21")
    assert (tmp_path / "wheel.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("model", ["ancf", "brush"])
def test_stiffness_of_the_quick_models(workspace: Path, tmp_path: Path, model: str) -> None:
    extra = ["--orientation", "10", "--orientation", "80"]
    ended = run(
        "stiffness", "study.toml", "--model", model, *extra, "--out", tmp_path, "--store", "store", folder=workspace
    )
    assert ended.returncode == 0, ended.stderr
    assert ("the same at every orientation" in ended.stderr) == (model == "brush")
    found = {p.name for p in (tmp_path / "curves").iterdir()}
    orientations = {"ancf_phi010.csv", "ancf_phi080.csv"} if model == "ancf" else set()
    assert found == {f"{model}_average.csv", *orientations}
    if model == "ancf":  # the tire is symmetric about its spokes: 10 and 80 deg are mirror images
        one, two = (read_curve(tmp_path / "curves" / name) for name in sorted(orientations))
        assert one.load == pytest.approx(two.load, rel=1e-6, abs=1e-6)


def test_stiffness_of_fe_reuses_the_report(
    workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    ended = run("stiffness", "study.toml", "--out", tmp_path, "--store", "store", folder=workspace)
    assert ended.returncode == 0, ended.stderr
    assert "0 tasks computed, 3 reused" in ended.stdout
    assert {p.name for p in (tmp_path / "curves").iterdir()} == {"fe_phi000.csv", "fe_average.csv"}
    (footprint,) = (tmp_path / "footprints").iterdir()
    pressed, curve = read_footprint(footprint), read_curve(tmp_path / "curves/fe_phi000.csv")
    assert curve.load[0] < pressed.load <= curve.load[-1]


@pytest.mark.parametrize("options", [("--out", ""), ("--out="), ("--store", " ")], ids=repr)
def test_an_empty_folder_is_not_the_current_one(
    options: tuple[str, ...] | str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    given = [options] if isinstance(options, str) else list(options)
    assert _run(["rover", "static", "--tire", "rigid", *given]) == 2
    assert f"{given[0].rstrip('=')} = '': is empty; name a folder" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--model", "magic"], "is not known"),
        (["--orientation", "nan"], "must be finite"),
        (["--orientation", "400"], "less than 360"),
        (["--orientation", "left"], "--orientation"),
    ],
)
def test_stiffness_refuses_bad_options(workspace: Path, tmp_path: Path, arguments: list[str], text: str) -> None:
    ended = said("stiffness", "study.toml", *arguments, "--out", tmp_path / "o", "--store", "store", folder=workspace)
    assert ended.returncode == 2
    assert text in ended.stderr
    assert "Traceback" not in ended.stderr
    assert not (tmp_path / "o").exists()


@pytest.mark.parametrize(("arguments", "name"), [(("report",), "series"), (("mesh",), "wheel.step")])
def test_what_stands_in_the_way_is_told_before_anything_is_computed(
    arguments: tuple[str, ...], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file where a folder belongs, a folder where a file belongs."""
    monkeypatch.setattr(f"workbench.commands.{arguments[0]}.computed", None)
    if name == "series":
        (tmp_path / name).write_text("mine", encoding="utf-8")
    else:
        (tmp_path / name).mkdir()
    ended = said(*arguments, "studies/first.toml", "--out", tmp_path, "--store", tmp_path / "store")
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
    assert f"{tmp_path / name}: is " in ended.stderr
