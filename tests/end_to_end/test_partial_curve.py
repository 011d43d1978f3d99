"""A study whose solve really does not converge: the report is written, its curve marked partial, the exit status 2.

The ground is driven through the hub's place, which no wheel can follow: the solve gives up on the way there.
"""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import run, small_study_text

IMPOSSIBLE = {
    r'max_deflection = "6 mm"': 'max_deflection = "250 mm"',
    r'max_load = "[^"]*"': 'max_load = "100 kN"',
    r'element_size = "14 mm"': 'element_size = "20 mm"',
}

type Finished = subprocess.CompletedProcess[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the study."""
    folder = tmp_path_factory.mktemp("partial")
    text = small_study_text()
    for pattern, new in IMPOSSIBLE.items():
        text, count = re.subn(pattern, new, text, count=1)
        assert count == 1
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def report(folder: Path) -> Finished:
    """The report of it."""
    return run("report", "study.toml", "--out", "report", "--store", "store", folder=folder)


def test_exit_status_2_and_one_message(report: Finished) -> None:
    assert report.returncode == 2
    (line,) = report.stderr.splitlines()
    for told in (
        r"workbench: error: .*study\.toml: fe_phi000 did not converge, its curve is partial",
        r"orientation 0 deg, curve reached \d\S* mm at \d\S* N",
        r"the increment to control \S+ (does not converge|ends in a state)",
        r"relative residuals of the last attempt \d|last sound state",
        r"; try ",
    ):
        assert re.search(told, line), (told, line)


def test_the_report_is_there_and_says_error(report: Finished, folder: Path) -> None:
    summary = json.loads((folder / "report" / "summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "error"
    assert list(summary["provenance"]["partial"]) == ["fe_phi000"]
    (complete,) = [c for c in summary["checks"] if c["id"] == "fe.complete"]
    assert (complete["status"], complete["value"]) == ("error", 1.0)
    assert "fe_phi000" in complete["title"]


def test_the_curve_is_marked_partial_everywhere(report: Finished, folder: Path) -> None:
    for name in ("fe_phi000", "fe_average"):
        curve = read_curve(folder / "report" / "curves" / f"{name}.csv")
        assert curve.partial
        assert 0.0 < curve.deflection[-1] < 0.25
        assert "# partial: True" in (folder / "report" / "curves" / f"{name}.csv").read_text(encoding="utf-8")
    assert not read_curve(folder / "report" / "curves" / "ancf_average.csv").partial
    page = (folder / "report" / "report.html").read_text(encoding="utf-8")
    assert re.search(r"mm, \d+ N \(partial\)</td>", page)
    assert "<b>fe_phi000 is partial.</b>" in page
    assert page.count("FE average (partial)") >= 3  # two figures and the table of distances
    assert "ANCF average (partial)" not in page


def test_stiffness_writes_its_curves_and_then_complains(report: Finished, folder: Path) -> None:
    """It finds the partial result in the store: nothing is solved again, and the verdict is the same."""
    again = run("stiffness", "study.toml", "--out", "curves", "--store", "store", folder=folder)
    assert again.returncode == 2
    assert "0 tasks computed" in again.stdout
    assert re.search(r"fe 0 deg: .* N \(partial\)", again.stdout)
    assert "fe_phi000 did not converge, its curve is partial" in again.stderr
    assert (folder / "curves" / "curves" / "fe_phi000.csv").exists()


def test_the_small_study_itself_is_complete(first_report: Finished, workspace: Path) -> None:
    """Negative control: the same study with a ground it can follow has no mark of a partial curve."""
    page = (workspace / "report" / "report.html").read_text(encoding="utf-8")
    assert first_report.returncode == 0
    assert "(partial)" not in page
    assert json.loads((workspace / "report" / "summary.json").read_text())["provenance"]["partial"] == {}
