"""Bad input: one message on stderr with file, key, value and rule, exit status 2, earlier results untouched."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, said, small_study_text

THICKNESS = r'thickness = "[^"]*"'
OUTER_HUB = r'outer_radius = "31.24 mm"'
POINTS = r"points = \[\[0\.33.*\]\]"
SPLINE = 'points = [[0.5, "70 deg"], [0.95, "100 deg"]]'

BAD: dict[str, tuple[str, str, list[str]]] = {
    "negative thickness": (THICKNESS, 'thickness = "-0.6 mm"', ["wheel.tire.thickness = '-0.6 mm'", "greater than 0"]),
    "zero thickness": (THICKNESS, 'thickness = "0 mm"', ["wheel.tire.thickness = '0 mm'", "greater than 0"]),
    "wrong unit": (THICKNESS, 'thickness = "0.6 kg"', ["wheel.tire.thickness = '0.6 kg'", "must be a length"]),
    "unknown key": (THICKNESS, 'thicknes = "0.6 mm"', ["wheel.tire.thicknes = '0.6 mm'", "not a known key"]),
    "hub larger than rim": (OUTER_HUB, 'outer_radius = "150 mm"', ["wheel.outer_hub.outer_radius", "smaller than"]),
    "springs cross the hub": (POINTS, SPLINE, ["wheel.springs[0].points", "crosses the hub"]),
    "springs overlap": ("count = 6", "count = 90", ["wheel.springs[0].weld_length = 12 mm", "smaller than"]),
    "orientation nan": (r'orientations = \["0 deg"\]', "orientations = [nan]", ["fe.orientations[0] = nan", "finite"]),
    "decimal comma": (THICKNESS, 'thickness = "0,6 mm"', ["wheel.tire.thickness = '0,6 mm'", "not a comma"]),
    "towers of powers": (THICKNESS, 'thickness = "9**9**9 mm"', ["wheel.tire.thickness", "without arithmetic"]),
    "deflection to the hub": (r'max_deflection = "6 mm"', 'max_deflection = "119 mm"', ["fe.max_deflection", "gap"]),
    "not toml": ('name = "exomars"', "name = exomars", ["not valid TOML"]),
    "empty": (r"(?s).*", "", ["is empty"]),
}


def _snapshot(folder: Path) -> dict[str, tuple[int, bytes]]:
    return {str(p): (p.stat().st_mtime_ns, p.read_bytes()) for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture(scope="module")
def earlier(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with results of an earlier run."""
    folder = tmp_path_factory.mktemp("earlier")
    for name in (
        "report/summary.json",
        "report/report.html",
        "report/evidence.html",
        "report/curves/fe_phi000.csv",
        f"store/ab/{'ab' * 32}/manifest.json",
    ):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("earlier result", encoding="utf-8")
    return folder


def _assert_refused(
    earlier: Path, study: Path, wanted: list[str], by: Callable[..., subprocess.CompletedProcess[str]] = said
) -> None:
    before = _snapshot(earlier)
    ended = by("report", study, "--out", earlier / "report", "--store", earlier / "store")
    assert ended.returncode == 2, ended.stdout + ended.stderr
    assert ended.stdout == ""
    assert ended.stderr.startswith("workbench: error: ")
    assert ended.stderr.count("\n") == 1
    assert "Traceback" not in ended.stderr
    for text in [str(study), *wanted]:
        assert text in ended.stderr
    assert _snapshot(earlier) == before


@pytest.mark.parametrize(("old", "new", "wanted"), BAD.values(), ids=BAD.keys())
def test_bad_study(earlier: Path, tmp_path: Path, old: str, new: str, wanted: list[str]) -> None:
    text, count = re.subn(old, lambda _: new, small_study_text(), count=1)
    assert count == 1
    study = tmp_path / "study.toml"
    study.write_text(text, encoding="utf-8")
    _assert_refused(earlier, study, wanted)


def test_missing_file_folder_and_bytes(earlier: Path, tmp_path: Path) -> None:
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"name = \xff")
    _assert_refused(earlier, tmp_path / "none.toml", ["does not exist"], by=run)
    _assert_refused(earlier, tmp_path, ["is a folder"])
    _assert_refused(earlier, binary, ["not UTF-8"])


def test_output_folder_that_is_a_file(earlier: Path, tmp_path: Path) -> None:
    study, out = tmp_path / "study.toml", tmp_path / "out"
    study.write_text(small_study_text(), encoding="utf-8")
    out.write_text("mine", encoding="utf-8")
    ended = run("report", study, "--out", out, "--store", tmp_path / "store")
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
    assert "--out" in ended.stderr
    assert out.read_text(encoding="utf-8") == "mine"
    assert not (tmp_path / "store").exists()


def test_a_failing_task_names_the_study(tmp_path: Path) -> None:
    """A contact too stiff for any increment: found only by the run."""
    study = tmp_path / "my_study.toml"
    text, count = re.subn(r'contact_stiffness = "1000 N/m"', 'contact_stiffness = "1e9 N/m"', small_study_text())
    assert count == 1
    study.write_text(text, encoding="utf-8")
    ended = run("stiffness", study, "--model", "ancf", "--out", tmp_path / "o", "--store", tmp_path / "s")
    assert ended.returncode == 2, ended.stderr
    *warnings, error = ended.stderr.splitlines()
    assert any(f"{study}: ancf.contact_stiffness = 1e9 N/m is unusual" in line for line in warnings)
    assert all(line.startswith("workbench: warning: ") for line in warnings)
    assert error.startswith(f"workbench: error: {study}: task ancf_phi0")


def test_a_file_where_the_log_belongs(tmp_path: Path) -> None:
    study, store = tmp_path / "study.toml", tmp_path / "store"
    study.write_text(small_study_text(), encoding="utf-8")
    store.mkdir()
    (store / "log").write_text("mine", encoding="utf-8")
    ended = run("stiffness", study, "--model", "brush", "--out", tmp_path / "o", "--store", store)
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stderr
    assert "--store" in ended.stderr
    assert "Traceback" not in ended.stdout + ended.stderr
