"""Files of a folder that somebody else handed over, such as a report from another machine.

Symbolic links are followed where a user names a file; in a folder handed over as a whole they would make one folder
open the files of another, and are refused if they lead out of it.

Verified by tests/unit/test_foreign_folder.py.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.input_file import input_bytes

__all__ = ["read_json", "require_inside"]

_LARGEST_JSON = 50_000_000
"""[byte]; the summary of a report has 300 kB."""


def require_inside(path: Path, folder: Path, what: str) -> None:
    """Raise InputError if a file of a folder leads out of it by a symbolic link, or to itself."""
    try:
        found = path.resolve()  # from Python 3.13 on, what leads to itself stays a link
        inside = found.is_relative_to(folder.resolve()) and not found.is_symlink()
    except (OSError, RuntimeError):
        inside = False
    if not inside:
        raise InputError(what, path, f"is a link that leads out of {folder}", "put the file itself there")


def read_json(path: Path, what: str, hint: str) -> dict[str, Any]:
    """The table in a JSON file of a folder.

    Parameters
    ----------
    path : file, directly in the folder
    what : what it is, for the message
    hint : what to try if it is something else

    Raises
    ------
    InputError
        If the file leads out of its folder, cannot be read, or is no table in JSON.
    """
    require_inside(path, path.parent, what)
    content = input_bytes(path, what, _LARGEST_JSON)
    try:
        found = json.loads(content.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise InputError(what, path, f"cannot be read as JSON ({type(error).__name__})", hint) from error
    if not isinstance(found, dict):
        raise InputError(what, path, "must be a table in JSON", hint)
    return found
