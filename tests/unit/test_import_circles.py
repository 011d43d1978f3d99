"""No module depends on itself by way of others, lazy and type-only imports counted.

Claim: in every package each import, at any depth of the code and under ``TYPE_CHECKING`` too, is an arrow of a graph
without circles, so that a module can be read, tested and moved after those it names. Source: the architecture in
README.md. Negative control: synthetic packages with a lazy, a type-only, a relative and a named circle are caught.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench")


def arrows(root: Path, package: str) -> dict[str, set[str]]:
    """Module -> modules of the package it imports; a package's ``__init__`` goes by the package's name."""
    files = {_name(root, path): path for path in sorted((root / package).rglob("*.py"))}
    return {module: _imported(module, path, set(files)) for module, path in files.items()}


def circles(root: Path, package: str) -> list[list[str]]:
    """Groups of modules each of which reaches, import by import, all others of its group and itself."""
    graph = arrows(root, package)
    reached = {module: _reached(graph, module) for module in graph}
    groups = {frozenset(other for other in reached[m] if m in reached[other]) for m in graph if m in reached[m]}
    return sorted(sorted(group) for group in groups)


def _name(root: Path, path: Path) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def _imported(module: str, path: Path, known: set[str]) -> set[str]:
    named = set[str]()
    folder = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            named |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = ".".join(folder.split(".")[: len(folder.split(".")) + 1 - node.level]) if node.level else ""
            source = ".".join(filter(None, (above, node.module)))
            for alias in node.names:
                inner = f"{source}.{alias.name}"
                named.add(inner if inner in known else source)
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("import_module", "__import__")):
            named |= {str(argument.value) for argument in node.args[:1] if isinstance(argument, ast.Constant)}
    return named & known


def _reached(graph: dict[str, set[str]], start: str) -> set[str]:
    found, todo = set[str](), [start]
    while todo:
        new = graph[todo.pop()] - found
        found |= new
        todo += new
    return found


@pytest.mark.parametrize("package", PACKAGES)
def test_no_module_stands_in_a_circle(package: str) -> None:
    assert sum(map(len, arrows(ROOT, package).values())) > 2  # there is something to see
    assert circles(ROOT, package) == []


@pytest.mark.parametrize(
    "back",
    [
        "def f():\n    from geometry.a import x",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import geometry.a",
        "from . import a",
        "from .a import x",
        "from geometry import a as other",
        "import importlib\nimportlib.import_module('geometry.a')",
    ],
)
def test_negative_control_a_circle_is_caught(tmp_path: Path, back: str) -> None:
    (tmp_path / "geometry").mkdir()
    sources = {"__init__": "", "a": "from geometry.b import y", "b": "from geometry.c import z", "c": ""}
    for name, text in sources.items():
        (tmp_path / "geometry" / f"{name}.py").write_text(text, encoding="utf-8")
    assert circles(tmp_path, "geometry") == []
    (tmp_path / "geometry" / "c.py").write_text(back, encoding="utf-8")
    assert circles(tmp_path, "geometry") == [["geometry.a", "geometry.b", "geometry.c"]]
