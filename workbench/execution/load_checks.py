"""What must load and work on this machine: each is tried in a process of its own, so that a crash is told of.

A library whose version is right may still miss a shared library of the system, or crash without one. Each check names
the Debian packages that bring what it needs. Verified by tests/unit/test_workbench_load_checks.py and, on a machine
with nothing, `make test-bare`.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from workbench.execution.errors import RunError
from workbench.execution.reach import reached_libraries
from workbench.execution.task import Task

__all__ = [
    "CHECKS",
    "LoadCheck",
    "complaint_of",
    "complaints",
    "install_command",
    "lacking_packages",
    "require_loadable",
]

PATIENCE = 300.0
"""Time after which a check counts as hung [s]; each takes a few seconds on an idle machine."""
_ROOT = str(Path(__file__).parents[2])
_SHOWN = 300


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadCheck:
    """One thing that must work.

    Attributes
    ----------
    name : what is tried, in words
    purpose : what it is needed for
    code : Python that ends with status 0 if all is well, run in an empty folder
    packages : Debian packages with what it needs of the system
    libraries : distributions whose tasks need it
    shared : shared libraries of the system it loads
    programs : programs of which it needs one
    files : files it reads
    """

    name: str
    purpose: str
    code: str
    packages: tuple[str, ...] = ()
    libraries: tuple[str, ...] = ()
    shared: tuple[str, ...] = ()
    programs: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()

    @property
    def in_doubt(self) -> bool:
        """Whether a look, which takes milliseconds, misses something it may need."""
        lacks_program = bool(self.programs) and not any(map(shutil.which, self.programs))
        return lacks_program or not (all(map(_loads, self.shared)) and all(path.exists() for path in self.files))


_WINDOWS = ("libgl1", "libglu1-mesa", "libx11-6", "libxext6", "libxrender1", "libxcursor1", "libxfixes3")
_FENICS = "dolfinx-solver-real"
_HEADER = Path(str(sysconfig.get_config_var("INCLUDEPY"))) / "Python.h"
"""Of the Python that runs; Debian's own has it in a package apart."""
CHECKS = (
    LoadCheck(
        name="gmsh meshes a box",
        purpose="mesh",
        code="""
from geometry.gmsh_session import gmsh_session
with gmsh_session("doctor") as gmsh:
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
""",
        packages=(*_WINDOWS, "libxft2", "libxinerama1", "libfontconfig1"),
        libraries=("gmsh",),
        shared=(
            *("libGLU.so.1", "libGL.so.1", "libX11.so.6", "libXext.so.6", "libXrender.so.1", "libXcursor.so.1"),
            *("libXfixes.so.3", "libXft.so.2", "libXinerama.so.1", "libfontconfig.so.1"),
        ),
    ),
    LoadCheck(
        name="VTK renders a picture",
        purpose="pictures of meshes, the viewer",
        code="""
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Sphere())
assert plotter.screenshot(return_img=True).std() > 1.0, "the picture is empty"
""",
        packages=("libegl1", "libgl1", "libx11-6", "libxcursor1"),
        libraries=("pyvista", "vtk"),
        shared=("libEGL.so.1", "libX11.so.6", "libXcursor.so.1"),
    ),
    LoadCheck(
        name="DOLFINx compiles a form",
        purpose="finite elements; the C compiler",
        code="""
import os
os.environ["XDG_CACHE_HOME"] = os.getcwd()
import numpy as np
from reference_fe import dolfinx_api as api
mesh = api.mesh_from_arrays(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.array([[0, 1, 2, 3]]))
form = api.compile_form(1.0 * api.ufl.dx(domain=mesh))
assert abs(api.fem.assemble_scalar(form) - 1.0) < 1e-12
""",
        packages=("gcc", "libc6-dev", *(() if _HEADER.exists() else ("python3-dev",))),
        libraries=(_FENICS,),
        programs=("cc", "gcc", "clang"),
        files=(_HEADER,),
    ),
    LoadCheck(
        name="MPI starts two processes",
        purpose="--ranks",
        code="""
import subprocess, sys
from workbench.execution.ranks import mpiexec
code = "from reference_fe.dolfinx_api import COMM; assert COMM.allreduce(1) == 2"
subprocess.run([mpiexec(), "-n", "2", sys.executable, "-c", code], check=True)
""",
    ),
    LoadCheck(
        name="Numba compiles a function",
        purpose="ANCF kernels",
        code="import numba; assert numba.njit(lambda x: x + 1)(1) == 2",
        libraries=("numba",),
    ),
    LoadCheck(
        name="Typst sets a page",
        purpose="report.pdf and its fonts",
        code="""
import typst
from workbench.charts.still_charts import font_folder
folders = [str(font_folder())]
known = typst.Fonts(include_system_fonts=False, font_paths=folders).families()
assert {"DejaVu Sans", "Libertinus Serif"} <= set(known), f"fonts: only {known}"
page = typst.compile(b'#set text(font: "DejaVu Sans"); wheel', font_paths=folders, ignore_system_fonts=True)
assert page.startswith(b"%PDF")
""",
    ),
    LoadCheck(name="GDAL loads", purpose="terrain from GeoTIFF", code="import rasterio", libraries=("rasterio",)),
)


def complaint_of(check: LoadCheck) -> str:
    """What goes wrong when it is tried, in one line; empty if nothing does."""
    known = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    known["PYTHONPATH"] = os.pathsep.join(filter(None, (_ROOT, known.get("PYTHONPATH"))))
    with tempfile.TemporaryDirectory(prefix="workbench-doctor-") as folder:
        try:
            ended = subprocess.run(
                [sys.executable, "-c", check.code],
                cwd=folder, env=known, capture_output=True, text=True, errors="replace", check=False, timeout=PATIENCE,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return f"no answer within {PATIENCE:g} s"
    if ended.returncode == 0:
        return ""
    if ended.returncode < 0:
        return f"crashed (signal {-ended.returncode})"
    lines = [line.strip() for line in ended.stderr.splitlines() if line.strip()]
    told = next((line for line in lines if "fatal error:" in line), lines[-1] if lines else "")  # the compiler's
    return told[:_SHOWN] or f"ended with status {ended.returncode}"


def complaints(checks: Sequence[LoadCheck] = CHECKS) -> dict[str, str]:
    """Name of each check -> its complaint, empty if all is well; two at a time."""
    with ThreadPoolExecutor(max_workers=2) as pool:
        return dict(zip((check.name for check in checks), pool.map(complaint_of, checks), strict=True))


def lacking_packages(checks: Iterable[LoadCheck]) -> tuple[str, ...]:
    """Debian packages of the checks that are not installed; all of them where dpkg cannot say."""
    wanted = tuple(dict.fromkeys(package for check in checks for package in check.packages))
    query = shutil.which("dpkg-query")
    if query is None or not wanted:
        return wanted
    command = [query, "--show", "--showformat", "${Package} ${db:Status-Status}\n", *wanted]
    listed = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60).stdout
    present = {line.split()[0] for line in listed.splitlines() if line.endswith(" installed")}
    return tuple(package for package in wanted if package not in present)


def install_command(packages: Sequence[str]) -> str:
    """The one command that installs Debian packages, as root."""
    return f"apt-get install --yes --no-install-recommends {' '.join(packages)}"


def _loads(shared: str) -> bool:
    try:
        ctypes.CDLL(shared)
    except OSError:
        return False
    return True


def require_loadable(tasks: Sequence[Task]) -> None:
    """Before anything is computed: raise a `RunError` with the command that mends it if a task's library cannot load.

    Costs milliseconds where the system's libraries are there; else what lacks one is tried.
    """
    libraries = {library for task in tasks for library in reached_libraries(task.function.partition(":")[0])}
    checks = [check for check in CHECKS if libraries & set(check.libraries) and check.in_doubt]
    found = complaints(checks) if checks else {}
    failed = [check for check in checks if found[check.name]]
    if not failed:
        return
    told = "; ".join(f"{check.name}: {found[check.name]}" for check in failed)
    packages = lacking_packages(failed)
    advice = f"as root: {install_command(packages)}" if packages else "workbench doctor"
    raise RunError(f"nothing was computed, since this machine lacks what the study needs ({told}); {advice}")
