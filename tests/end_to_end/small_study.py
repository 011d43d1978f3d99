"""A small study that runs the whole chain in seconds, and commands run as a user would run them."""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from workbench.study.reading import built_in_study

ROOT = Path(__file__).parents[2]

CHANGES = {
    r'element_size = "[^"]*"': 'element_size = "14 mm"',
    r'axial_size = "[^"]*"': 'axial_size = "40 mm"',
    r"edge_size = .*\n": "",
    r'orientations = \["0 deg", "15 deg"\]': 'orientations = ["0 deg"]',
    r"orientations = \[[^\]]*\]": 'orientations = ["0 deg"]',
    r'max_deflection = "[^"]*"': 'max_deflection = "6 mm"',
    r"points = \d+": "points = 2",
    r"snapshot_loads = \[[^\]]*\]": 'snapshot_loads = ["20 N"]',
    r'max_deflection = "36 mm"\npoints = \d+': 'max_deflection = "6 mm"\npoints = 2',
    r"temperatures = \[[^\]]*\]": 'temperatures = ["-40 degC", "20 degC"]',
    r"factors = \[1, 2, 3\]": "factors = [1, 1.5, 2]",
    r'\["10 mm", "30 mm"\]': '["6 mm"]',
    r"\[soil\][^\[]*\[[^\[]*(?=\n\[)": "",
    r"soil_models = .*\n": "",
    r"\[hub_study\][^\[]*\[[^\[]*\n(?=\[)": "",
    r'\[penalty_study\][^\[]*deflection = "[^"]*"\n': "",
    r'\norientation = "(?!0)[^"]*"': '\norientation = "0 deg"',
    r"enabled = true": "enabled = false",
    r"variants = \[[^\]]*\]": "variants = []",
    r'\[materials."AISI 301"\][^\[]*(?=\n# ---)': "",
    r'on_ancf_tires = "short"': 'on_ancf_tires = "none"',
    r"\[tolerances\]": '[tolerances]\nreach_deflection = "6 mm"\nfe_energy = 0.1\nstress_uncertainty = 0.9',
    r"mesh_uncertainty = \S+": "mesh_uncertainty = 0.5",
    r"ancf_wheel_mean = \S+": "ancf_wheel_mean = 0.02",
}
"""Pattern in the built-in study -> what the small study has; the first match only, which is the FE's."""


TINY = {
    r'element_size = "[^"]*"': 'element_size = "24 mm"',
    r'axial_size = "[^"]*"': 'axial_size = "60 mm"',
    r"orientations = \[[^\]]*\]": 'orientations = ["0 deg"]',
    r'max_deflection = "[^"]*"': 'max_deflection = "6 mm"',
    r"points = \d+": "points = 2",
    r"snapshot_loads = \[[^\]]*\]": 'snapshot_loads = ["20 N", "10 kN"]',
    r'\["10 mm", "20 mm", "30 mm"\]': '["6 mm"]',
}
"""Pattern in the tutorial's study -> what the tiny one has: 2 points on a mesh far too coarse."""


def small_study_text() -> str:
    """The built-in study, coarse and short; its gates are such that it exits 0."""
    return _changed(built_in_study(), CHANGES)


def tiny_study() -> str:
    """The tutorial's study ``first`` at one orientation, for finite elements in seconds."""
    return _changed(ROOT / "studies" / "first.toml", TINY)


def _changed(path: Path, changes: Mapping[str, str]) -> str:
    text = path.read_text(encoding="utf-8")
    for pattern, new in changes.items():
        text, count = re.subn(pattern, lambda _, new=new: new, text, count=1)
        assert count == 1, f"{path.name} no longer contains {pattern!r}: mend this list"
    return text


def both_pages(folder: Path) -> str:
    """The report and its evidence, one behind the other."""
    return "".join((folder / name).read_text(encoding="utf-8") for name in ("report.html", "evidence.html"))


def command(*arguments: str | Path) -> list[str]:
    """Command line of the workbench in this Python."""
    return [sys.executable, "-m", "workbench", *map(str, arguments)]


def environment() -> dict[str, str]:
    """The tests' environment: wide tables, this checkout, no display, no terminal."""
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WORKBENCH_STORE", "WORKBENCH_TRACEBACK")}
    return kept | {"PYTHONPATH": str(ROOT), "COLUMNS": "160"}


def said(*arguments: str | Path, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """What one command says, in this process: for messages that come before anything runs, a second sooner each."""
    from workbench.cli import _run

    out, err = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = _run([*map(str, arguments)])
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())


def run(*arguments: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run one command to its end."""
    return subprocess.run(
        command(*arguments), cwd=folder, env=environment(), capture_output=True, text=True, check=False
    )
