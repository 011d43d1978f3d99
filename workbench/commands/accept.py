"""``workbench accept``: keep a report as what later ones are held against.

Verified by tests/end_to_end/test_ci_gate.py.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from contracts.errors import InputError
from contracts.foreign_folder import read_json
from workbench.commands.computing import console, tell_kept
from workbench.report.folders import check_folder, check_targets
from workbench.report.own_files import plain_file
from workbench.report.placing import keep_foreign
from workbench.verdict.baseline import SUMMARY, read_baseline

__all__ = ["run_accept"]


def run_accept(report: Path, baseline: Path) -> int:
    """Copy the summary of a report whose gates passed; InputError for any other.

    A summary that was accepted before is replaced; any other file in its place is kept aside.
    """
    source, target = report / SUMMARY, baseline / SUMMARY
    study, status = _study_and_status(source)
    checks = read_baseline(report, study, "report").checks.values()
    if not checks:
        raise InputError("report", source, "holds no checks", "give the folder that workbench report wrote")
    broken = [check.id for check in checks if check.role == "gate" and check.status != "pass"]
    if status != "pass" or broken:
        told = ", ".join(broken[:3]) or status
        raise InputError("report", f"{source} ({told})", "must have passed its gates", "mend what broke first")
    check_folder(baseline)
    check_targets(baseline, [SUMMARY])
    baseline.mkdir(parents=True, exist_ok=True)
    fresh = baseline / f".{SUMMARY}.new-{os.getpid()}"
    try:
        shutil.copyfile(source, fresh)
        if os.path.lexists(target) and not _is_summary(target):
            tell_kept(keep_foreign(baseline, [SUMMARY]))
        fresh.replace(target)
    finally:
        fresh.unlink(missing_ok=True)
    console.print(f"accepted: {target}; keep it under version control", soft_wrap=True)
    return 0


def _study_and_status(path: Path) -> tuple[str, str]:
    hint = "give the folder that workbench report wrote"
    try:
        content = read_json(path, "report", hint)
        return str(content["study"]), str(content["status"])
    except KeyError:
        raise InputError("report", path, "is not there or no summary of a report", hint) from None


def _is_summary(path: Path) -> bool:
    try:
        study, _ = _study_and_status(path)
        read_baseline(path.parent, study)
    except InputError:
        return False
    return plain_file(path)
