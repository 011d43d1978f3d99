"""A file in which a long run keeps arrays, so that a killed run goes on: whole, or known to be damaged.

One NumPy archive without pickle, then the 32 bytes of its SHA-256; put in place by one rename. A damage anywhere in the
file shows. Verified by tests/unit/test_workbench_damage.py.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from contracts.machine import machine

__all__ = ["kept_fault", "read_kept", "write_kept"]

_DIGEST = hashlib.sha256().digest_size
_BLOCK = 1 << 20


def write_kept(path: Path, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Keep these arrays, of any shape and type but Python objects.

    The file that was there stays whole until this one is, and if this one cannot be written.
    """
    fresh = path.with_name(f".{path.stem}-{machine()}-{os.getpid()}.npz")
    try:
        with fresh.open("w+b") as stream:
            np.savez(stream, allow_pickle=False, **arrays)
            size = stream.seek(0, os.SEEK_END)
            stream.write(_digest(stream, size))
            stream.flush()
            os.fsync(stream.fileno())
        fresh.replace(path)
    finally:
        fresh.unlink(missing_ok=True)


def read_kept(path: Path) -> dict[str, NDArray[Any]] | None:
    """The arrays as `write_kept` had them, or None if the file is absent, cannot be read or is damaged in any byte."""
    try:
        with path.open("rb") as stream:
            if not _is_whole(stream):
                return None
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
    except OSError:
        return None


def kept_fault(path: Path) -> str:
    """What is wrong with the file in a few words; ``""`` if it is whole or absent."""
    try:
        with path.open("rb") as stream:
            return "" if _is_whole(stream) else "has been changed since it was written"
    except FileNotFoundError:
        return ""
    except OSError as error:
        return f"cannot be read ({error.strerror})"


def _is_whole(stream: IO[bytes]) -> bool:
    size = stream.seek(0, os.SEEK_END) - _DIGEST
    return size > 0 and _digest(stream, size) == stream.read()


def _digest(stream: IO[bytes], size: int) -> bytes:
    """SHA-256 of the first bytes of a file; leaves it behind them."""
    digest, left = hashlib.sha256(), size
    stream.seek(0)
    while left > 0 and (block := stream.read(min(left, _BLOCK))):
        digest.update(block)
        left -= len(block)
    return digest.digest()
