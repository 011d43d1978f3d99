"""Where a report's numbers come from: versions, machine, commit, hashes of tasks.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import datetime
import os
import platform
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contracts.records import Timing
from workbench.execution.doctor import NEEDED
from workbench.execution.fingerprint import file_sha256, library_versions
from workbench.execution.result_files import early_ends
from workbench.execution.store import Entry

__all__ = ["git_commit", "provenance", "task_timings"]


def provenance(study_path: Path, entries: Mapping[str, Entry]) -> dict[str, Any]:
    """Everything needed to find out how a number was made."""
    return {
        "workbench": _own_version(),
        "commit": git_commit(Path(__file__).parents[2]),
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "study_sha256": file_sha256(study_path),
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "cores": os.cpu_count(),
        "libraries": dict(library_versions(tuple(NEEDED))),
        "partial": early_ends({name: entry.path for name, entry in entries.items()}),
        "tasks": {name: entry.key for name, entry in entries.items()},
    }


def _own_version() -> str:
    version = library_versions(("wheel-workbench",))["wheel-workbench"]
    return "not installed, run from source" if version == "missing" else version


def git_commit(root: Path) -> str | None:
    """Commit of the checkout the code runs from, with ``+changes`` if it was edited; None outside a checkout."""
    if not (root / ".git").exists():
        return None
    try:
        head = _git(root, "rev-parse", "HEAD")
        changed = _git(root, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.SubprocessError):
        return None
    return head + ("+changes" if changed else "")


def _git(root: Path, *arguments: str) -> str:
    run = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=True, timeout=10)
    return run.stdout.strip()


def task_timings(entries: Mapping[str, Entry]) -> tuple[Timing, ...]:
    """Wall time of the computation behind each stored result, in the order of the graph."""
    return tuple(Timing(task=name, wall_s=entry.wall_s, dofs=entry.dofs) for name, entry in entries.items())
