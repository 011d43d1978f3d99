"""Writes results into the user's folder: whole files only, each put in place by one rename.

Verified by tests/unit/test_workbench_outputs.py.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from contracts.curves import StiffnessCurve, write_curve
from contracts.records import Check, Timing
from contracts.series import TimeSeries, write_series
from contracts.text import for_json, one_line
from workbench.comparison.baseline import Change
from workbench.comparison.comparison import overall_status
from workbench.report.evidence import Evidence
from workbench.report.folders import check_folder, check_targets, copy_files, put_files
from workbench.report.series import MOTIONS_FOLDER, SERIES_FOLDER, is_ours, series_files

__all__ = [
    "check_folder",
    "check_targets",
    "copy_files",
    "curve_file",
    "junit",
    "publish",
    "put_files",
    "summary",
    "to_json",
]


def curve_file(curve: StiffnessCurve) -> str:
    """``{model}_phi{DDD}.csv`` or ``{model}_average.csv``; the brush has one line only, its average."""
    from workbench.graph.study_graph import orientation_name

    if curve.orientation_deg is None:
        return f"{curve.model}_average.csv"
    return f"{orientation_name(curve.model, curve.orientation_deg)}.csv"


def publish(
    out: Path,
    texts: Mapping[str, str | bytes],
    curves: Sequence[StiffnessCurve] = (),
    fields: Mapping[str, Path] | None = None,
    series: Sequence[TimeSeries] = (),
    motions: Mapping[str, Path] | None = None,
) -> None:
    """Write everything beside ``out`` first, then move it in; our files of an earlier run that are gone are removed.

    Parameters
    ----------
    out : the user's folder; other files in it stay
    texts : file name -> content; the last one is moved last and so marks a complete set
    curves : written to ``out/curves``
    fields : file name -> file to copy to ``out/fields``
    series : written to ``out/series``
    motions : file name -> file to copy to ``out/motions``

    Raises
    ------
    InputError
        If a folder stands where a file belongs, or a file where a folder belongs, or two series have one name; nothing
        was moved then.
    """
    named = series_files(series)
    out.mkdir(parents=True, exist_ok=True)
    names = [*texts, *(f"curves/{curve_file(curve)}" for curve in curves), *(f"fields/{name}" for name in fields or {})]
    names += [*(f"{SERIES_FOLDER}/{name}" for name in named), *(f"{MOTIONS_FOLDER}/{name}" for name in motions or {})]
    check_targets(out, names if fields is None else [*names, "fields/.vtu"])
    _sweep(out)
    fresh = out / f".new-{os.getpid()}"
    try:
        (fresh / "curves").mkdir(parents=True)
        for curve in curves:
            write_curve(curve, fresh / "curves" / curve_file(curve))
        for name, one in named.items():
            write_series(one, fresh / SERIES_FOLDER / name)
        for folder, files in (("fields", fields), (MOTIONS_FOLDER, motions)):
            (fresh / folder).mkdir()
            for name, path in (files or {}).items():
                shutil.copyfile(path, fresh / folder / name)
        for name, text in texts.items():
            if isinstance(text, bytes):
                (fresh / name).write_bytes(text)
            else:
                (fresh / name).write_text(text, encoding="utf-8")
        if curves:
            _replace_files(fresh / "curves", out / "curves", _is_curve_or_field)
        if named:
            _replace_files(fresh / SERIES_FOLDER, out / SERIES_FOLDER, is_ours)
        if fields is not None:
            _replace_files(fresh / "fields", out / "fields", _is_curve_or_field)
        if motions:
            _replace_files(fresh / MOTIONS_FOLDER, out / MOTIONS_FOLDER, _is_motion)
        for name in texts:
            (fresh / name).replace(out / name)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def _sweep(out: Path) -> None:
    """Remove what a run killed while publishing left behind."""
    for left in out.glob(".new-*"):
        if not Path(f"/proc/{left.name.removeprefix('.new-')}").exists():
            shutil.rmtree(left, ignore_errors=True)


def _is_curve_or_field(name: str) -> bool:
    return name.startswith(("fe_", "section_", "ancf_", "brush_")) and name.endswith((".csv", ".vtu"))


def _is_motion(name: str) -> bool:
    return name.endswith(("_brush.npz", "_ancf.npz", "_rigid.npz"))


def _replace_files(fresh: Path, target: Path, is_ours: Callable[[str], bool]) -> None:
    """Move files in, then remove those of ours that the new set does not have."""
    target.mkdir(exist_ok=True)
    names = {path.name for path in fresh.iterdir()}
    for path in fresh.iterdir():
        path.replace(target / path.name)
    for old in target.iterdir():
        if is_ours(old.name) and old.name not in names:
            old.unlink()


def summary(
    study: str, evidence: Sequence[Evidence], timings: Sequence[Timing], provenance: Mapping[str, Any]
) -> dict[str, Any]:
    """``summary.json``, schema 1: each check with the section, tasks and files behind it."""
    return {
        "schema": 1,
        "study": study,
        "status": overall_status([one.check for one in evidence]),
        "checks": [_row(one) for one in evidence],
        "timings": [{name: getattr(t, name) for name in Timing.__slots__} for t in timings],
        "provenance": dict(provenance),
    }


def _row(evidence: Evidence) -> dict[str, Any]:
    row: dict[str, Any] = {name: getattr(evidence.check, name) for name in Check.__slots__}
    return row | {"section": evidence.section, "tasks": dict(evidence.tasks), "files": list(evidence.files)}


def junit(study: str, checks: Sequence[Check], given_up: Sequence[Change] = ()) -> str:
    """The checks as JUnit XML: a failed gate is a failure, a failed finding is noted in the case's output.

    What was accepted and given up since is a failure, too.
    """
    gates = [c for c in checks if c.role == "gate"]
    counts = {
        "tests": str(len(checks) + len(given_up)),
        "failures": str(sum(c.status == "fail" for c in gates) + len(given_up)),
        "errors": str(sum(c.status == "error" for c in gates)),
        "skipped": "0",
    }
    root = ElementTree.Element("testsuites", {"name": "workbench", **counts})
    suite = ElementTree.SubElement(root, "testsuite", {"name": study, **counts})
    for check in checks:
        case = ElementTree.SubElement(suite, "testcase", {"classname": f"{study}.{check.role}", "name": check.id})
        text = one_line(
            f"{check.title}: {check.quantity} {check.value} {check.unit}, {check.tolerance} of {check.reference}"
        )
        claim, source = one_line(check.claim), one_line(check.source)
        if check.role == "gate" and check.status != "pass":
            kind = "failure" if check.status == "fail" else "error"
            ElementTree.SubElement(case, kind, {"message": text}).text = f"claim: {claim}\nsource: {source}"
        else:
            ElementTree.SubElement(case, "system-out").text = f"{check.status}: {text}; source: {source}"
    for change in given_up:
        attributes = {"classname": f"{study}.accepted", "name": one_line(change.check.id)}
        case = ElementTree.SubElement(suite, "testcase", attributes)
        claim = one_line(change.check.claim)
        ElementTree.SubElement(case, "failure", {"message": change.kind}).text = f"claim: {claim}"
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def to_json(value: Mapping[str, Any]) -> str:
    """Indented JSON text; refuses NaN."""
    return for_json(json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)) + "\n"
