"""What must load is tried in a process of its own: a failure, a crash and a hang are each told, before anything runs.

Negative controls: a check that works has no complaint; a task whose libraries load, or that needs none, is not stopped.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from contracts.errors import InputError
from workbench.execution import doctor, load_checks
from workbench.execution.errors import RunError
from workbench.execution.load_checks import CHECKS, LoadCheck, complaint_of, lacking_packages, require_loadable
from workbench.execution.progress import RunDisplay
from workbench.execution.runner import run_all
from workbench.execution.store import Store
from workbench.execution.task import Task

GONE = LoadCheck(
    name="paint mixes",
    purpose="colour",
    code='raise OSError("libpaint.so.1: cannot open shared object file")',
    packages=("libpaint1-of-nowhere",),
    libraries=("numpy",),
    shared=("libpaint.so.1",),
)
COMPILER = (
    "import sys; sys.stderr.write('a.c:1:10: fatal error: Python.h: No such file or directory\\nCommand failed\\n');"
    "sys.exit(1)"
)
TASK = Task(name="brush", function="workbench.questions.models.brush_task:solve", inputs={})


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("pass", ""),
        (GONE.code, "OSError: libpaint.so.1: cannot open shared object file"),
        ("import os; os.abort()", "crashed (signal 6)"),
        ("import ctypes; ctypes.string_at(0)", "crashed (signal 11)"),
        ("raise SystemExit(3)", "ended with status 3"),
        (COMPILER, "a.c:1:10: fatal error: Python.h: No such file or directory"),
    ],
)
def test_each_end_is_told_in_one_line(code: str, told: str) -> None:
    assert complaint_of(replace(GONE, code=code)) == told


def test_a_hang_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(load_checks, "PATIENCE", 0.5)
    assert complaint_of(replace(GONE, code="import time; time.sleep(600)")) == "no answer within 0.5 s"


def test_nothing_is_computed_where_a_library_cannot_load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(load_checks, "CHECKS", (GONE,))
    display = RunDisplay(Console(quiet=True), [TASK])
    with display, pytest.raises(RunError, match=r"nothing was computed.*libpaint\.so\.1"):
        run_all([TASK], Store(tmp_path / "store"), display)
    assert display.bars == {}  # nothing was started
    with pytest.raises(RunError, match=r"as root: apt-get install .* libpaint1-of-nowhere$"):
        require_loadable([TASK])
    require_loadable([replace(TASK, function="workbench.execution.reach:none")])  # imports nothing of it


def test_what_is_there_is_not_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where every shared library loads, a look is all a run pays for."""
    monkeypatch.setattr(load_checks, "complaint_of", lambda _: pytest.fail("tried"))
    monkeypatch.setattr(load_checks, "CHECKS", (replace(GONE, shared=("libc.so.6",)),))
    require_loadable([TASK])
    assert replace(GONE, programs=("painter-of-nowhere",)).in_doubt
    assert replace(GONE, shared=(), files=(Path("/nowhere/Python.h"),)).in_doubt
    assert not replace(GONE, shared=(), programs=("painter-of-nowhere", "sh"), files=(Path(__file__),)).in_doubt


def test_the_doctor_names_the_packages_that_are_not_installed() -> None:
    found = doctor.examine((GONE,))
    assert (found.well, found.packages) == (False, ("libpaint1-of-nowhere",))
    told = found.findings[-1]
    assert "libpaint.so.1" in told.found
    assert re.fullmatch(r"`apt-get install .* libpaint1-of-nowhere`", told.advice)
    assert lacking_packages([replace(GONE, packages=("libc6",))]) in ((), ("libc6",))  # there, or no dpkg to say so


def test_only_root_with_apt_installs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.geteuid", lambda: 1000)
    monkeypatch.setattr("subprocess.run", lambda *_, **__: pytest.fail("ran"))
    with pytest.raises(InputError, match=r"needs root and apt-get.* run: apt-get install .* libgl1"):
        doctor.install(("libgl1",))


def test_every_library_that_may_fail_to_load_has_its_check() -> None:
    tried = {library for check in CHECKS for library in check.libraries}
    assert tried >= {"gmsh", "pyvista", "vtk", "dolfinx-solver-real", "numba", "rasterio"}
    assert all(check.packages for check in CHECKS if check.shared)
