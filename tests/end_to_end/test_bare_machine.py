"""A library that cannot load on this machine is one message with the command that mends it, and found by the doctor.

Claim: where gmsh's shared libraries are missing, `mesh` ends with exit status 2 and one line that sends to the doctor,
and the doctor, which used to read versions only, with exit status 2 and the reason. Such a machine is played by a
module `gmsh` that fails as the real one does there; `make test-bare` tries a real one.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import command, environment, small_study_text

FAILURE = "libGLU.so.1: cannot open shared object file: No such file or directory"


@pytest.fixture
def elsewhere(tmp_path: Path) -> dict[str, str]:
    """Environment in which gmsh fails to load, as on a server without OpenGL."""
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "gmsh.py").write_text(f"raise OSError({FAILURE!r})\n", encoding="utf-8")
    known = environment()
    return known | {"PYTHONPATH": f"{known['PYTHONPATH']}{os.pathsep}{tmp_path / 'lib'}"}


def ended(*arguments: str, folder: Path, known: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(*arguments), cwd=folder, env=known, capture_output=True, text=True, check=False)


def test_a_mesh_without_opengl_is_one_message(tmp_path: Path, elsewhere: dict[str, str]) -> None:
    (tmp_path / "study.toml").write_text(small_study_text(), encoding="utf-8")
    run = ended("mesh", "study.toml", "--store", "store", folder=tmp_path, known=elsewhere)
    assert run.returncode == 2
    assert run.stderr.count("\n") == 1
    assert f"gmsh cannot be loaded ({FAILURE}); `workbench doctor` names the command that mends it" in run.stderr
    assert "unexpected" not in run.stderr


def test_the_doctor_loads_what_it_judges(tmp_path: Path, elsewhere: dict[str, str]) -> None:
    run = ended("doctor", folder=tmp_path, known=elsewhere)
    assert run.returncode == 2
    assert "libGLU.so.1" in run.stdout
    assert list(tmp_path.iterdir()) == [tmp_path / "lib"]
