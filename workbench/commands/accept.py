"""``workbench accept``: keep a report as what later ones are held against.

Verified by tests/end_to_end/test_ci_gate.py.
"""

from __future__ import annotations

from pathlib import Path

from contracts.errors import InputError
from contracts.foreign_folder import read_json
from workbench.commands.computing import console
from workbench.comparison.baseline import SUMMARY, read_baseline
from workbench.report.outputs import check_folder, copy_files

__all__ = ["run_accept"]


def run_accept(report: Path, baseline: Path) -> int:
    """Copy the summary of a report whose gates passed; InputError for any other."""
    source, hint = report / SUMMARY, "give the folder that workbench report wrote"
    try:
        content = read_json(source, "report", hint)
        study, status = str(content["study"]), content["status"]
    except (KeyError, TypeError):
        rule = "is not there or no summary of a report"
        raise InputError("report", source, rule, hint) from None
    read_baseline(report, study)
    if status != "pass":
        raise InputError("report", f"{source} ({status})", "must have passed its gates", "mend what broke first")
    check_folder(baseline)
    (written,) = copy_files(report, [SUMMARY], baseline)
    console.print(f"accepted: {written}; keep it under version control", highlight=False, markup=False, soft_wrap=True)
    return 0
