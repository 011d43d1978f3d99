"""Whether a stored entry is still what was stored, and if not, what is wrong with it.

The manifest holds a checksum of every file, and one of itself; its text is laid out in one way only, so that a change
of any byte of an entry shows. Verified by tests/unit/test_workbench_store.py and tests/unit/test_workbench_damage.py.
"""

from __future__ import annotations

import json
import math
import re
import stat
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from contracts.errors import InputError
from contracts.input_file import input_bytes
from workbench.execution.fingerprint import canonical_json, file_sha256, text_sha256

__all__ = ["MANIFEST", "SCHEMA", "examined", "is_inside", "sealed", "stated", "unsealed"]

MANIFEST = "manifest.json"
SCHEMA = 2
_EARLIER = 1
"""Schema of entries without a checksum of the manifest, which versions before this one wrote."""
_SEAL = "sha256"
_END_OF_TIME = 253402300800.0
"""The year 10000 [s since 1970]."""
_LARGEST = 50_000_000
"""Of a manifest [byte]; ours have some kB."""


def sealed(content: Mapping[str, Any]) -> str:
    """JSON text of a mapping with a checksum of itself."""
    plain = json.loads(canonical_json(content))
    return json.dumps({**plain, _SEAL: text_sha256(canonical_json(plain))}, indent=1, allow_nan=False) + "\n"


def unsealed(text: str) -> dict[str, Any] | None:
    """What `sealed` was given; None if any byte of the text is another."""
    found = _parsed(text)
    if found is None or _SEAL not in found:
        return None
    content = {name: value for name, value in found.items() if name != _SEAL}
    try:
        return content if sealed(content) == text else None
    except (ValueError, RecursionError):
        return None


def examined(path: Path, key: str) -> tuple[dict[str, Any], str]:
    """Manifest of the entry in a folder, and what is wrong in a few words; ``""`` for a whole entry.

    Every file is read and compared with the checksum it was stored with. A manifest that is not to be trusted is empty.
    """
    manifest, fault = stated(path, key)
    if fault:
        return manifest, fault
    sizes = manifest.get("sizes", {})
    faults = (_file_fault(path / name, digest, sizes.get(name)) for name, digest in manifest["files"].items())
    return manifest, next((fault for fault in faults if fault), "")


def stated(path: Path, key: str) -> tuple[dict[str, Any], str]:
    """As `examined`, but the manifest alone is looked at, not the files."""
    try:
        if not (path / MANIFEST).is_file():
            return {}, f"{MANIFEST} is missing"
        text = input_bytes(path / MANIFEST, MANIFEST, _LARGEST).decode("utf-8")
    except OSError as error:
        return {}, f"{MANIFEST} cannot be read ({error.strerror})"
    except (InputError, ValueError):
        return {}, f"{MANIFEST} cannot be read"
    found = _parsed(text)
    if found is None:
        return {}, f"{MANIFEST} cannot be read"
    if (odd := _odd_value(found)) is not None:
        return {}, f"{MANIFEST} has been changed since it was stored: {odd} cannot be"
    if found["schema"] != _EARLIER:
        sealed_ones = unsealed(text)
        if sealed_ones is None:
            return {}, f"{MANIFEST} has been changed since it was stored"
        found = sealed_ones
    return (found, "") if found["key"] == key else ({}, f"{MANIFEST} belongs to another result")


def is_inside(name: str) -> bool:
    """Whether a name, with ``/`` for folders, stays in the folder it belongs to."""
    parts = name.split("/")
    return bool(name) and "\0" not in name and PurePosixPath(*parts).as_posix() == name and ".." not in parts


def _parsed(text: str) -> dict[str, Any] | None:
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def _is_digest(value: object) -> bool:
    return isinstance(value, str) and re.fullmatch("[0-9a-f]{64}", value) is not None


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _END_OF_TIME


def _is_table_of(value: object, is_one: Callable[[object], bool]) -> bool:
    return isinstance(value, dict) and all(is_one(one) for one in value.values())


_RULES: Mapping[str, Callable[[Any], bool]] = {
    "schema": lambda v: type(v) is int and v in (_EARLIER, SCHEMA),
    "key": _is_digest,
    "files": lambda v: _is_table_of(v, _is_digest) and all(is_inside(name) for name in v),
    "stored_at": lambda v: _is_number(v) and v >= 0.0,
    "wall_s": lambda v: _is_number(v) and math.isfinite(v) and v >= 0.0,
    "sizes": lambda v: _is_table_of(v, lambda size: type(size) is int),
    "dofs": lambda v: type(v) is int,
    "task": lambda v: isinstance(v, str),
    "study": lambda v: isinstance(v, str),
    "function": lambda v: isinstance(v, str),
    "inputs": lambda v: isinstance(v, dict),
    "needs": lambda v: _is_table_of(v, _is_digest),
    "origin": lambda v: _is_table_of(v, lambda part: isinstance(part, dict)),
}
_REQUIRED = ("schema", "key", "files", "stored_at", "wall_s")


def _odd_value(manifest: Mapping[str, Any]) -> str | None:
    """Key of the first value that no manifest of ours has, or of one that is missing; None if there is none."""
    wrong = [n for n, rule in _RULES.items() if (n in manifest or n in _REQUIRED) and not rule(manifest.get(n))]
    if manifest.get("schema") == _EARLIER:  # a damaged key name is the one thing that a later one's checksum tells
        wrong += [name for name in manifest if name not in _RULES]
    return next(iter(wrong), None)


def _file_fault(path: Path, digest: str, size: int | None) -> str:
    """What is wrong with one file; ``size`` [bytes] as stored, None in entries of earlier versions."""
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            return f"{path.name} is no file"
        if size is not None and found.st_size != size:
            shorter = found.st_size < size
            return f"{path.name} has {found.st_size} of {size} bytes" if shorter else f"{path.name} has grown"
        return "" if file_sha256(path) == digest else f"{path.name} has been changed since it was stored"
    except FileNotFoundError:
        return f"{path.name} is missing"
    except OSError as error:
        return f"{path.name} cannot be read ({error.strerror})"
