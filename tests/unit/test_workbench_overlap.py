"""The gate on overlap of parts: what the task finds in a folder's fields, and what the check says of it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from contracts.mesh import TaggedMesh
from reference_fe.verification.structured_hexahedra import block_mesh, stacked
from reference_fe.wheel.pressed import FieldSnapshot
from workbench.questions.fe.checks import parts_overlap_check
from workbench.questions.fe.field_file import POINTS_FILE, write_points
from workbench.questions.fe.overlap_task import measure
from workbench.questions.fe.results import PartsDepth
from workbench.questions.wheel.mesh_file import MESH, write_mesh

THIN = np.array([0.1, 0.08, 0.002])


def _strips() -> TaggedMesh:
    """Two strips, the upper one 1 mm above the lower."""
    low = block_mesh((3, 2, 1), lambda X: X * THIN)
    return stacked(low, block_mesh((2, 3, 1), lambda X: X * THIN + [0.0, 0.0, 0.003]), "lid")


def _curve(mesh: TaggedMesh, folder: Path, sinks: tuple[float, ...]) -> Path:
    """A curve's folder with fields of the upper strip lowered by each of ``sinks`` [m]."""
    points = []
    for k, sink in enumerate(sinks):
        moved = np.zeros_like(mesh.points)
        moved[np.unique(mesh.cells[mesh.cell_tags == 2]), 2] = -sink
        stress = np.zeros(len(moved))
        points.append(FieldSnapshot(load=100.0 * k, deflection=0.01 * k, displacement=moved, von_mises=stress))
    folder.mkdir()
    write_points(points, folder / POINTS_FILE)
    return folder


def test_the_last_point_of_each_curve_is_measured(tmp_path: Path) -> None:
    mesh = _strips()
    (tmp_path / "mesh").mkdir()
    write_mesh(mesh, tmp_path / "mesh" / MESH)
    (tmp_path / "none").mkdir()
    needs = {
        "mesh": tmp_path / "mesh",
        "fe_phi000": _curve(mesh, tmp_path / "a", (0.0, 0.0011, 0.0)),
        "fe_phi015": _curve(mesh, tmp_path / "b", (0.0, 0.00112)),
        "fe_phi030": tmp_path / "none",
    }
    (tmp_path / "out").mkdir()
    measure({"mesh": "mesh"}, needs, tmp_path / "out", lambda share: None)
    found = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert set(found) == {"fe_phi000", "fe_phi015"}
    assert (found["fe_phi000"]["load_N"], found["fe_phi000"]["depth"]) == (200.0, 0.0)
    assert found["fe_phi015"]["depth"] == pytest.approx(0.12e-3, rel=1e-4)


@pytest.mark.parametrize(("depth", "status"), [(0.0, "pass"), (49e-6, "pass"), (51e-6, "fail")])
def test_the_deepest_overlap_decides(depth: float, status: str) -> None:
    parts = ("springs_outer", "tire")
    found = {
        "fe_phi000": PartsDepth(load=200.0, depth=0.0, parts=("", "")),
        "fe_phi015": PartsDepth(load=250.0, depth=depth, parts=parts),
    }
    check = parts_overlap_check(found, inner_contact=True)
    assert (check.role, check.status, check.value) == ("gate", status, depth)
    assert ("springs_outer in tire, 250 N" in check.title) is (depth > 0.0)
    assert parts_overlap_check(found, inner_contact=False).role == "finding"


def test_no_curve_is_an_error() -> None:
    assert parts_overlap_check({}, inner_contact=True).status == "error"
