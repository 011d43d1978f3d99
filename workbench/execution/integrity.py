"""Whether a stored entry is still what was stored, and if not, what is wrong with it.

Verified by tests/unit/test_workbench_store.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from workbench.execution.fingerprint import file_sha256

__all__ = ["MANIFEST", "SCHEMA", "examined", "read_manifest"]

MANIFEST = "manifest.json"
SCHEMA = 1


def examined(path: Path, key: str) -> tuple[dict[str, Any], str]:
    """Manifest of the entry in a folder, and what is wrong in a few words; ``""`` for a whole entry.

    Every file is read and compared with the checksum it was stored with. An entry without a readable manifest has an
    empty one.
    """
    manifest = read_manifest(path)
    if manifest is None:
        state = "cannot be read" if (path / MANIFEST).exists() else "is missing"
        return {}, f"{MANIFEST} {state}"
    if manifest["schema"] != SCHEMA or manifest["key"] != key:
        return manifest, f"{MANIFEST} belongs to another result"
    sizes = manifest.get("sizes", {})
    faults = (_file_fault(path / name, digest, sizes.get(name)) for name, digest in manifest["files"].items())
    return manifest, next((fault for fault in faults if fault), "")


def read_manifest(path: Path) -> dict[str, Any] | None:
    """The manifest in an entry's folder; None if it is missing, cut off, or not one of ours."""
    try:
        manifest = json.loads((path / MANIFEST).read_text(encoding="utf-8"))
        known = isinstance(manifest["files"], Mapping) and {"schema", "key"} <= manifest.keys()
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return manifest if known else None


def _file_fault(path: Path, digest: str, size: int | None) -> str:
    """What is wrong with one file; ``size`` [bytes] as stored, None in entries of earlier versions."""
    try:
        found = path.stat().st_size
        if size is not None and found != size:
            return f"{path.name} has {found} of {size} bytes" if found < size else f"{path.name} has grown"
        return "" if file_sha256(path) == digest else f"{path.name} has been changed since it was stored"
    except FileNotFoundError:
        return f"{path.name} is missing"
    except OSError as error:
        return f"{path.name} cannot be read ({error.strerror})"
