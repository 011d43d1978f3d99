"""A process that died while it compiled a form stops nobody: what it left is removed, and no clock runs."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from pathlib import Path

from reference_fe.form_cache import sole_compiler
from tests.end_to_end.small_study import ROOT

COMPILED = """
from reference_fe import dolfinx_api as api
import numpy as np
mesh = api.dolfinx.mesh.create_unit_square(api.COMM, 1, 1)
v = api.ufl.TestFunction(api.fem.functionspace(mesh, ("Lagrange", 1)))
api.compile_form(v * api.ufl.dx)
api.compile_expression(api.ufl.SpatialCoordinate(mesh)[0], np.zeros((1, 2)))
"""


def _compile(caches: Path) -> None:
    place = os.environ | {"XDG_CACHE_HOME": str(caches)}
    subprocess.run([sys.executable, "-c", COMPILED], cwd=ROOT, env=place, check=True)


def test_a_form_that_a_killed_process_began_is_compiled_anew(tmp_path: Path) -> None:
    _compile(tmp_path)
    folder = tmp_path / "fenics" / "wheel-workbench"
    done = sorted(folder.glob("*.cached"))
    assert len(done) == 2
    for one in done:  # as FFCx leaves them when it is killed: its C file is there, empty, and not marked as done
        one.with_suffix("").write_text("", encoding="utf-8")
        one.unlink()
    _compile(tmp_path)
    assert sorted(folder.glob("*.cached")) == done


def test_what_is_done_stays_and_what_was_begun_goes(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "folder"
    with sole_compiler(folder):
        for name in ("libffcx_forms_a.c", "libffcx_forms_a.c.cached", "libffcx_forms_b.c", "mine.c"):
            (folder / name).touch()
    with sole_compiler(folder):
        assert sorted(p.name for p in folder.glob("*.c*")) == [
            "libffcx_forms_a.c",
            "libffcx_forms_a.c.cached",
            "mine.c",
        ]


def test_one_at_a_time_and_free_again_afterwards(tmp_path: Path) -> None:
    with sole_compiler(tmp_path):
        assert not _can_be_held(tmp_path)
    assert _can_be_held(tmp_path)


def test_where_nothing_can_be_written_nothing_is_held() -> None:
    with sole_compiler(Path("/proc/no/such/folder")):
        pass


def _can_be_held(folder: Path) -> bool:
    with (folder / "lock").open("a", encoding="utf-8") as stream:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True
