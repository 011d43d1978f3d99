"""Fingerprints: the SHA-256 of everything a result depends on, and of files.

Verified by tests/unit/test_workbench_store.py.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import importlib.util
import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

__all__ = ["canonical_json", "file_sha256", "library_versions", "source_hash", "text_sha256"]


def canonical_json(value: object) -> str:
    """JSON text with sorted keys and shortest round-trip floats: equal values give equal text; refuses NaN."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def text_sha256(text: str) -> str:
    """SHA-256 of UTF-8 text (hexadecimal)."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def file_sha256(path: Path) -> str:
    """SHA-256 of a file's bytes (hexadecimal)."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


@cache
def source_hash(module: str) -> str:
    """SHA-256 of the source of a package (every ``.py`` and data file below it) or of one module.

    The module is found, not imported: this stays cheap for packages that load PETSc or gmsh.
    """
    spec = importlib.util.find_spec(module)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"no source found for {module}")
    origin = Path(spec.origin)
    if origin.name != "__init__.py":
        return file_sha256(origin)
    root = origin.parent
    files = sorted(p for p in root.rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    return text_sha256("\n".join(f"{p.relative_to(root).as_posix()} {file_sha256(p)}" for p in files))


def library_versions(names: Sequence[str]) -> Mapping[str, str]:
    """Installed version of each distribution, ``"missing"`` where there is none."""
    return {name: _version(name) for name in names}


@cache
def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "missing"
