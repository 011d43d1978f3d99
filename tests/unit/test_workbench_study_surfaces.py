"""A study whose ANCF tire comes from a STEP file: plates as inputs of its tasks, messages, files that move along."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.plates.spline_plates import plate_surfaces
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import stiffness_curve
from contracts.curves import read_curve
from contracts.errors import StudyError
from geometry.surface_step import write_surfaces_step
from workbench.execution.task import Task
from workbench.questions.ancf.task import solve_orientation
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.study_graph import report_tasks
from workbench.study.ancf_tire import tire_from, tire_values
from workbench.study.model import Study
from workbench.study.model_parameters import ancf_mesh, ancf_preset
from workbench.study.reading import built_in_study, read_study
from workbench.study.rewrite import rewritten_study, rewritten_table

TIRE = build_tire(thesis_preset())
SURFACES = plate_surfaces(TIRE.mesh, TIRE.mesh.reference_coordinates())


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The thesis' tire as a STEP file."""
    path = tmp_path_factory.mktemp("exported") / "tire.step"
    write_surfaces_step(SURFACES, path)
    return path


def study_text(*more: str) -> str:
    text = built_in_study().read_text(encoding="utf-8")
    return text.replace("[ancf]\n", "\n".join(["[ancf]", *more, ""]), 1)


def study_in(folder: Path, step: str, *more: str) -> Study:
    """The built-in study with ``surfaces`` that hold the text of a STEP file, in a folder of their own."""
    (folder / "cad").mkdir(exist_ok=True)
    (folder / "cad" / "tire.step").write_text(step, encoding="utf-8")
    (folder / "study.toml").write_text(study_text('surfaces = "cad/tire.step"', *more), encoding="utf-8")
    return read_study(folder / "study.toml")


def first_task(study: Study) -> Task:
    (task,) = stiffness_tasks(study, "ancf", [45.0])
    return task


def test_the_path_is_relative_to_the_study(exported: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path.parent)
    study = study_in(tmp_path, exported.read_text(encoding="utf-8"))
    mesh = ancf_mesh(study)
    assert mesh is not None
    np.testing.assert_allclose(mesh.points, TIRE.mesh.points, atol=1e-12)
    assert ancf_mesh(read_study(built_in_study())) is None


def test_the_curve_is_that_of_the_preset(exported: Path, tmp_path: Path) -> None:
    """Through the task, its inputs as the worker gets them: to 1e-9 of the largest load."""
    inputs = json.loads(json.dumps(first_task(study_in(tmp_path, exported.read_text(encoding="utf-8"))).inputs))
    deflections = [0.0, 0.005, 0.01, 0.02]
    solve_orientation(inputs | {"deflections": deflections}, {}, tmp_path, lambda fraction: None)
    found, wanted = read_curve(tmp_path / "curve.csv"), stiffness_curve(thesis_preset(), np.pi / 4, deflections)
    np.testing.assert_allclose(found.load, wanted.load, atol=1e-9 * wanted.load.max())
    assert wanted.load.max() > 100.0
    assert found.source == wanted.source


def test_the_surfaces_are_part_of_the_key_and_the_file_s_date_is_not(exported: Path, tmp_path: Path) -> None:
    text = exported.read_text(encoding="utf-8")
    key = first_task(study_in(tmp_path, text)).key({})
    dated = text.replace("FILE_NAME(", "/* written again */ FILE_NAME(", 1)
    assert first_task(study_in(tmp_path, dated)).key({}) == key
    higher = [replace(s, control_points=s.control_points * [1.0, 1.0, 1.0 + 1e-6]) for s in SURFACES]
    write_surfaces_step(higher, tmp_path / "cad" / "tire.step")
    assert first_task(read_study(tmp_path / "study.toml")).key({}) != key
    assert first_task(read_study(built_in_study())).key({}) != key


def test_every_task_of_the_study_s_own_tire_has_its_plates(exported: Path, tmp_path: Path) -> None:
    """Curves, surfaces, comparison with the FE and motions; the refinement of a parametric tire is left out."""
    study = study_in(tmp_path, exported.read_text(encoding="utf-8"))
    tasks = {task.name: task for task in report_tasks(study)}
    own = ("ancf_phi000", "ancf_phi045", "ancf_surfaces", "ancf_as_it_is", "ancf_drop", "ancf_drop_share", "ancf_ride")
    assert all("plates" in tasks[name].inputs for name in own)
    assert not [name for name in tasks if name.startswith("ancf_plates_x")]
    presets = [n for n, t in tasks.items() if "preset" in t.inputs and "plates" not in t.inputs]
    presets = [name for name in presets if not name.startswith("words_")]  # tires that the thesis' text allows
    assert sorted(presets) == ["ancf_fit_four_spokes", "ancf_fit_six_spokes"]


def test_a_tire_survives_as_inputs() -> None:
    back = tire_from(json.loads(json.dumps(tire_values(TIRE.preset, TIRE.mesh))))
    for name in ("points", "elements", "gradients", "dimensions"):
        np.testing.assert_array_equal(getattr(back.mesh, name), getattr(TIRE.mesh, name))
    assert (back.preset, back.mesh.parts) == (TIRE.preset, TIRE.mesh.parts)
    assert tire_values(TIRE.preset, None) == {"preset": asdict(TIRE.preset)}


BAD = {
    "no file": (None, (), "ancf.surfaces = cad/tire.step: does not exist"),
    "not STEP": ("solid tire", (), "ancf.surfaces = cad/tire.step: does not begin with ISO-10303-21"),
    "another size": (
        "exported",
        ('outer_radius = "150 mm"',),
        "outer radius of the surfaces = 142.5 mm: must be 150 mm",
    ),
    "other plates": ("exported", ("circumferential_plates = 8",), "rim plates of the surfaces = 4: must be 8"),
    "a phase": ("exported", ('phase = "10 deg"',), "ancf.phase = 10 deg: must be 0 with surfaces"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_files_are_one_message(case: str, exported: Path, tmp_path: Path) -> None:
    step, keys, text = BAD[case]
    changed = study_text('surfaces = "cad/tire.step"')
    for key in keys:
        name = key.partition(" ")[0]
        head, table, rest = changed.partition("[ancf]\n")
        lines = rest.splitlines(keepends=True)
        end = next(i for i, line in enumerate(lines) if line.startswith("["))
        kept = [line for i, line in enumerate(lines) if i > end or not line.startswith(f"{name} =")]
        changed = head + table + f"{key}\n" + "".join(kept)
    (tmp_path / "cad").mkdir()
    if step is not None:
        content = exported.read_text(encoding="utf-8") if step == "exported" else step
        (tmp_path / "cad" / "tire.step").write_text(content, encoding="utf-8")
    (tmp_path / "study.toml").write_text(changed, encoding="utf-8")
    with pytest.raises(StudyError) as found:
        read_study(tmp_path / "study.toml")
    assert text in str(found.value)
    assert str(found.value).startswith(f"{tmp_path / 'study.toml'}: ancf")
    assert "\n" not in str(found.value)


def test_a_rewritten_study_finds_the_file_or_leaves_it_out(exported: Path, tmp_path: Path) -> None:
    """Calibrated thicknesses: the same surfaces from another folder. A fitted tire in [ancf] is not the file's."""
    study_in(tmp_path, exported.read_text(encoding="utf-8"))
    text = rewritten_study((tmp_path / "study.toml").read_text(encoding="utf-8"), {}, "a note", tmp_path)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "study.toml").write_text(text, encoding="utf-8")
    study = read_study(tmp_path / "elsewhere" / "study.toml")
    assert study.ancf.surfaces == str(tmp_path / "cad" / "tire.step")
    (tmp_path / "fitted.toml").write_text(rewritten_table(text, "ancf", {}, without=["surfaces"]), encoding="utf-8")
    fitted = read_study(tmp_path / "fitted.toml")
    assert fitted.ancf.surfaces is None
    assert ancf_preset(fitted) == ancf_preset(study)
