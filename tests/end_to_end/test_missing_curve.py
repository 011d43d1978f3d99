"""An orientation of which no point converges: the report is written, says so wherever it matters, and exits with 2.

First a study whose tolerance lies below round-off, so that the solver truly fails at every increment. Then one of two
orientations: its result in the store is that of the same solver failing in the same way.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import both_pages, run, small_study_text
from workbench.execution.fingerprint import file_sha256
from workbench.execution.integrity import sealed, unsealed
from workbench.execution.result_files import FAILURE, read_result
from workbench.questions.fe.task import solve_orientation

BELOW_ROUND_OFF = 1e-10
"""Residuals of the small study stall at 1e-9."""
ORIENTATION = 'orientations = ["0 deg"]'

type Finished = subprocess.CompletedProcess[str]


def _report(folder: Path, text: str) -> tuple[Finished, dict[str, Any], str]:
    """Finished command, summary and page of a study's report."""
    (folder / "study.toml").write_text(text, encoding="utf-8")
    done = run("report", folder / "study.toml", "--out", "report", "--store", "store", folder=folder)
    summary = json.loads((folder / "report" / "summary.json").read_text(encoding="utf-8"))
    return done, summary, both_pages(folder / "report")


def _statuses(summary: dict[str, Any]) -> dict[str, str]:
    return {check["id"]: check["status"] for check in summary["checks"]}


def _fail(entry: Path) -> None:
    """Put the result of a solve that truly fails into the place of a stored one."""
    record = unsealed((entry / "manifest.json").read_text(encoding="utf-8"))
    assert record is not None
    for name in record["files"]:
        (entry / name).unlink()
    mesh = next(p for p in entry.parents[1].glob(f"??/{record['needs']['mesh']}"))
    inputs = record["inputs"] | {"relative_tolerance": BELOW_ROUND_OFF}
    solve_orientation(inputs, {"mesh": mesh}, entry, lambda fraction: None)
    kept = [p for p in entry.iterdir() if p.name != "manifest.json"]
    record |= {"files": {p.name: file_sha256(p) for p in kept}, "sizes": {p.name: p.stat().st_size for p in kept}}
    (entry / "manifest.json").write_text(sealed(record), encoding="utf-8")


@pytest.fixture(scope="module")
def one_missing(
    workspace: Path, first_report: Finished, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Finished, dict[str, Any], Path]:
    """Report of the small study at 0 and 45 degrees, whose run at 0 failed at once."""
    folder = tmp_path_factory.mktemp("missing")
    shutil.copytree(workspace / "store", folder / "store")
    first = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    keys = first["provenance"]["tasks"]  # other tests, with other inputs, share the store
    fe, pictures = (folder / "store" / keys[task][:2] / keys[task] for task in ("fe_phi000", "pictures"))
    _fail(fe)
    shutil.rmtree(pictures)
    done, summary, _ = _report(folder, small_study_text().replace(ORIENTATION, 'orientations = ["0 deg", "45 deg"]', 1))
    return done, summary, folder / "report"


@pytest.mark.long
def test_one_missing_orientation_is_named_with_where_how_far_why_and_what_to_try(
    one_missing: tuple[Finished, dict[str, Any], Path],
) -> None:
    done, summary, folder = one_missing
    assert done.returncode == 2, done.stdout + done.stderr
    (line,) = done.stderr.splitlines()
    reason = summary["provenance"]["partial"]["fe_phi000"]
    assert reason in line
    pattern = r"orientation 0 deg, no point of the curve reached: .* stalls at a relative residual of \S+, .*last "
    assert re.match(pattern + r"converged at 0; .*set the relative tolerance to \S+ or more", reason)
    page = both_pages(folder)
    assert f"<b>0° is missing:</b> no point of its curve converged, and the average is without it. {reason}" in page
    assert r"FE 0\u00b0 (missing)" in page
    assert "no point (missing)" in page


def test_all_other_results_are_kept(one_missing: tuple[Finished, dict[str, Any], Path]) -> None:
    _, summary, folder = one_missing
    sound, average = (read_curve(folder / "curves" / f"fe_{name}.csv") for name in ("phi045", "average"))
    assert not sound.partial
    assert average.partial
    assert "without 0.0 deg" in average.source
    assert float(average.load_at(0.006)) == pytest.approx(float(sound.load_at(0.006)), rel=1e-9)
    assert read_curve(folder / "curves" / "fe_phi000.csv").unloaded
    found = _statuses(summary)
    assert found["fe.complete"] == "error"
    assert found["fe.mesh_uncertainty"] == "error"  # its middle mesh is the missing run's
    assert found["environment.similarity"] == "error"
    assert found["section.agreement"] == "pass"  # the averages without 0 degrees
    assert found["ancf.flexible_mass"] == "pass"
    assert {"ancf_vs_fe.relative_l2", "words.small.slope"} <= {i for i, status in found.items() if status != "error"}


@pytest.mark.long
def test_a_study_of_which_nothing_converges_still_ends_in_a_report(tmp_path: Path) -> None:
    text, count = re.subn(r"relative_tolerance = \S+", f"relative_tolerance = {BELOW_ROUND_OFF}", small_study_text())
    assert count == 1
    done, summary, page = _report(tmp_path, text)
    assert done.returncode == 2, done.stdout + done.stderr
    assert set(summary["provenance"]["partial"]) >= {"fe_phi000", "section_phi000", "environment_-40C"}
    found = _statuses(summary)
    assert found["fe.complete"] == "error"
    assert {found[i] for i in ("words.small.slope", "fe.energy", "ancf_vs_fe.tangent")} == {"error"}
    assert found["ancf.flexible_mass"] == found["mesh.mass"] == "pass"
    assert "<b>0° is missing:</b>" in page
    assert read_curve(tmp_path / "report" / "curves" / "fe_average.csv").unloaded
    (stored,) = (p for p in (tmp_path / "store").glob("??/*/manifest.json") if '"task": "fe_phi000"' in p.read_text())
    assert FAILURE in read_result(stored.parent)


def test_the_small_study_itself_misses_nothing(first_report: Finished, workspace: Path) -> None:
    """Negative control: at the study's own tolerance nothing is missing."""
    assert first_report.returncode == 0
    page = both_pages(workspace / "report")
    figures = page.partition("Continuum finite elements")[2]
    assert "is missing" not in figures
    assert "(missing)" not in figures
