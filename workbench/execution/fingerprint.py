"""Fingerprints: the SHA-256 of everything a result depends on, and of files.

Verified by tests/unit/test_workbench_store.py.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

__all__ = ["canonical_json", "file_sha256", "library_versions", "text_sha256"]


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


def library_versions(names: Sequence[str]) -> Mapping[str, str]:
    """Installed version of each distribution, ``"missing"`` where there is none."""
    return {name: _version(name) for name in names}


@cache
def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "missing"
