"""What the end-to-end tests share: one folder with a small study, and its first report."""

from __future__ import annotations

import fcntl
import json
import shutil
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
def first_report(workspace: Path, tmp_path_factory: pytest.TempPathFactory) -> subprocess.CompletedProcess[str]:
    """The first report of the session, into ``workspace/report`` with ``workspace/store``.

    One of pytest's processes computes it; the others wait for it and take a copy.
    """
    base = tmp_path_factory.getbasetemp()
    made = (base.parent if base.name.startswith("popen-") else base) / "first_report"
    made.mkdir(exist_ok=True)
    with (made / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (made / "ended.json").exists():
            shutil.copy(workspace / "study.toml", made)
            ended = run("report", "study.toml", "--out", "report", "--store", "store", folder=made)
            words = {"args": ended.args, "returncode": ended.returncode, "stdout": ended.stdout, "stderr": ended.stderr}
            (made / "ended.json").write_text(json.dumps(words), encoding="utf-8")
    for name in ("report", "store"):
        if (made / name).is_dir():
            shutil.copytree(made / name, workspace / name, dirs_exist_ok=True)
    return subprocess.CompletedProcess(**json.loads((made / "ended.json").read_text(encoding="utf-8")))
