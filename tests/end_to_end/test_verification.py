"""The report's verification, run as a user would: every benchmark passes, every damaged copy is caught."""

from __future__ import annotations

import html
import json
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, small_study_text
from workbench.questions.multibody.question import ALLOWED
from workbench.questions.verification.checks import BENCHMARKS
from workbench.questions.verification.checks_ancf import ANCF_BENCHMARKS

NAMES = [*BENCHMARKS, *ANCF_BENCHMARKS]

type Finished = subprocess.CompletedProcess[str]


@pytest.mark.long
def test_benchmarks_are_solved_and_shown(first_report: Finished, workspace: Path) -> None:
    assert first_report.returncode == 0, first_report.stderr
    text = small_study_text().replace("enabled = false", "enabled = true")
    (workspace / "verified.toml").write_text(text, encoding="utf-8")
    finished = run("report", "verified.toml", "--out", "verified", "--store", "store", folder=workspace)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    assert f"{len(NAMES) + len(ALLOWED)} tasks computed" in finished.stdout
    summary = json.loads((workspace / "verified" / "summary.json").read_text(encoding="utf-8"))
    checks = {c["id"]: c for c in summary["checks"] if c["id"].startswith("verify.")}
    assert {c["status"] for c in checks.values()} == {"pass"}
    assert {f"verify.{name}_control" for name in NAMES} <= set(checks)
    assert checks["verify.ancf_pendulum_path"]["value"] < 1e-5
    assert checks["verify.ancf_end_moment_order"]["value"] > 2.5
    page = html.unescape((workspace / "verified" / "evidence.html").read_text(encoding="utf-8"))
    for wanted in (
        '<section id="verification">',
        '<section id="multibody">',
        "A02 four-bar, N = 40",
        "every damaged copy below is caught",
        "ring 1 % thicker",
        "one sign of thesis eq. 2.13",
    ):
        assert wanted in page
    assert "16 x 32 of 27 nodes" in page
    assert page.count("✓ caught") == len(NAMES)
    assert '<section id="verification">' not in (workspace / "report" / "evidence.html").read_text(encoding="utf-8")
