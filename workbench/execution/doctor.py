"""What is installed, what is missing, how to get it. Verified by tests/end_to_end/test_commands.py."""

from __future__ import annotations

import os
import platform
import shutil
import sys
from dataclasses import dataclass

from workbench.execution.fingerprint import library_versions

__all__ = ["NEEDED", "Finding", "examine"]

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


def examine() -> list[Finding]:
    """Look at Python, the compiler and every library, without importing any of them."""
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
    compiler = next((c for c in ("cc", "gcc", "clang") if shutil.which(c)), None)
    findings.append(
        Finding(
            name="C compiler",
            found=compiler or "missing",
            purpose="element kernels of DOLFINx",
            advice="" if compiler else "install one, e.g. `apt-get install gcc`",
        )
    )
    for name, version in library_versions(tuple(NEEDED)).items():
        advice = f"install it: `uv pip install {name}`, or `make setup`" if version == "missing" else ""
        findings.append(Finding(name=name, found=version, purpose=NEEDED[name], advice=advice))
    return findings
