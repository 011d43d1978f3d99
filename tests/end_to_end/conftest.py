"""What the end-to-end tests share: one folder with a small study, and its first report."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, small_study_text


@pytest.fixture(scope="session")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with ``study.toml``, shared by the tests of one session."""
    folder = tmp_path_factory.mktemp("workspace")
    (folder / "study.toml").write_text(small_study_text(), encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def first_report(workspace: Path) -> subprocess.CompletedProcess[str]:
    """The first report of the session, into ``workspace/report`` with ``workspace/store``."""
    return run("report", "study.toml", "--out", "report", "--store", "store", folder=workspace)
