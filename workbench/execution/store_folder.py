"""Which folder is a store of ours, and which names in it are: nothing else in a store is ever touched.

A store is marked by a file of its own. One made before there was a marker is recognised by what lies in it. Verified by
tests/unit/test_workbench_store_folder.py.
"""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

from contracts.errors import InputError

__all__ = ["ANNOUNCEMENT", "CHECKPOINT", "KEPT", "KEY", "LOG", "MARKER", "SCRATCH", "holds_a_store", "make_store"]

MARKER = ".workbench-store"
"""File that says that a folder is a store; what it holds does not matter."""
_TEXT = "A store of results of the Wheel Workbench. Make room with: workbench results prune\n"
KEPT = "kept"
"""Folder of the store that takes what others had put among our files."""
KEY = re.compile(r"[0-9a-f]{64}")
CHECKPOINT = re.compile(r"([0-9a-f]{64})\.npz|\.([0-9a-f]{64})-.+\.npz")
"""A checkpoint, or one that was being written."""
SCRATCH = re.compile(r"(?P<host>.+)-(?P<pid>\d+)-[0-9a-f]{8}")
LOG = re.compile(r"run-(?P<pid>\d+)\.log")
ANNOUNCEMENT = re.compile(r".+-\d+\.json")

_FOLDERS = {
    "tmp": SCRATCH,
    "log": LOG,
    "checkpoints": CHECKPOINT,
    "claims": KEY,
    "runs": ANNOUNCEMENT,
    KEPT: re.compile(".*"),
}
_WRITTEN_FIRST = ("tmp", "log", "checkpoints")


def holds_a_store(root: Path) -> bool:
    """Whether a folder is marked as a store, or is one beyond doubt of an earlier version; not if it is empty."""
    try:
        names = _names(root)  # before the marker is looked for: whoever makes a store writes that first
        return (root / MARKER).is_file() or (bool(names) and not _foreign(root, names))
    except (FileNotFoundError, NotADirectoryError):
        return False


def make_store(root: Path) -> bool:
    """Make a store of a folder that is one, or is empty, or not there; whether it can be written.

    Raises
    ------
    InputError
        If the folder holds something else, or cannot be made; nothing was made in it then.
    """
    try:
        root.mkdir(parents=True, exist_ok=True)
        names = _names(root)
        if not (root / MARKER).is_file() and (foreign := _foreign(root, names)):
            rule = f"is no store of results: it is not empty, and {foreign} in it is not of a store"
            raise InputError("result store", root, rule, "give --store a folder of its own, empty or new")
        if not os.access(root, os.W_OK) and names:
            return False
        if not (root / MARKER).is_file():
            (root / MARKER).write_text(_TEXT, encoding="utf-8")
        for name in _WRITTEN_FIRST:
            (root / name).mkdir(exist_ok=True)
    except OSError as error:
        rule = f"cannot be used: {error.filename} cannot be a folder of results ({error.strerror})"
        raise InputError("result store", root, rule, "choose another with --store") from error
    return True


def _foreign(root: Path, names: list[str]) -> str:
    """Name of something in an unmarked folder that is not of a store; ``""`` if it holds a result of ours, or no file.

    A store that holds a result is one beyond doubt, whatever else was put into it. Names alone prove nothing: other
    programs keep files under 64 hexadecimal digits too.
    """
    if any(_is_result(path) for path in root.glob("[0-9a-f][0-9a-f]/*/manifest.json")):
        return ""
    return next((name for name in sorted(names) if not _is_ours(root / name)), "")


def _names(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir()]


def _is_ours(path: Path) -> bool:
    if path.name == MARKER or path.name == "lock":
        return path.is_file() and path.stat().st_size <= len(_TEXT)
    if path.is_symlink() or not path.is_dir():
        return False
    return path.name in _FOLDERS and not _names(path)


def _is_result(path: Path) -> bool:
    """Whether this is the manifest of a result, which lies in a folder named by its key."""
    key = path.parent.name
    if not (KEY.fullmatch(key) and key.startswith(path.parent.parent.name)):
        return False
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return bool(found["key"] == key and isinstance(found["files"], dict))
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False
