"""Writes results into the user's folder: whole files only, each put in place by one rename.

Verified by tests/unit/test_workbench_outputs.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree import ElementTree

from contracts.curves import StiffnessCurve, write_curve
from contracts.footprint import FOOTPRINT
from contracts.records import Check, Timing
from contracts.series import TimeSeries, write_series
from contracts.text import for_json, one_line
from workbench.execution.store import Entry
from workbench.questions.fe.field_file import POINTS_FILE, PRESSURE_FILE
from workbench.questions.fe.ground_file import GROUND_FILE, ground_text
from workbench.questions.fe.parts_file import PARTS_FILE, parts_text
from workbench.report.evidence import Evidence
from workbench.report.placing import new_files
from workbench.report.series import SERIES_FOLDER, series_files
from workbench.study.model import Study
from workbench.study.strengths import yield_strengths
from workbench.verdict.baseline import Change
from workbench.verdict.status import overall_status

__all__ = ["beside_fields", "curve_file", "curve_links", "field_files", "junit", "publish", "summary", "to_json"]


def curve_file(curve: StiffnessCurve) -> str:
    """``{model}_phi{DDD}.csv`` or ``{model}_average.csv``; the brush has one line only, its average."""
    from workbench.study.orientation import orientation_name

    if curve.orientation_deg is None:
        return f"{curve.model}_average.csv"
    return f"{orientation_name(curve.model, curve.orientation_deg)}.csv"


def curve_links(curves: Sequence[StiffnessCurve]) -> dict[str, str]:
    """``curves/{name}.csv`` -> a ``data:`` link with the bytes that the file in the report's folder has."""
    from workbench.charts.packing import file_link

    links = {}
    with TemporaryDirectory() as folder:
        for curve in curves:
            path = Path(folder) / curve_file(curve)
            write_curve(curve, path)
            links[f"curves/{path.name}"] = file_link(path.read_bytes())
    return links


def field_files(entries: Mapping[str, Entry]) -> dict[str, Path]:
    """``fields/fe_phi000_200N.vtu``, ``..._points.npz``, ``..._pressure.npz``, ``footprints/fe_phi000_200N.csv`` -> the
    file.
    """
    patterns = {"fields_*N.vtu": "fields_", POINTS_FILE: "", PRESSURE_FILE: "", f"{FOOTPRINT}_*N.csv": f"{FOOTPRINT}_"}
    found = {}
    for name, entry in entries.items():
        model = name.replace(FOOTPRINT, "fe", 1)
        for pattern, begin in patterns.items():
            folder = "footprints" if pattern.startswith(FOOTPRINT) else "fields"
            for path in sorted(entry.path.glob(pattern)):
                found[f"{folder}/{model}_{path.name.removeprefix(begin)}"] = path
    return found


def beside_fields(study: Study, files: Iterable[str]) -> dict[str, str]:
    """``fields/parts.json``, ``fields/ground.json`` -> its text, if there are fields among these files, and parts that
    can yield, or ground that is no level plane.
    """
    found = dict[str, str]()
    if any(name.startswith("fields/") for name in files):
        fe, strengths = study.fe, yield_strengths(study)
        if strengths:
            found[f"fields/{PARTS_FILE}"] = parts_text(strengths)
        if fe.camber or fe.obstacle.shape != "plane":
            found[f"fields/{GROUND_FILE}"] = ground_text(fe.obstacle.model_dump(mode="json"), fe.camber)
    return found


def publish(
    out: Path,
    by: str,
    texts: Mapping[str, str | bytes],
    curves: Sequence[StiffnessCurve] = (),
    series: Sequence[TimeSeries] = (),
    copies: Mapping[str, Path] | None = None,
) -> list[str]:
    """Write everything beside ``out`` first, then move it in; our files of an earlier run that are gone are removed.

    Parameters
    ----------
    out : the user's folder; other files in it stay
    by : the command that publishes; what others wrote stays, too
    texts : file name -> content; the last one is moved last and so marks a complete set
    curves : written to ``out/curves``
    series : written to ``out/series``
    copies : name in ``out``, ``fields/...`` or ``motions/...`` -> file to copy there

    Returns
    -------
    told : sentences on files of the user's that stood in the way and were kept aside

    Raises
    ------
    InputError
        If a folder stands where a file belongs, or a file where a folder belongs, or two series have one name; nothing
        was moved then.
    """
    named, copies = series_files(series), copies or {}
    lines = {f"curves/{curve_file(curve)}": curve for curve in curves}
    names = [*copies, *lines, *(f"{SERIES_FOLDER}/{name}" for name in named), *texts]
    with new_files(out, by, names, whole_set=True) as new:
        for name, path in copies.items():
            shutil.copyfile(path, new.folder / name)
        for name, curve in lines.items():
            write_curve(curve, new.folder / name)
        for name, one in named.items():
            write_series(one, new.folder / SERIES_FOLDER / name)
        for name, text in texts.items():
            content = text if isinstance(text, bytes) else text.encode()
            (new.folder / name).write_bytes(content)
    return new.told


def summary(
    study: str,
    evidence: Sequence[Evidence],
    timings: Sequence[Timing],
    provenance: Mapping[str, Any],
    verdict: Mapping[str, Any],
) -> dict[str, Any]:
    """``summary.json``, schema 2: three answers, and each check with the section, tasks and files behind it."""
    return {
        "schema": 2,
        "study": study,
        "status": overall_status([one.check for one in evidence]),
        "verdict": dict(verdict),
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
        "failures": str(sum(c.status in ("fail", "undecided") for c in gates) + len(given_up)),
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
            kind = "error" if check.status == "error" else "failure"
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
