"""NumPy archives (.npz) that somebody else made: every array is judged by its header before memory is taken for it.

A few kilobytes of ZIP can claim any shape, and deflate packs zeros a thousand to one. Hence arrays are read only if
their members are stored or deflated, claim no pickled objects, and hold as many bytes as shape and type ask for.

Verified by tests/unit/test_archive.py.
"""

from __future__ import annotations

import io
import math
import zipfile
import zlib
from collections.abc import Iterable
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.input_file import input_bytes

__all__ = ["read_archive"]

_LARGEST_DIRECTORY = 1_000_000
"""Bytes of a ZIP file's list of members; `zipfile` makes objects of it before anything else."""
_DAMAGED = (
    *(zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, KeyError),
    *(NotImplementedError, RuntimeError, MemoryError, TypeError, OverflowError, SyntaxError, TokenError),
)
"""What damaged archives make of zipfile and NumPy."""


def read_archive(path: Path, what: str, largest: int, names: Iterable[str] | None = None) -> dict[str, NDArray[Any]]:
    """Arrays of an archive by name, of whatever shape and type they have: the caller judges these.

    Parameters
    ----------
    path : the file
    what : what it is, for the message
    largest : bytes that the arrays may take together, and the file
    names : arrays to read, those the archive has; all if not given

    Raises
    ------
    InputError
        If the file cannot be read, is no NumPy archive, holds objects, or claims more than ``largest``.
    """
    content = input_bytes(path, what, largest)
    try:
        return _arrays(path, what, content, largest, None if names is None else set(names))
    except InputError:
        raise
    except _DAMAGED as error:
        reason = f"cannot be read as a NumPy archive of plain arrays ({type(error).__name__}: {str(error)[:120]})"
        raise InputError(what, path, reason, "write it with numpy.savez") from error


def _arrays(path: Path, what: str, content: bytes, largest: int, names: set[str] | None) -> dict[str, NDArray[Any]]:
    _check_directory(content)
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {member.filename.removesuffix(".npy"): member for member in archive.infolist()}
        wanted = {name: member for name, member in members.items() if names is None or name in names}
        size = sum(_claimed(archive, member) for member in wanted.values())
        if size > largest:
            value = f"{path}, arrays of {size / 1e6:.3g} MB"
            raise InputError(what, value, f"must take at most {largest / 1e6:.3g} MB", "give a smaller one")
        found = {}
        for name, member in wanted.items():
            with archive.open(member) as stream:
                found[name] = np.asarray(npy.read_array(stream, allow_pickle=False))
        return found


def _check_directory(content: bytes) -> None:
    """Raise ValueError unless the file ends as NumPy's archives do, in a short list of members."""
    end = content[-42:]
    if end[-22:-18] != b"PK\5\6" or end[:4] == b"PK\6\7":
        raise ValueError("does not end as one")
    if int.from_bytes(end[-10:-6], "little") > _LARGEST_DIRECTORY:
        raise ValueError("has too many members")


def _claimed(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> int:
    """Bytes of one array by its header; raises ValueError if it is none, or does not fit its member."""
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or member.flag_bits & 1:
        raise ValueError(f"{member.filename!r} is packed in another way than NumPy does")
    with archive.open(member) as content:
        version = npy.read_magic(content)
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f"{member.filename!r} has version {version}")
        header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, _, kind = header(content)
        if kind.hasobject:
            raise ValueError(f"{member.filename!r} holds Python objects")
        if any(n < 0 for n in shape):
            raise ValueError(f"{member.filename!r} has shape {shape}")
        size = math.prod(shape) * kind.itemsize
        if size != member.file_size - content.tell():
            raise ValueError(f"{member.filename!r} claims {size} bytes and has {member.file_size - content.tell()}")
    return size
