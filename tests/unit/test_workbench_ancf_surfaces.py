"""The task that writes the ANCF tire's surfaces, its options and its check."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError
from workbench.commands.mesh import deflections_si, run_mesh_of
from workbench.execution.result_files import read_result
from workbench.questions.ancf.question import report_surfaces_task, surfaces_check, surfaces_task
from workbench.questions.ancf.surfaces_task import read_back_deviation, write_surfaces
from workbench.study.reading import built_in_study, read_study
from workbench.study.sections import ToleranceSection


def _ignore(fraction: float) -> None:
    assert 0.0 <= fraction <= 1.0


def test_files_are_written_and_read_back(tmp_path: Path) -> None:
    """To 1e-9 m; the measure sees a tire moved by 1 micrometre (negative control)."""
    inputs = {"preset": asdict(thesis_preset()), "orientation_deg": 20.0, "deflections": [0.002, 0.005]}
    inputs["preset"]["quadrature"] = list(inputs["preset"]["quadrature"])  # as JSON brings it back
    assert write_surfaces(inputs, {}, tmp_path, _ignore) == 96
    result = read_result(tmp_path)
    names = {"ancf", "ancf_phi020_2mm", "ancf_phi020_5mm"}
    assert {p.stem for p in tmp_path.glob("*.step")} == set(result["read_back_m"]) == names
    assert result["surfaces"] == 24
    assert 0.0 < max(result["read_back_m"].values()) < 1e-9
    mesh = build_tire(thesis_preset()).mesh
    moved = mesh.reference_coordinates()
    moved[:, 0, 2] += 1e-6
    assert read_back_deviation(mesh, moved, tmp_path / "ancf.step") == pytest.approx(1e-6, rel=1e-3)


def test_the_check_passes_and_fails() -> None:
    assert surfaces_check(lambda: 2e-13, ToleranceSection()).status == "pass"
    failed = surfaces_check(lambda: 2e-12, ToleranceSection())
    assert (failed.status, failed.role, failed.value) == ("fail", "gate", 2e-12)


def test_deflections_are_lengths_in_order() -> None:
    assert deflections_si(["10 mm", "0.5 cm", "10 mm"]) == (0.005, 0.01)
    for text in ("10", "-1 mm", "0 mm", "5 N", "soft"):
        with pytest.raises(InputError, match="deflection"):
            deflections_si([text])


def test_the_report_takes_ten_millimetres_or_what_the_study_reaches() -> None:
    study = read_study(built_in_study())
    assert report_surfaces_task(study).inputs["deflections"] == [0.01]
    short = study.model_copy(update={"ancf": study.ancf.model_copy(update={"max_deflection": 0.006})})
    assert report_surfaces_task(short).inputs["deflections"] == [0.006]
    assert surfaces_task(study, 30.0, ()).inputs["orientation_deg"] == 30.0


@pytest.mark.parametrize(
    ("model", "orientation", "deflections", "text"),
    [
        ("brush", 0.0, (), "is not known"),
        ("ancf", np.nan, (), "must be finite"),
        ("ancf", 0.0, ("soft",), "deflection"),
        ("fe", 0.0, ("10 mm",), "add --model ancf"),
    ],
)
def test_bad_options_are_refused(
    model: str, orientation: float, deflections: tuple[str, ...], text: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=text):
        run_mesh_of(built_in_study(), model, orientation, deflections, tmp_path / "out", tmp_path / "store")
    assert not (tmp_path / "out").exists()
