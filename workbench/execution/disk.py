"""Which disk is full: Python's error often names neither file nor disk, and what libraries say of it is no help.

The places a command writes to are the result store, the output folder, temporary files, caches of compiled functions
and, where MPI runs, shared memory. An error that names its file is about that one; else it is about the place with the
least room. One on standard output names it (`standard_streams.name_errors`), and no disk is blamed for that.

Verified by tests/unit/test_execution_disk.py and tests/end_to_end/test_disk.py.
"""

from __future__ import annotations

import errno
import os
import resource
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from contracts.memory import shown_size
from workbench.execution.errors import DiskFullError
from workbench.execution.standard_streams import STANDARD_OUTPUT

__all__ = ["OUT", "STORE", "STUDY", "disk_full", "naming_the_disk", "no_room", "where_full"]

STORE = "result store"
OUT = "output folder"
STUDY = "study file"
_FULL = frozenset((errno.ENOSPC, errno.EDQUOT, errno.EFBIG))
_ROOM = 1_000_000
"""With less free than this [bytes] a disk counts as full where an error of another kind came up."""
_GO_ON = "; finished results are kept, start again to go on"
_ADVICE = {
    STORE: "choose another with --store",
    OUT: "choose another with --out",
    "temporary files": "set TMPDIR to another folder",
    "cache": "set XDG_CACHE_HOME to another folder",
    "compiled functions": "set NUMBA_CACHE_DIR to another folder",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class _Disk:
    """One place and the disk it is on; free and total [bytes]."""

    what: str
    path: Path
    mount: Path
    free: int
    total: int

    def __str__(self) -> str:
        room = f"{shown_size(self.free)} of {shown_size(self.total)} free"
        return f"the disk mounted at {self.mount}, which holds the {self.what} {self.path} ({room})"


def disk_full(error: BaseException, places: Mapping[str, Path] | None = None) -> str:
    """What is to be said of an error if it came of a full disk: which disk, what to try; ``""`` if it did not.

    Parameters
    ----------
    error : as raised; its causes are looked at, too
    places : what was being written, e.g. ``{STORE: folder}``, beside those that every command uses
    """
    found = _full_error(error)
    if found is None:
        return ""
    reason, name = found.strerror or "the disk is full", found.filename2 or found.filename
    if found.errno == errno.EFBIG:
        where = f"{name}: " if name else ""
        return f"{reason}: {where}{_longest()}{'' if STUDY in (places or {}) else _GO_ON}"
    if name == STANDARD_OUTPUT:
        return f"{STANDARD_OUTPUT}: {reason}; check path and space"
    disk = _blamed(found, places or {})
    return f"{reason}: {disk}; {_advice(disk)}"


def _longest() -> str:
    longest = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
    if longest == resource.RLIM_INFINITY:
        return "a file may not be longer on this file system"
    return f"a file may not be longer than {shown_size(longest)} (ulimit -f); raise this limit"


def where_full(places: Mapping[str, Path] | None = None) -> str:
    """The disk among the places that has no room left, in words; ``""`` if there is room on each."""
    full = [disk for disk in _disks(places or {}) if disk.free < _ROOM and disk.total > 0]
    return f"there is no room on {full[0]}; {_advice(full[0])}" if full else ""


def no_room(folder: Path) -> bool:
    """Whether not a byte can be written into a folder any more: what was written last may be cut off."""
    state = os.statvfs(folder)
    return state.f_blocks > 0 and _free(state) == 0


@contextmanager
def naming_the_disk(what: str, path: Path) -> Iterator[None]:
    """Make of a full disk, while something is written to a path, an error that says so."""
    try:
        yield
    except OSError as error:
        text = disk_full(error, {what: path})
        if not text:
            raise
        raise DiskFullError(text) from error


def _full_error(error: BaseException | None) -> OSError | None:
    while error is not None:
        if isinstance(error, OSError) and error.errno in _FULL:
            return error
        error = error.__cause__ or error.__context__
    return None


def _blamed(error: OSError, places: Mapping[str, Path]) -> _Disk:
    """The disk an error is about."""
    disks = _disks(places)
    name = error.filename2 or error.filename  # of a copy, where to
    if isinstance(name, str):
        named = Path(name).absolute()
        around = [disk for disk in disks if named.is_relative_to(disk.path)]
        return max(around, key=lambda disk: len(disk.path.parts), default=None) or _disk("file", named)
    return disks[0]


def _disks(places: Mapping[str, Path]) -> Sequence[_Disk]:
    """Every place that is written to, that with the least room first; of two on one disk, the named one."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    compiled = Path(os.environ.get("NUMBA_CACHE_DIR") or Path(__file__).parents[2])
    common = {"temporary files": _temporary(), "cache": cache, "compiled functions": compiled}
    common["shared memory"] = Path("/dev/shm")
    return sorted((_disk(what, path) for what, path in {**places, **common}.items()), key=lambda disk: disk.free)


def _temporary() -> Path:
    try:
        return Path(tempfile.gettempdir())
    except OSError:  # none of the usual folders takes a file any more
        return Path(os.environ.get("TMPDIR") or "/tmp")


def _disk(what: str, path: Path) -> _Disk:
    path = path.absolute()
    there = next(folder for folder in (path, *path.parents) if folder.exists())
    state = os.statvfs(there)
    mount = next(folder for folder in (there, *there.parents) if folder.is_mount() or folder == folder.parent)
    free = 0 if state.f_files and not state.f_favail else _free(state)
    return _Disk(what=what, path=path, mount=mount, free=free, total=state.f_blocks * state.f_frsize)


def _free(state: os.statvfs_result) -> int:
    """What this user may still write [bytes]: root has what is held back from others."""
    return (state.f_bavail if os.geteuid() else state.f_bfree) * state.f_frsize


def _advice(disk: _Disk) -> str:
    other = _ADVICE.get(disk.what, "")
    return f"make room{', or ' if other else ''}{other}{'' if disk.what == STUDY else _GO_ON}"
