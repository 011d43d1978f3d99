"""The full report, reduced: a period of the small wheel in three steps, resumed from the default report's store."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import both_pages, run, small_study_text

FULL = '[full]\norientation_step = "40 deg"\nfactor = 1\n'


@pytest.mark.long
def test_the_full_report_covers_a_period_and_shows_it(
    first_report: subprocess.CompletedProcess[str], workspace: Path
) -> None:
    text = small_study_text()
    start, end = text.index("[full]"), text.index("mesh_study_factors")
    (workspace / "full.toml").write_text(text[:start] + FULL + text[end:], encoding="utf-8")
    done = run("report", "full.toml", "--full", "--out", "full", "--store", "store", folder=workspace)
    assert done.returncode == first_report.returncode, done.stdout + done.stderr
    computed = {line.split("] ")[1].split(":")[0] for line in done.stdout.splitlines() if ": computed in" in line}
    assert {"fe_phi040", "fe_phi080"} <= computed
    assert not {"mesh", "fe_phi000", "fe_x1.5_phi000", "fe_x2_phi000"} & computed
    summary = json.loads((workspace / "full" / "summary.json").read_text(encoding="utf-8"))
    mirror = next(check for check in summary["checks"] if check["id"] == "fe.mirror_symmetry")
    assert mirror["status"] == "pass"
    assert mirror["value"] < 1e-4  # of two runs; the CSV files' twelve digits may be the same
    page = both_pages(workspace / "full")
    for words in ("full study", "cover one period in equal steps", "40° and 80°", "orientation-map"):
        assert words in page, words
