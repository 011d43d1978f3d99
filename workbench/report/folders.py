"""The user's folder: checked before anything runs, files put into it whole.

Verified by tests/unit/test_workbench_outputs.py and tests/end_to_end/test_compare.py.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from contracts.errors import InputError

__all__ = ["check_folder", "check_targets", "copy_files", "put_files"]


def check_folder(out: Path) -> None:
    """Make sure before any computing that ``out`` can be a folder of ours."""
    for folder in (out, *out.absolute().parents):
        if folder.is_symlink() and not folder.exists():
            rule = f"cannot be made: {folder} is a link to nothing"
            raise InputError("output folder", out, rule, "mend the link or choose another with --out")
    probe = next(p for p in (out, *out.absolute().parents) if p.exists())
    if not probe.is_dir():
        raise InputError("output folder", out, f"cannot be made: {probe} is a file", "choose another with --out")
    if not os.access(probe, os.W_OK):
        raise InputError("output folder", out, "cannot be written", "choose another with --out")


def check_targets(out: Path, names: Iterable[str]) -> None:
    """Make sure that each file of these names (with ``/`` for folders in it) can take its place in ``out``."""
    for name in names:
        target = out / name
        hint = "move it away or choose another folder with --out"
        if target.is_dir():
            raise InputError("output file", target, "is a folder", hint)
        if (target.parent.exists() or target.parent.is_symlink()) and not target.parent.is_dir():
            raise InputError("output folder", target.parent, "is not a folder", hint)


def copy_files(folder: Path, names: Sequence[str], out: Path) -> list[Path]:
    """Copy a task's files into the user's folder, each put in place whole; returns where they are."""
    out.mkdir(parents=True, exist_ok=True)
    check_targets(out, names)
    for name in names:
        fresh = out / f".{name}.new-{os.getpid()}"
        shutil.copyfile(folder / name, fresh)
        fresh.replace(out / name)
    return [out / name for name in names]


def put_files(out: Path, contents: Mapping[str, bytes]) -> None:
    """Write files by name into the user's folder, each put in place whole, the last one last."""
    out.mkdir(parents=True, exist_ok=True)
    check_targets(out, contents)
    fresh = {name: out / f".{name}.new-{os.getpid()}" for name in contents}
    try:
        for name, content in contents.items():
            fresh[name].write_bytes(content)
        for name, path in fresh.items():
            path.replace(out / name)
    finally:
        for path in fresh.values():
            path.unlink(missing_ok=True)
