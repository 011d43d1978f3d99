"""The report as a gate: a change in the physics makes it fail, and it says which claim broke.

Claim: three defects put into a copy of the package, each a slip that a reviewer could miss, are named by the claim they
break, with exit status 1: the half wheel's load is not doubled, one factor of the plate's shape functions (thesis eq.
2.13) is off, the drives' torque has the other sign. Source: docs/ci_gate.md. Only tasks whose sources changed are
computed again. Negative control: the sound package against the same baseline passes, without a change.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.end_to_end.small_study import ROOT, command, environment, small_study_text

CHANGES = {
    r"\[ancf_fit\].*?(?=\n# --- The brush)": "",
    r"\[environment\].*?(?=\n# --- The reduced)": "",
}
"""Pattern in the small study -> what this one has: no fits, one temperature."""
DEFECTS = {
    "reference_fe/wheel/problem.py": ("sides=2.0 if half_width", "sides=1.0 if half_width", "section.first_load"),
    "ancf_reduced/plates/shape_functions.py": (
        "-a * (v - 1) * (u - 1) * (3 * u - 1)",
        "-a * (v - 1) * (u - 1) * (3 * u - 1.1)",
        "ancf.preset_phi000",
    ),
    "rover_dynamics/vehicle/joint_actions.py": ("tau[place] +=", "tau[place] -=", "rover.traction"),
}
"""Module -> text, damaged text, the gate that must break."""


def _gate(folder: Path, out: str, *more: str, sources: str = "", page: str = "") -> subprocess.CompletedProcess[str]:
    """One run of the gate, with the packages of ``sources`` before our own."""
    settings = environment() | ({"GITHUB_STEP_SUMMARY": page} if page else {})
    settings["PYTHONPATH"] = f"{sources}:{ROOT}" if sources else str(ROOT)
    arguments = command("report", "gate.toml", "--ci", "--out", out, "--store", "store", *more)
    return subprocess.run(arguments, cwd=folder, env=settings, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def accepted(workspace: Path, first_report: subprocess.CompletedProcess[str]) -> Path:
    """Folder with ``gate.toml``, the small study, its store, and ``baseline`` of a report that passed."""
    assert first_report.returncode == 0, first_report.stderr
    return _accepted(workspace, small_study_text())


@pytest.fixture(scope="module")
def lean(workspace: Path, first_report: subprocess.CompletedProcess[str]) -> Path:
    """The same of what can be computed anew in a minute."""
    assert first_report.returncode == 0, first_report.stderr
    text = small_study_text()
    for pattern, new in CHANGES.items():
        text, count = re.subn(pattern, new, text, count=1, flags=re.DOTALL)
        assert count == 1, f"the small study no longer contains {pattern!r}: mend this list"
    folder = workspace / "lean"
    shutil.copytree(workspace / "store", folder / "store")
    return _accepted(folder, text)


def _accepted(folder: Path, text: str) -> Path:
    (folder / "gate.toml").write_text(text, encoding="utf-8")
    first = _gate(folder, "gate")
    assert first.returncode == 0, first.stdout + first.stderr
    kept = subprocess.run(
        command("accept", "gate", "--baseline", "baseline"), cwd=folder, env=environment(), check=True
    )
    assert kept.returncode == 0
    return folder


def test_the_sound_package_passes_without_a_change(accepted: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("before\n", encoding="utf-8")
    run = _gate(accepted, "again", "--baseline", "baseline", page=str(page))
    assert run.returncode == 0, run.stderr
    assert "0 tasks computed" in run.stdout
    assert not re.search("[\x1b━│]", run.stdout), "bars or colours in a log"
    text = (accepted / "again" / "summary.md").read_text(encoding="utf-8")
    assert "Nothing else changed" in text
    assert page.read_text(encoding="utf-8") == f"before\n{text}"
    assert json.loads((accepted / "again" / "summary.json").read_text(encoding="utf-8"))["changes"] == []


@pytest.mark.long
@pytest.mark.parametrize("module", DEFECTS)
def test_a_defect_in_the_physics_fails_and_is_named(lean: Path, tmp_path: Path, module: str) -> None:
    good, bad, gate = DEFECTS[module]
    package = module.split("/")[0]
    shutil.copytree(ROOT / package, tmp_path / package)
    _take_compiled_along(ROOT / package, tmp_path / package)
    source = tmp_path / module
    text = source.read_text(encoding="utf-8")
    assert text.count(good) == 1
    source.write_text(text.replace(good, bad), encoding="utf-8")

    run = _gate(lean, f"damaged_{package}", "--baseline", "baseline", sources=str(tmp_path))
    assert run.returncode == 1, run.stdout + run.stderr
    out = lean / f"damaged_{package}"
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    claim = next(check["claim"] for check in summary["checks"] if check["id"] == gate)
    broken = [change["id"] for change in summary["changes"] if change["kind"] == "broken"]
    assert gate in broken
    assert f"| `{gate}` | {claim} |" in (out / "summary.md").read_text(encoding="utf-8")
    assert f"BROKEN {gate}: {claim}" in run.stdout
    cases = ElementTree.parse(out / "junit.xml").getroot().iter("testcase")
    assert set(broken) <= {case.get("name") for case in cases if case.find("failure") is not None}
    assert not any(name.startswith(_others(package)) for name in broken), "a claim of an undamaged model broke"


def _take_compiled_along(package: Path, copy: Path) -> None:
    """Name the copy's folders of compiled functions as Numba looks for them, after the place of their sources."""
    for folder in [package, *(path for path in package.rglob("*") if path.is_dir())]:
        other = copy / folder.relative_to(package)
        for compiled in (copy / "__pycache__").glob(f"compiled-*/{_cache_name(folder)}"):
            compiled.rename(compiled.with_name(_cache_name(other)))


def _cache_name(folder: Path) -> str:
    return f"{folder.name}_{hashlib.sha1(str(folder).encode()).hexdigest()}"


def _others(package: str) -> tuple[str, ...]:
    """First parts of the identifiers of gates that do not depend on a package."""
    own = {"reference_fe": ("fe.", "mesh."), "ancf_reduced": ("ancf.",), "rover_dynamics": ("rover.",)}
    return tuple(name for other, names in own.items() if other != package for name in names)


def test_what_is_no_baseline_and_no_passing_report_is_refused(accepted: Path, tmp_path: Path) -> None:
    run = _gate(accepted, "none", "--baseline", str(tmp_path))
    assert run.returncode == 2
    assert run.stderr.splitlines()[-1].startswith("workbench: error: baseline = ")
    assert run.stderr.endswith("accept a report first: workbench accept DIR\n")
    failed = json.loads((accepted / "gate" / "summary.json").read_text(encoding="utf-8")) | {"status": "fail"}
    (tmp_path / "summary.json").write_text(json.dumps(failed), encoding="utf-8")
    refused = subprocess.run(
        command("accept", tmp_path), cwd=accepted, env=environment(), capture_output=True, text=True, check=False
    )
    assert refused.returncode == 2
    assert "must have passed its gates" in refused.stderr
