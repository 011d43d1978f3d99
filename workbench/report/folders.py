"""The user's folder, checked before anything runs.

Verified by tests/unit/test_workbench_outputs.py and tests/end_to_end/test_compare.py.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from contracts.errors import InputError

__all__ = ["check_folder", "check_targets"]


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
        if target.parent.exists() and out.exists() and target.parent.stat().st_dev != out.stat().st_dev:
            rule = f"lies on another disk than {out}, so that no file can be put there whole"
            raise InputError("output folder", target.parent, rule, "choose another folder with --out")
