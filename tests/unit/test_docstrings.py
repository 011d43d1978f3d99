"""Docstrings name the tests that verify the code; each of these tests exists."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench")
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def _named_tests(docstring: str) -> list[str]:
    """Paths below ``tests/`` in every sentence that begins with "Verified by"."""
    sentences = re.findall(r"[Vv]erified by((?:[^.]|\.(?!\s|$))*)", docstring)
    return [path.rstrip("./") for s in sentences for path in re.findall(r"\btests/[\w/*?.-]+", s)]


def _missing(docstring: str) -> list[str]:
    return [path for path in _named_tests(docstring) if not any(ROOT.glob(path))]


def _docstrings(package: str) -> Iterator[tuple[str, str]]:
    for path in sorted((ROOT / package).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, DOCUMENTED) and (text := ast.get_docstring(node)):
                yield f"{path.relative_to(ROOT)}:{getattr(node, 'name', 'module')}", text


@pytest.mark.parametrize("package", PACKAGES)
def test_every_test_named_in_a_docstring_exists(package: str) -> None:
    documented = dict(_docstrings(package))
    assert any(_named_tests(text) for text in documented.values())
    assert {where: _missing(text) for where, text in documented.items() if _missing(text)} == {}


def test_a_path_that_does_not_exist_is_found() -> None:
    tests = ("tests/unit/test_docstrings.py", "tests/unit/test_doc*.py", "tests/unit/test_nowhere.py")
    text = f"Does it.\n\nVerified by {tests[0]},\n{tests[1]} and {tests[2]}."
    assert len(_named_tests(text)) == 3
    assert _missing(text) == ["tests/unit/test_nowhere.py"]
    assert _missing("Verified by tests/verification/test_nowhere_*.py.") == ["tests/verification/test_nowhere_*.py"]
