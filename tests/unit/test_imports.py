"""Which package may import which, and which heavy library is confined to where.

Claim: packages import one way, contracts <- geometry <- {reference_fe, ancf_reduced}, contracts <- rover_dynamics,
everything <- workbench, and the two wheel models never see each other (shared kernels would share mistakes). Heavy
libraries stay in the modules that need them, and none is loaded by ``workbench --help``. Source: the architecture in
README.md. Negative control: synthetic packages with each kind of forbidden import are caught.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
ARROWS: dict[str, set[str]] = {
    "contracts": set(),
    "geometry": {"contracts"},
    "soil": {"contracts"},
    "reference_fe": {"contracts", "geometry", "soil"},
    "ancf_reduced": {"contracts", "geometry", "soil"},
    "rover_dynamics": {"contracts", "soil"},
    "workbench": {"contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics"},
}
FENICS = ("dolfinx", "dolfinx_solver", "petsc4py", "mpi4py", "ufl", "basix", "ffcx")
FRONT = ("pydantic", "pint", "typer", "rich", "jinja2", "plotly", "distributed")
CONFINED: dict[str, set[str]] = {
    **{library: {"reference_fe"} for library in FENICS},
    **{library: {"workbench"} for library in FRONT},
    "gmsh": {"geometry"},
    "rasterio": {"workbench"},
}
"""Library -> the packages that may import it."""
ONE_MODULE = (
    "gmsh",
    "meshio",
    "plotly",
    "matplotlib",
    "pandas",
    "pyvista",
    "pint",
    "jinja2",
    "distributed",
    "rasterio",
    "pyarrow",
    "trame",
)
"""Libraries imported by at most one module of a package."""
SECOND = {"pyvista": {"workbench/viewer/scene.py"}}
"""More modules that may: the viewer's scene lives as long as the page; stills are drawn and gone."""
NEVER_ON_HELP = {
    *("gmsh", "petsc4py", "dolfinx", "mpi4py", "vtk", "vtkmodules"),
    *("pyvista", "matplotlib", "numba", "distributed", "rasterio", "pyarrow", "pandas", "trame", "aiohttp"),
}


class Import(NamedTuple):
    """One import statement (or ``import_module("name")`` call): where it stands and the top package it names."""

    package: str
    module: str
    line: int
    target: str


def _targets(node: ast.AST) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.level == 0:
        return [node.module or ""]
    if isinstance(node, ast.Call) and ast.unparse(node.func) in (
        "importlib.import_module",
        "import_module",
        "__import__",
    ):
        return [arg.value for arg in node.args[:1] if isinstance(arg, ast.Constant) and isinstance(arg.value, str)]
    return []


def imports_of(root: Path) -> Iterator[Import]:
    """Every import of another top-level package, at any depth of the code, also inside functions."""
    for package in ARROWS:
        for path in sorted((root / package).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                for name in _targets(node):
                    target = name.split(".")[0]
                    if target != package:
                        yield Import(package, str(path.relative_to(root)), getattr(node, "lineno", 0), target)


def violations(root: Path) -> list[str]:
    """One sentence for each import that breaks a rule."""
    found, users = [], defaultdict(set)
    for package, module, line, target in imports_of(root):
        users[package, target].add(module)
        if target in ARROWS and target not in ARROWS[package]:
            found.append(f"{module}:{line}: {package} must not import {target}")
        if package not in CONFINED.get(target, {package}):
            found.append(f"{module}:{line}: {target} belongs to {sorted(CONFINED[target])} only")
        if package == "contracts" and target not in {"contracts", "numpy"} | sys.stdlib_module_names:
            found.append(f"{module}:{line}: contracts may import numpy only, not {target}")
    for (package, target), modules in users.items():
        if target in ONE_MODULE and len(modules - SECOND.get(target, set())) > 1:
            found.append(f"{package}: {target} is imported in {sorted(modules)}, one module is allowed")
    return found


def loaded_by(statement: str) -> set[str]:
    """Modules in ``sys.modules`` of a fresh interpreter after ``statement``."""
    code = f"import sys\n{statement}\nprint(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return set(run.stdout.split())


def test_every_package_is_seen() -> None:
    assert all((ROOT / package / "__init__.py").is_file() for package in ARROWS)
    assert {"contracts", "numpy"} <= {item.target for item in imports_of(ROOT)}


def test_imports_point_one_way_and_heavy_libraries_stay_where_they_belong() -> None:
    assert violations(ROOT) == []


def test_help_loads_no_heavy_library() -> None:
    assert loaded_by("import workbench.cli") & NEVER_ON_HELP == set()


def test_a_study_is_planned_without_them() -> None:
    """What is wrong with a study is told after a second, not after three."""
    planned = "from workbench.commands.report import *\nfrom workbench.study.reading import *\n"
    planned += "from workbench.questions.study_graph import *\nreport_tasks(read_study(built_in_study()))"
    assert loaded_by(planned) & {*NEVER_ON_HELP, "scipy.stats"} == set()


def test_the_python_interface_costs_nothing_before_it_is_used() -> None:
    assert loaded_by("import workbench as ww\ndir(ww)") & {*NEVER_ON_HELP, *CONFINED, "numpy", "scipy"} == set()
    read = "import workbench as ww\nstudy = ww.read_study()\nww.stiffness, ww.read_report"
    assert loaded_by(read) & {*NEVER_ON_HELP, "typer", "rich"} == set()


def test_negative_control_the_probe_sees_a_heavy_library() -> None:
    assert "matplotlib" in loaded_by("import matplotlib")


@pytest.mark.parametrize(
    ("module", "source", "message"),
    [
        ("reference_fe/a.py", "from ancf_reduced.plate import x", "reference_fe must not import ancf_reduced"),
        ("ancf_reduced/a.py", "import reference_fe", "ancf_reduced must not import reference_fe"),
        ("geometry/a.py", "def f():\n    import workbench.cli", "geometry must not import workbench"),
        ("contracts/a.py", "from geometry import WheelDesign", "contracts must not import geometry"),
        ("contracts/a.py", "import scipy.sparse", "contracts may import numpy only, not scipy"),
        ("rover_dynamics/deep/a.py", "import ancf_reduced.tire as t", "rover_dynamics must not import ancf_reduced"),
        ("ancf_reduced/a.py", "import importlib\nimportlib.import_module('reference_fe.x')", "reference_fe"),
        ("workbench/a.py", "from petsc4py import PETSc", "petsc4py belongs to ['reference_fe'] only"),
        ("ancf_reduced/a.py", "if True:\n    import gmsh", "gmsh belongs to ['geometry'] only"),
    ],
)
def test_negative_control_a_forbidden_arrow_is_caught(tmp_path: Path, module: str, source: str, message: str) -> None:
    path = tmp_path / module
    path.parent.mkdir(parents=True)
    path.write_text(source, encoding="utf-8")
    assert [text for text in violations(tmp_path) if text.startswith(module) and message in text]


def test_negative_control_a_second_module_with_matplotlib_is_caught(tmp_path: Path) -> None:
    (tmp_path / "workbench").mkdir()
    (tmp_path / "workbench" / "a.py").write_text("import matplotlib.pyplot", encoding="utf-8")
    assert violations(tmp_path) == []
    (tmp_path / "workbench" / "b.py").write_text("from matplotlib import cm", encoding="utf-8")
    assert violations(tmp_path) == [
        "workbench: matplotlib is imported in ['workbench/a.py', 'workbench/b.py'], one module is allowed"
    ]


def test_allowed_arrows_pass(tmp_path: Path) -> None:
    for package, targets in ARROWS.items():
        (tmp_path / package).mkdir()
        text = "import math\nimport numpy as np\n" + "".join(f"import {target}\n" for target in sorted(targets))
        (tmp_path / package / "a.py").write_text(text, encoding="utf-8")
    assert violations(tmp_path) == []
