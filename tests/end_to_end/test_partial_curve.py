"""A curve that ends early: everything is written, marked partial wherever it appears, and the exit status is 2.

First a solve that really does not converge. Then the report of the small study, from a store in which its curve was cut
off.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.curves import read_curve
from contracts.materials import TI_6AL_4V
from contracts.mesh import TaggedMesh
from reference_fe.verification.structured_hexahedra import block_mesh
from tests.end_to_end.small_study import both_pages, run
from tests.unit.test_workbench_runner import Recorder
from workbench.execution.fingerprint import file_sha256
from workbench.execution.integrity import sealed, unsealed
from workbench.execution.result_files import FAILURE, read_result, write_result
from workbench.execution.runner import run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Progress, Task
from workbench.questions.fe.graph import material_inputs
from workbench.questions.fe.task import solve_orientation
from workbench.questions.wheel.mesh_file import MESH, write_mesh

REASON = "orientation 0 deg, curve reached 3 mm: a made-up reason; try another wheel"

type Finished = subprocess.CompletedProcess[str]


def _column() -> TaggedMesh:
    """A column of titanium, 80 mm high, under a rigid hub: a wheel as far as the solver is concerned."""
    block = block_mesh((1, 1, 5), lambda x: (x - np.array([0.5, 0.5, 1.0])) * np.array([0.05, 0.05, 0.1]))
    tags = np.array([1, 1, 1, 1, 2], dtype=np.int32)
    faces = {"tire_outer": block.faces["z0"], **{name: tag for name, tag in block.faces.items() if name != "z0"}}
    return replace(block, cell_tags=tags, parts={"tire": 1, "outer_hub": 2}, faces=faces)


def _inputs(end: float) -> dict[str, Any]:
    return {
        "orientation_deg": 0.0,
        "deflections": [0.004, end],
        "max_load": 1e12,
        "snapshot_loads": [],
        "keep_points": False,
        "material_law": "st_venant_kirchhoff",
        "contact_stiffness": 1e15,
        "contact_method": "penalty",
        "friction": 0.0,
        "obstacle": {"shape": "plane"},
        "camber_deg": 0.0,
        "inner_contact": False,
        "inner_contact_stiffness": 1e11,
        "relative_tolerance": 1e-8,
        "rigid_parts": ["outer_hub"],
        "materials": material_inputs({"tire": TI_6AL_4V}),
    }


def _solve(folder: Path, end: float) -> dict[str, Any]:
    """Result of the task that presses the column by ``end`` [m], run by a worker."""
    (folder / "mesh").mkdir()
    write_mesh(_column(), folder / "mesh" / MESH)
    task = Task(name="fe_phi000", function=f"{__name__}:press", inputs={"mesh": str(folder / "mesh")} | _inputs(end))
    entry = run_tasks([task], Store(folder / "store"), Recorder())["fe_phi000"]
    shutil.copyfile(entry.path / "curve.csv", folder / "curve.csv")
    return read_result(entry.path)


def press(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """The task of the report, with a mesh of our own."""
    return solve_orientation(inputs, {"mesh": Path(inputs["mesh"])}, out, progress)


def test_a_solve_that_does_not_converge_leaves_its_partial_curve_and_the_reason(tmp_path: Path) -> None:
    """St. Venant-Kirchhoff material cannot be pressed below a stretch of 0.577: 34 mm of the column's 80 mm."""
    result = _solve(tmp_path, end=0.060)
    assert re.match(
        r"orientation 0 deg, curve reached \d\S* mm at \S+ N: the increment to control \S+ ", result[FAILURE]
    )
    assert "; try " in result[FAILURE]
    assert sum(not record["converged"] for record in result["increments"]) > 5
    curve = read_curve(tmp_path / "curve.csv")
    assert curve.partial
    assert "# partial: True" in (tmp_path / "curve.csv").read_text(encoding="utf-8")
    assert 0.02 < curve.deflection[-1] < 0.036


def test_a_solve_that_converges_leaves_neither(tmp_path: Path) -> None:
    """Negative control: the same column pressed by 8 mm."""
    assert _solve(tmp_path, end=0.008)[FAILURE] is None
    assert not read_curve(tmp_path / "curve.csv").partial


@pytest.fixture(scope="module")
def cut_off(workspace: Path, first_report: Finished, tmp_path_factory: pytest.TempPathFactory) -> tuple[Finished, Path]:
    """A second report of the small study, whose stored curve lost its last point; and its folder."""
    folder = tmp_path_factory.mktemp("cut")
    shutil.copytree(workspace / "store", folder / "store")
    for manifest in (folder / "store").glob("??/*/manifest.json"):
        record = unsealed(manifest.read_text(encoding="utf-8"))
        assert record is not None
        if record["task"] in ("metrics", "pictures"):
            shutil.rmtree(manifest.parent)
        if record["task"] == "fe_phi000":
            _cut(manifest.parent, record)
    arguments = ("report", workspace / "study.toml", "--out", "report", "--store", "store")
    return run(*arguments, folder=folder), folder / "report"


def _cut(entry: Path, record: dict[str, object]) -> None:
    """Turn a stored run into one that ended early."""
    source, *rows = (entry / "curve.csv").read_text(encoding="utf-8").splitlines()
    (entry / "curve.csv").write_text("\n".join([source, "# partial: True", *rows[:-1], ""]), encoding="utf-8")
    write_result(entry, read_result(entry) | {FAILURE: REASON})
    names = record["files"]
    assert isinstance(names, dict)
    record["files"] = {name: file_sha256(entry / name) for name in names}
    record["sizes"] = {name: (entry / name).stat().st_size for name in names}
    (entry / "manifest.json").write_text(sealed(record), encoding="utf-8")


def test_the_report_is_written_and_then_complains(cut_off: tuple[Finished, Path]) -> None:
    done, folder = cut_off
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert f"fe_phi000 did not converge, its curve is partial: {REASON}" in line
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "error"
    assert summary["provenance"]["partial"] == {"fe_phi000": REASON}
    (complete,) = [c for c in summary["checks"] if c["id"] == "fe.complete"]
    assert (complete["status"], complete["value"]) == ("error", 1.0)
    assert "fe_phi000" in complete["title"]


def test_the_curve_is_marked_partial_everywhere(cut_off: tuple[Finished, Path]) -> None:
    _, folder = cut_off
    for name in ("fe_phi000", "fe_average"):
        assert read_curve(folder / "curves" / f"{name}.csv").partial
    assert not read_curve(folder / "curves" / "ancf_average.csv").partial
    page = both_pages(folder)
    assert re.search(r"mm, \d+ N \(partial\)</td>", page)
    assert f"<b>fe_phi000 is partial.</b> {REASON}" in page
    assert page.count("FE average (partial)") >= 3  # two figures and the table of distances
    assert "ANCF average (partial)" not in page


def test_the_small_study_itself_is_complete(first_report: Finished, workspace: Path) -> None:
    """Negative control: before the cut nothing is marked."""
    assert first_report.returncode == 0
    assert "(partial)" not in both_pages(workspace / "report")
    summary = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    assert summary["provenance"]["partial"] == {}
