"""What a task's function can reach: the modules of ours it imports, at any depth and moment, and their data files.

Found from the text of the imports, nothing is imported: this stays cheap for packages that load PETSc or gmsh. Imports
within functions and in programs kept as text count, those for types alone do not. A package's ``__init__`` counts only
where it is named itself: that ``geometry.build`` is imported does not make the names that ``geometry`` collects an
input. A data file counts where a module of its package that is reached names it.

Verified by tests/unit/test_reach.py and, against what workers load, tests/end_to_end/test_reached.py.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import importlib.util
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

__all__ = ["PACKAGES", "reached", "reached_libraries", "source_hash"]

PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench")
_PUBLISHED, _TABLES = "contracts.published", "contracts/published/"
"""Its tables are named without their ending."""
_DISTRIBUTIONS = {
    **dict.fromkeys(("dolfinx", "dolfinx_solver", "petsc4py"), ("dolfinx-solver-real", "fenics-ffcx")),
    **{"ufl": ("fenics-ufl",), "basix": ("fenics-basix",), "ffcx": ("fenics-ffcx",)},
    **{"PIL": ("pillow",), "pyvista": ("pyvista", "vtk"), "pydantic": ("pydantic", "pydantic-core")},
    "pydantic_core": ("pydantic-core",),
    "objective_rating_metrics": ("objective-rating-metrics",),
}
"""Name of an import -> the distributions behind it, where it is not its own."""
_ELSEWHERE = {"dolfinx-solver-real": ("fenics-dolfinx", "petsc4py")}
"""Distribution -> those of Debian and conda that bring the same."""
_IMPORT = re.compile(r"^ *(?:from ([\w.]+) import (\([^)]*\)|.+)|import (.+))", re.MULTILINE)
_COMMENT = re.compile("#.*")
_TYPES_ALONE = re.compile(r"^( *)if TYPE_CHECKING:\n(?:\1 .*\n|\n)*", re.MULTILINE)
_WORD = re.compile(r"[\"']([\w.-]+)[\"']")
"""Reading the text costs a quarter of parsing it; tests/unit/test_reach.py parses every module and finds the same."""


@cache
def reached(module: str) -> Mapping[str, str]:
    """SHA-256 of each source and data file that a module can reach, itself among them, by name, sorted.

    Names are those of modules, ``"geometry.build"``, and for data files the path in their package,
    ``"rover_dynamics/rover/ranges.toml"``. Raises ModuleNotFoundError for a module that is nowhere.
    """
    found, waiting = {module}, [module]
    while waiting:
        new = _named(waiting.pop()).modules - found
        found |= new
        waiting += new
    data = {name for one in found for name in _data_of(one, _PUBLISHED in found)}
    return {name: source_hash(name) for name in sorted(found | data)}


@cache
def reached_libraries(module: str) -> tuple[str, ...]:
    """Distributions of the libraries that a module can reach, sorted."""
    names = {name for one in reached(module) if "/" not in one for name in _named(one).libraries}
    whole = {found for name in names for found in _DISTRIBUTIONS.get(name, (name,))}
    return tuple(sorted({found for name in whole for found in _installed(name)}))


@cache
def _installed(distribution: str) -> tuple[str, ...]:
    """The distribution, or those that stand for it where it is not installed."""
    try:
        importlib.metadata.distribution(distribution)
    except importlib.metadata.PackageNotFoundError:
        return _ELSEWHERE.get(distribution, (distribution,))
    return (distribution,)


@cache
def source_hash(name: str) -> str:
    """SHA-256 of the text of a module, or of a data file, named as in `reached`."""
    if "/" in name:
        package, _, rest = name.partition("/")
        return hashlib.sha256((_root(package) / rest).read_bytes()).hexdigest()
    return hashlib.sha256(_file(name).read_bytes()).hexdigest()


@cache
def _root(package: str) -> Path:
    spec = importlib.util.find_spec(package)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"no source found for {package}")
    return Path(spec.origin).parent


def _file(module: str) -> Path:
    """Source file of a module."""
    package, *parts = module.split(".")
    if not parts and not (_root(package) / "__init__.py").is_file():
        return Path(str(importlib.util.find_spec(package).origin))  # type: ignore[union-attr]
    path = _root(package).joinpath(*parts)
    found = next((p for p in (path / "__init__.py", path.with_suffix(".py")) if p.is_file()), None)
    if found is None:
        raise ModuleNotFoundError(f"no source found for {module}")
    return found


@cache
def _is_module(name: str) -> bool:
    try:
        _file(name)
    except ModuleNotFoundError:
        return False
    return True


@dataclass(frozen=True, slots=True, kw_only=True)
class _Named:
    """What a module's text names: modules of ours, other packages, words in quotes."""

    modules: frozenset[str]
    libraries: frozenset[str]
    words: frozenset[str]


@cache
def _named(module: str) -> _Named:
    text = _TYPES_ALONE.sub("", _file(module).read_text(encoding="utf-8"))
    imported = set[str]()
    for package, names, packages in _IMPORT.findall(_COMMENT.sub("", text)):
        if packages:
            imported |= {name.split()[0] for name in packages.split(",")}
        else:
            imported |= _from(package, [name.split()[0] for name in names.strip("()").split(",") if name.strip()])
    ours = frozenset(name for name in imported if name.partition(".")[0] in PACKAGES)
    tops = {name.partition(".")[0] for name in imported - ours}
    return _Named(
        modules=ours, libraries=frozenset(tops - sys.stdlib_module_names), words=frozenset(_WORD.findall(text))
    )


def _from(package: str, names: list[str]) -> set[str]:
    """Modules behind ``from a.b import c``: ``a.b.c`` where that is one, else ``a.b``, which has a name ``c``."""
    if package.partition(".")[0] not in PACKAGES:
        return {package}
    return {whole if _is_module(whole) else package for whole in (f"{package}.{name}" for name in names)}


def _data_of(module: str, published: bool) -> Iterator[str]:
    """Data files of ours that a module names."""
    words, package = _named(module).words, module.partition(".")[0]
    for word in words & _data_files().keys():
        yield from (name for name in _data_files()[word] if name.startswith(f"{package}/"))
    if published:
        yield from (name for word in words for name in _data_files().get(f"{word}.csv", ()) if name.startswith(_TABLES))


@cache
def _data_files() -> Mapping[str, tuple[str, ...]]:
    """Every file of the packages that is no Python, ``"package/folder/name"``, by its name."""
    found: dict[str, tuple[str, ...]] = {}
    for package in PACKAGES:
        root = _root(package)
        files = (p for p in root.rglob("*") if p.suffix not in (".py", ".pyc") and p.is_file())
        for path in sorted(p for p in files if "__pycache__" not in p.parts):
            found[path.name] = (*found.get(path.name, ()), f"{package}/{path.relative_to(root).as_posix()}")
    return found
