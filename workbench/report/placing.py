"""Puts new files into a user's folder, each whole, and loses nothing of the user's there.

What stands where a new file belongs, or is to go because it is no longer part of the results, is replaced or removed
only if the folder's manifest lists it and it still is what we wrote. A listed file that was edited since is renamed; a
file that is not listed is moved to ``kept-1``, the first such name that is free. Both are told of. Two runs on one
folder wait for each other. Verified by tests/unit/test_workbench_own_files.py.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import shutil
import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from contracts.machine import lives_here, machine
from workbench.execution.fingerprint import file_sha256
from workbench.execution.integrity import is_inside, sealed, unsealed
from workbench.report.folders import check_targets
from workbench.report.own_files import FILES, OwnFile, holds, own_text, read_own

__all__ = ["NewFiles", "copy_files", "keep_foreign", "moved", "new_files", "put_files"]

_PLAN = ".workbench-plan.json"
"""Lists the names of what a folder of new files will hold: no more is removed of one that a killed run left."""
_NEW = re.compile(r"\.workbench-new-(?P<host>.+)-(?P<pid>\d+)-[0-9a-f]{8}")
_SHOWN = 5
"""Names told of, of many files that were kept aside."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewFiles:
    """Files that are being made.

    Attributes
    ----------
    folder : where to write them, by the names they will have; the folders among these are there
    told : sentences on what was kept aside; there once the files are in their places
    """

    folder: Path
    told: list[str] = field(default_factory=list)


@contextlib.contextmanager
def new_files(out: Path, by: str, names: Sequence[str], *, whole_set: bool = False) -> Iterator[NewFiles]:
    """A folder to be filled; at its end every file takes its place in ``out``, none if an error was raised.

    Parameters
    ----------
    out : the user's folder
    by : the command that writes them
    names : what will be written, with ``/`` for folders; the last one takes its place last
    whole_set : files in ``out`` that this command wrote before and does not write now are removed

    Raises
    ------
    InputError
        If a folder stands where a file belongs, or a file where a folder belongs.
    """
    out.mkdir(parents=True, exist_ok=True)
    check_targets(out, names)
    _sweep(out)
    fresh = out / f".workbench-new-{machine()}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    new = NewFiles(folder=fresh)
    try:
        fresh.mkdir()
        (fresh / _PLAN).write_text(sealed({"names": [*names, FILES]}), encoding="utf-8")
        for name in names:
            (fresh / name).parent.mkdir(parents=True, exist_ok=True)
        yield new
        with _alone(out):
            new.told.extend(_placed(out, fresh, {name: file_sha256(fresh / name) for name in names}, by, whole_set))
    finally:
        _remove(fresh, [*names, FILES])


def copy_files(folder: Path, names: Sequence[str], out: Path, by: str) -> list[str]:
    """Copy a task's files into the user's folder; returns what is to be told."""
    with new_files(out, by, names) as new:
        for name in names:
            shutil.copyfile(folder / name, new.folder / name)
    return new.told


def put_files(out: Path, contents: Mapping[str, bytes], by: str) -> list[str]:
    """Write files by name into the user's folder, the last one last; returns what is to be told."""
    with new_files(out, by, list(contents)) as new:
        for name, content in contents.items():
            (new.folder / name).write_bytes(content)
    return new.told


def _placed(out: Path, fresh: Path, digests: Mapping[str, str], by: str, whole_set: bool) -> list[str]:
    """Keep aside what is not ours, then replace and remove what is; sentences on the former."""
    listed = read_own(out)
    own, told = listed or {}, list[str]()
    foreign = [name for name, digest in digests.items() if name not in own and _differs(out / name, digest)]
    if listed is None and os.path.lexists(out / FILES):
        told.append(f"{out / FILES} is damaged, so nothing was removed from {out}")
        foreign.append(FILES)
    stale = [name for name, one in own.items() if whole_set and one.by == by and name not in digests]
    for name in own:
        known = (*own[name].digests, *((digests[name],) if name in digests else ()))
        if (name in digests or name in stale) and os.path.lexists(out / name) and not holds(out / name, known):
            told.append(_keep_edited(out, name))
    told += keep_foreign(out, foreign)

    during = {n: OwnFile(digests=(*(own[n].digests if n in own else ()), d), by=by) for n, d in digests.items()}
    _write_manifest(out, fresh, {**own, **during})
    for name in digests:
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (fresh / name).replace(out / name)
    for name in stale:
        if holds(out / name, own[name].digests):
            (out / name).unlink()
    after = {name: OwnFile(digests=(digest,), by=by) for name, digest in digests.items()}
    _write_manifest(out, fresh, {**{name: one for name, one in own.items() if name not in stale}, **after})
    return told


def _write_manifest(out: Path, fresh: Path, own: Mapping[str, OwnFile]) -> None:
    (fresh / FILES).write_text(own_text(own), encoding="utf-8")
    (fresh / FILES).replace(out / FILES)


def _differs(path: Path, digest: str) -> bool:
    """Whether something is there that is not a file of this content."""
    return os.path.lexists(path) and not holds(path, (digest,))


def _keep_edited(out: Path, name: str) -> str:
    """Rename one of our files that was edited since, and say so."""
    path, number = out / name, 1
    while not moved(path, place := path.with_name(f"{path.stem}.edited-{number}{path.suffix}")):
        number += 1
    return f"{path} had been edited; kept as {place.name}"


def keep_foreign(out: Path, names: Sequence[str]) -> list[str]:
    """Move files that are not ours to the first of ``kept-1``, ``kept-2`` ... that is not there yet, and say so."""
    if not names:
        return []
    number = 1
    while True:
        folder = out / f"kept-{number}"
        try:
            folder.mkdir()
            break
        except FileExistsError:
            number += 1
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        moved(out / name, folder / name)
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return [f"in {out} were files of the same names that this program does not know as its own; kept in {folder}: "
            f"{', '.join(names[:_SHOWN])}{more}"]  # fmt: skip


def moved(path: Path, place: Path) -> bool:
    """Move something, without ever writing over another; False if the place is taken."""
    try:
        os.link(path, place, follow_symlinks=False)
    except FileExistsError:
        return False
    except OSError:  # no hard links here
        if os.path.lexists(place):
            return False
        path.rename(place)
        return True
    path.unlink()
    return True


@contextlib.contextmanager
def _alone(out: Path) -> Iterator[None]:
    """Let no other run put files into this folder meanwhile, where the file system has locks."""
    descriptor = os.open(out, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _sweep(out: Path) -> None:
    """Remove what killed runs of this machine left behind, as far as they had planned it."""
    for path in out.glob(".workbench-new-*"):
        owner = _NEW.fullmatch(path.name)
        if owner and owner["host"] == machine() and not lives_here(owner["host"], owner["pid"]):
            with contextlib.suppress(OSError, ValueError):
                _remove(path, (unsealed((path / _PLAN).read_text(encoding="utf-8")) or {}).get("names", ()))
            _remove(path, ())


def _remove(fresh: Path, names: Sequence[str]) -> None:
    """Remove these files of a folder of new files, then the folder, if nothing else is in it."""
    for name in (*names, _PLAN) if names else ():
        if is_inside(name):
            (fresh / name).unlink(missing_ok=True)
    for folder in sorted((path for path in (fresh, *fresh.rglob("*")) if path.is_dir()), reverse=True):
        with contextlib.suppress(OSError):
            folder.rmdir()
