"""Which files in a user's folder are ours: those a manifest lists, as long as they are what we wrote.

``OUT/.workbench-files.json`` holds, for each file, the SHA-256 of what we wrote and the command that did, and a
checksum of itself. While files are being replaced it lists both contents, so that a run killed in between leaves no
file unknown. Verified by tests/unit/test_workbench_own_files.py.
"""

from __future__ import annotations

import stat
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from contracts.errors import InputError
from contracts.input_file import input_bytes
from workbench.execution.fingerprint import file_sha256
from workbench.execution.integrity import is_inside, sealed, unsealed

__all__ = ["FILES", "OwnFile", "holds", "own_text", "plain_file", "read_own"]

FILES = ".workbench-files.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnFile:
    """One file of ours.

    Attributes
    ----------
    digests : SHA-256 of what it may hold; two while it is being replaced
    by : the command that wrote it
    """

    digests: tuple[str, ...]
    by: str


def read_own(folder: Path) -> dict[str, OwnFile] | None:
    """Our files in a folder by name, with ``/`` for folders in it; None without a manifest that is whole."""
    if not plain_file(folder / FILES):
        return None
    try:
        content = unsealed(input_bytes(folder / FILES, FILES).decode("utf-8"))
    except (InputError, ValueError):
        return None
    listed = None if content is None else content.get("files")
    if not isinstance(listed, dict) or not all(is_inside(name) for name in listed):
        return None
    try:
        return {name: OwnFile(digests=tuple(one["sha256"]), by=str(one["by"])) for name, one in listed.items()}
    except (KeyError, TypeError):
        return None


def own_text(own: Mapping[str, OwnFile]) -> str:
    """Text of the manifest."""
    files = {name: {"sha256": list(one.digests), "by": one.by} for name, one in own.items()}
    return sealed({"schema": 1, "files": files})


def plain_file(path: Path) -> bool:
    """Whether a file is there that is neither a link nor a device: one that can be read to its end."""
    try:
        return stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False


def holds(path: Path, digests: tuple[str, ...]) -> bool:
    """Whether a file is there and its content one of these."""
    return plain_file(path) and file_sha256(path) in digests
