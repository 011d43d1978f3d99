"""What is installed, what works, what is missing, how to get it.

Verified by tests/end_to_end/test_commands.py and tests/unit/test_workbench_load_checks.py.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass

from contracts.errors import InputError
from workbench.execution.fingerprint import library_versions
from workbench.execution.load_checks import CHECKS, LoadCheck, complaints, install_command, lacking_packages

__all__ = ["NEEDED", "Examination", "Finding", "examine", "install"]

NEEDED = {
    "dolfinx-solver-real": "finite elements (DOLFINx, PETSc, MUMPS)",
    "gmsh": "mesh",
    "numpy": "arrays",
    "scipy": "linear algebra",
    "numba": "ANCF kernels",
    "pydantic": "study files",
    "pint": "units",
    "typer": "command line",
    "rich": "progress bars",
    "plotly": "curves in the report",
    "pyvista": "pictures of meshes",
    "meshio": "mesh files",
    "objective-rating-metrics": "ISO/TS 18571 rating",
    "jinja2": "report page",
    "pyarrow": "tables of sweeps (Parquet)",
    "rasterio": "terrain from GeoTIFF",
}
"""Distribution -> what it is needed for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One line of the examination: ``advice`` is empty if all is well."""

    name: str
    found: str
    purpose: str
    advice: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Examination:
    """All that was found, and the Debian packages that would mend what fails."""

    findings: tuple[Finding, ...]
    packages: tuple[str, ...]

    @property
    def well(self) -> bool:
        """Whether nothing is missing and everything works."""
        return not any(finding.advice for finding in self.findings)


def examine(checks: Sequence[LoadCheck] = CHECKS) -> Examination:
    """Look at Python and every library's version, then load and use what may fail on this machine."""
    python_ok = sys.version_info >= (3, 12)
    findings = [
        Finding(
            name="python",
            found=platform.python_version(),
            purpose="everything",
            advice="" if python_ok else "needs 3.12 or newer: run `make setup` in the repository",
        ),
        Finding(name="machine", found=f"{platform.machine()}, {os.cpu_count()} cores", purpose="workers"),
    ]
    for name, version in library_versions(tuple(NEEDED)).items():
        advice = f"install it: `uv pip install {name}`, or `make setup`" if version == "missing" else ""
        findings.append(Finding(name=name, found=version, purpose=NEEDED[name], advice=advice))
    tried = complaints(checks)
    failed = [check for check in checks if tried[check.name]]
    findings += [_tried(check, tried[check.name]) for check in checks]
    return Examination(findings=tuple(findings), packages=lacking_packages(failed))


def _tried(check: LoadCheck, complaint: str) -> Finding:
    advice = ""
    if complaint:
        packages = lacking_packages([check])
        advice = f"`{install_command(packages)}`" if packages else "`make distclean setup` in the repository"
    return Finding(name=check.name, found=complaint or "yes", purpose=check.purpose, advice=advice)


def install(packages: Sequence[str]) -> None:
    """Install Debian packages; an `InputError` where that is not ours to do, or if it fails."""
    command = install_command(packages)
    if os.geteuid() != 0 or shutil.which("apt-get") is None:
        raise InputError("--install", "given", "needs root and apt-get", f"let an administrator run: {command}")
    environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    for line in ("apt-get update --quiet", command):
        if subprocess.run(line.split(), env=environment, check=False).returncode != 0:
            raise InputError("--install", line, "failed, see above", f"once it can, run: {command}")
