"""Opening a file that a user names: an ordinary file of a size that can be read, or one message at once.

A pipe would wait for a writer that never comes, a device such as /dev/zero never ends, a sparse file fills the memory.
Who lets a library open the file (GDAL, zipfile) asks `require_ordinary_file` first. Verified by
tests/unit/test_input_file.py.
"""

from __future__ import annotations

import os
import stat
import tomllib
from pathlib import Path
from typing import Any

from contracts.errors import InputError

__all__ = ["input_bytes", "input_table", "input_text", "require_ordinary_file"]

_MOST = 100_000_000
"""Largest file read at once [byte]: a curve of a million points, the shipped study five thousand times."""
_MOST_TABLE, _MOST_POINTS = 1_000_000, 2000
"""Largest TOML file [byte], and points in one of its lines: reading a key takes a time that grows as their square."""
_DEEPEST = 20
"""Tables and lists within each other; a study has six."""
_KINDS = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket"}


def input_text(path: Path, what: str, most: int = _MOST) -> str:
    """Text of a file in UTF-8, without the byte-order mark that some editors begin it with; raises as `input_bytes`,
    and InputError if it is not UTF-8."""
    try:
        text = input_bytes(path, what, most).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        rule = f"is not UTF-8 text (byte {error.start})"
        raise InputError(what, path, rule, "save the file as text in UTF-8") from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


def input_bytes(path: Path, what: str, most: int = _MOST) -> bytes:
    """Content of an ordinary file.

    Parameters
    ----------
    path : the file
    what : what it is called in messages, such as ``"curve file"``
    most : largest size that is read [byte]

    Raises
    ------
    InputError
        If it does not exist, is a folder, pipe, socket or device, is larger than ``most``, or cannot be read.
    """
    require_ordinary_file(path, what, most)
    try:  # not blocking, and never more than ``most``: the file may have become a pipe or have grown since
        with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as stream:
            content = stream.read(most + 1) or b""
    except OSError as error:
        raise _unreadable(path, what, error) from error
    if len(content) > most:
        raise _too_large(path, what, most)
    return content


def input_table(path: Path, what: str, example: str) -> dict[str, Any]:
    """Content of a TOML file, raising as `input_text`, and InputError if it is none; ``example`` is one to look at."""
    text, hint = input_text(path, what, _MOST_TABLE), f"correct it there; {example} is an example"
    for number, line in enumerate(text.splitlines(), start=1):
        if line.count(".") > _MOST_POINTS:
            raise InputError(what, path, f"has more than {_MOST_POINTS} points in line {number}", hint)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(what, path, f"is not valid TOML: {error}", hint) from error
    except RecursionError as error:
        raise InputError(what, path, "is not valid TOML: brackets in brackets without end", hint) from error
    except ValueError as error:  # Python refuses to turn that many digits into a number
        raise InputError(what, path, "is not valid TOML: a number of thousands of digits", hint) from error
    level: list[Any] = [table]
    for _ in range(_DEEPEST):
        inner = [value for one in level for value in (one.values() if isinstance(one, dict) else one)]
        level = [value for value in inner if isinstance(value, dict | list)]
    if level:
        raise InputError(what, path, f"has tables within tables, more than {_DEEPEST} deep", hint)
    return table


def require_ordinary_file(path: Path, what: str, most: int | None = None) -> None:
    """Raise InputError as `input_bytes` does, without reading; ``most`` [byte] is the largest size, None for any."""
    try:
        found = path.stat()
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the path
        raise _unreadable(path, what, error) from error
    if not stat.S_ISREG(found.st_mode):
        rule = f"is {_KINDS.get(stat.S_IFMT(found.st_mode), 'a device')}, not a file"
        raise InputError(what, path, rule, "give the path of an ordinary file")
    if most is not None and found.st_size > most:
        raise _too_large(path, what, most)


def _too_large(path: Path, what: str, most: int) -> InputError:
    rule = f"is larger than {most / 1e6:g} MB, the most that is read"
    return InputError(what, path, rule, "check that it is the right file")


def _unreadable(path: Path, what: str, error: OSError | ValueError) -> InputError:
    if isinstance(error, FileNotFoundError):
        return InputError(what, path, "does not exist", "check its path")
    said = error.strerror if isinstance(error, OSError) else error
    return InputError(what, path, f"cannot be read ({said})", "check its path and permissions")
