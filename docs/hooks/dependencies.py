"""The tables of docs/reference/dependencies.md from the installed packages' own metadata.

    python docs/hooks/dependencies.py        writes the page's tables anew

Verified by tests/unit/test_dependencies.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PAGE = Path(__file__).parents[1] / "reference" / "dependencies.md"
PROJECT = "wheel-workbench"
PURPOSES = {
    "aiohttp": "the viewer's pages and who may see them",
    "cmaes": "points of a search (`workbench sweep`, `optimise`)",
    "distributed": "many machines (`--scheduler`); only with the extra `dask`",
    "dolfinx-solver-real": "finite elements: DOLFINx with PETSc and MUMPS, compiled",
    "gmsh": "meshes and STEP files",
    "jinja2": "templates of the report",
    "matplotlib": "still figures",
    "meshio": "field files (.vtu)",
    "msgpack": "the viewer's messages, checked before they are believed",
    "numba": "compiled kernels",
    "numpy": "arrays",
    "objective-rating-metrics": "rating of curves, ISO/TS 18571",
    "pandas": "curves and checks as tables, from Python",
    "pillow": "pictures in the report",
    "pint": "units in study files",
    "plotly": "curves in the report",
    "pyarrow": "tables of parameter studies (Parquet)",
    "pydantic": "checks of study files",
    "pyvista": "pictures and scenes, with VTK",
    "rainflow": "cycles of the wheels' loads, counted (`workbench traverse`)",
    "rasterio": "terrain from GeoTIFF, with GDAL",
    "rich": "tables and progress on the terminal",
    "scipy": "sparse matrices, splines, statistics",
    "shapely": "exact distances between polylines",
    "tomlkit": "study files written with a change, comments kept",
    "trame": "the viewer's page",
    "trame-vtk": "the viewer's 3D view",
    "typer": "the command line",
    "typst": "the report as PDF",
}
COPYLEFT = re.compile(r"\bA?L?GPL|General Public|MPL|Mozilla|EPL|CDDL", re.IGNORECASE)


def licence(found: Distribution) -> str:
    """What a package says of its licence: expression, classifiers, a short field, or the first line of its file."""
    meta = found.metadata
    classes = [c.split(" :: ")[-1] for c in meta.get_all("Classifier") or [] if c.startswith("License ::")]
    classes = [c for c in classes if c != "OSI Approved"]
    said = meta.get("License-Expression") or ", ".join(classes) or meta.get("License") or ""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    if len(lines) == 1 and len(lines[0]) <= 100:
        return lines[0]
    texts = [file for file in found.files or [] if re.search(r"licen[cs]e|copying", file.name, re.IGNORECASE)]
    lines += [line.strip() for file in texts[:1] for line in file.read_text().splitlines() if line.strip()]
    return lines[0][:100] if lines else "not stated in the package"


def run_time() -> tuple[dict[str, Distribution], dict[str, Distribution]]:
    """What this project asks for itself, with its extras, and what that asks for in turn."""
    direct = dict(_asked(distribution(PROJECT), {"dask"}))
    found, waiting = dict(direct), list(direct.values())
    while waiting:
        new = {name: each for name, each in _asked(waiting.pop(), set()) if name not in found}
        found |= new
        waiting += new.values()
    return direct, {name: each for name, each in found.items() if name not in direct}


def _asked(found: Distribution, extras: set[str]) -> Iterator[tuple[str, Distribution]]:
    for text in found.requires or []:
        need = Requirement(text)
        if need.marker is None or any(need.marker.evaluate({"extra": extra}) for extra in (extras or {""}) | {""}):
            try:
                yield canonicalize_name(need.name), distribution(need.name)
            except PackageNotFoundError:  # of another extra or system
                continue


def tables() -> str:
    """Both tables: name, purpose or nothing, licence; versions stand in constraints.txt."""
    direct, further = run_time()
    rows = ["| package | for | licence |", "|---|---|---|"]
    rows += [f"| {name} | {PURPOSES[name]} | {_cell(direct[name])} |" for name in sorted(direct)]
    rows += ["", "What these bring along:", "", "| package | licence |", "|---|---|"]
    rows += [f"| {name} | {_cell(further[name])} |" for name in sorted(further)]
    return "\n".join(rows)


def _cell(found: Distribution) -> str:
    text = licence(found).replace("|", "/")
    return f"**{text}**" if COPYLEFT.search(text) else text


def written(page: str) -> str:
    """The page with its tables anew."""
    head, mark, rest = page.partition("<!-- tables -->\n")
    tail = rest.partition("<!-- end of tables -->")[2]
    return f"{head}{mark}\n{tables()}\n\n<!-- end of tables -->{tail}"


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
