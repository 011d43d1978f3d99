"""Tasks that are quick enough to run whole: one ANCF orientation, the brush, metrics, mesh files."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from ancf_reduced.tire.preset import thesis_preset
from contracts.curves import StiffnessCurve, read_curve, write_curve
from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from reference_fe.wheel.case import FieldSnapshot
from workbench.execution.result_files import read_result, write_result
from workbench.questions.ancf import task as ancf
from workbench.questions.fe.field_file import read_points, write_fields, write_points
from workbench.questions.models import brush_task as brush
from workbench.questions.models import metrics_task as metrics
from workbench.questions.wheel.mesh_file import read_mesh, write_mesh


def _ignore(fraction: float) -> None:
    assert 0.0 <= fraction <= 1.0


def test_ancf_task_writes_the_curve_of_the_preset(tmp_path: Path) -> None:
    inputs = {"preset": asdict(thesis_preset()), "orientation_deg": 45.0, "deflections": [0.0, 0.005, 0.02]}
    inputs["preset"]["contact_points"] = list(inputs["preset"]["contact_points"])  # as JSON brings it back
    dofs = ancf.solve_orientation(inputs, {}, tmp_path, _ignore)
    assert dofs == 96
    curve = read_curve(tmp_path / "curve.csv")
    assert float(curve.load_at(0.02)) == pytest.approx(137.7, abs=0.1)
    assert read_result(tmp_path)["flexible_mass_kg"] == pytest.approx(4.43, abs=0.005)


def test_brush_task_writes_the_line(tmp_path: Path) -> None:
    brush.solve({"radial_stiffness": 9000.0, "max_deflection": 0.036}, {}, tmp_path, _ignore)
    assert float(read_curve(tmp_path / "curve.csv").load_at(0.02)) == pytest.approx(180.0)


def _folder(tmp_path: Path, name: str, slope: float) -> Path:
    folder = tmp_path / name
    folder.mkdir()
    d = np.linspace(0.0, 0.036, 19)
    write_curve(StiffnessCurve(model="m", orientation_deg=None, deflection=d, load=slope * d), folder / "curve.csv")
    write_result(folder, {})
    return folder


def test_metrics_task_pairs_models_and_user_curves(tmp_path: Path) -> None:
    slopes = {"fe_phi000": 9000.0, "fe_phi045": 7000.0, "ancf_phi045": 7700.0, "brush": 8000.0}
    needs = {name: _folder(tmp_path, name, slope) for name, slope in slopes.items()}
    text = "deflection_m,load_N\n0,0\n0.036,252\n"
    user = {"text": text, "label": "mine", "orientation": 45.0}
    metrics.measure(
        {"max_load": 250.0, "user_curves": [user], "around": {"period": 30.0, "mirrored": True}},
        needs,
        tmp_path,
        _ignore,
    )
    numbers = read_result(tmp_path)
    assert set(numbers) == {"ancf_average", "brush", "ancf_phi45", "user_0"}
    assert numbers["brush"]["relative_l2"] == pytest.approx(0.0, abs=1e-12)
    assert numbers["ancf_phi45"]["relative_l2"] == pytest.approx(0.1)
    assert numbers["user_0"]["relative_l2"] == pytest.approx(0.0, abs=1e-12)
    assert numbers["brush"]["end"] == pytest.approx(250.0 / 8000.0)


def test_metrics_task_refuses_a_user_orientation_nobody_computed(tmp_path: Path) -> None:
    needs = {name: _folder(tmp_path, name, 8000.0) for name in ("fe_phi000", "ancf_phi000", "brush")}
    user = {"text": "deflection_m,load_N\n0,0\n0.03,240\n", "label": "mine", "orientation": 30.0}
    with pytest.raises(InputError, match="30 deg"):
        metrics.measure(
            {"max_load": 250.0, "user_curves": [user], "around": {"period": 30.0, "mirrored": True}},
            needs,
            tmp_path,
            _ignore,
        )


def _cube() -> TaggedMesh:
    corners = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=np.float64)
    return TaggedMesh(
        points=corners * math.pi,
        cells=np.arange(8, dtype=np.int64)[None],
        cell_tags=np.array([3], dtype=np.int32),
        facets=np.array([[0, 3, 2, 1]], dtype=np.int64),
        facet_tags=np.array([2], dtype=np.int32),
        parts={"tire": 3},
        faces={"tire_outer": 2},
    )


def test_fields_open_in_other_programs(tmp_path: Path) -> None:
    mesh = _cube()
    displacement, stress = 0.1 * mesh.points, np.arange(8.0)
    write_fields(mesh, displacement, stress, tmp_path / "fields.vtu")
    found = meshio.read(tmp_path / "fields.vtu")
    assert np.array_equal(found.points, mesh.points)
    assert np.array_equal(found.point_data["displacement_m"], displacement)
    assert np.array_equal(found.point_data["von_mises_Pa"].ravel(), stress)
    assert [(block.type, len(block.data)) for block in found.cells] == [("hexahedron", 1)]
    assert "principal_stress_Pa" not in found.point_data
    principal = np.stack([stress, -stress, -2.0 * stress], axis=1)
    write_fields(mesh, displacement, stress, tmp_path / "fields.vtu", principal)
    kept = meshio.read(tmp_path / "fields.vtu").point_data["principal_stress_Pa"]
    assert kept.dtype == np.float32
    np.testing.assert_array_equal(kept, principal)


def test_fields_along_a_curve_survive_the_file(tmp_path: Path) -> None:
    field = FieldSnapshot(load=12.5, deflection=0.01, displacement=0.1 * _cube().points, von_mises=np.arange(8.0))
    path = tmp_path / "points.npz"
    write_points([field, replace(field, load=25.0)], path)
    first, second = read_points(path)
    assert (first[0], second[0]) == (12.5, 25.0)
    np.testing.assert_allclose(first[1], field.displacement, rtol=1e-6)
    np.testing.assert_array_equal(first[2], field.von_mises)
    whole = path.read_bytes()
    for damaged in (b"", whole[: len(whole) // 2], b"text"):
        path.write_bytes(damaged)
        with pytest.raises(InputError, match=r"points\.npz: cannot be read"):
            list(read_points(path))
    np.savez(path, allow_pickle=False, load=[1.0], displacement=np.zeros((2, 8, 3)), von_mises=np.zeros((1, 8)))
    with pytest.raises(InputError, match="must hold finite fields of nodes at each load"):
        list(read_points(path))


def test_a_mesh_survives_the_file(tmp_path: Path) -> None:
    mesh = _cube()
    write_mesh(mesh, tmp_path / "mesh.npz")
    again = read_mesh(tmp_path / "mesh.npz")
    assert again.hash() == mesh.hash()
    assert (dict(again.parts), dict(again.faces)) == ({"tire": 3}, {"tire_outer": 2})
