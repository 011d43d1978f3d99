"""The result store: plain files under the hash of everything they depend on.

An entry is the folder ``STORE/ab/abcdef.../`` with result files and ``manifest.json``, which holds the SHA-256 of each
file and of itself. An entry appears by one rename, so that it is whole or absent; one that was damaged later is
recognised by its checksums, told of and computed again. Nothing goes that is not the store's own by its name: foreign
files stay where they are, those found in a result's folder go to ``STORE/kept``. Nothing goes by age unless a user
prunes. Verified by tests/unit/test_workbench_store.py and tests/unit/test_workbench_store_folder.py.
"""

from __future__ import annotations

import os
import shutil
import stat
import time
import uuid
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.kept_arrays import kept_fault
from contracts.machine import lives_here, machine
from workbench.execution.fingerprint import file_sha256
from workbench.execution.integrity import MANIFEST, SCHEMA, examined, sealed, stated
from workbench.execution.store_folder import CHECKPOINT, KEPT, KEY, SCRATCH, make_store

__all__ = ["MANIFEST", "Entry", "Store", "discard"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One finished result.

    Attributes
    ----------
    key : SHA-256 of everything the result depends on
    path : folder that holds its files
    manifest : what was recorded with it: task, inputs, files, wall time, unknowns
    """

    key: str
    path: Path
    manifest: Mapping[str, Any]

    @property
    def wall_s(self) -> float:
        """Wall time of the computation [s]."""
        return float(self.manifest["wall_s"])

    @property
    def dofs(self) -> int:
        """Number of unknowns, 0 where it has no meaning."""
        return int(self.manifest.get("dofs", 0))


class Store:
    """A folder of results, safe against killed runs, damaged files and two runs at once.

    Parameters
    ----------
    root : the folder; made if it is not there, refused if it holds anything but a store
    study : name of the study for which results are computed, recorded with them; says nothing about their keys

    Attributes
    ----------
    writable : whether results can be put into it; those in it can be used in any case
    """

    def __init__(self, root: Path, study: str = "") -> None:
        self.root, self.study = root, study
        self.writable = make_store(root)

    def folder(self, key: str) -> Path:
        """Folder of the entry with this key, whether it exists or not."""
        return self.root / key[:2] / key

    def get(self, key: str) -> Entry | None:
        """The entry, or None if it is absent, torn or damaged (any file missing or with another checksum)."""
        path = self.folder(key)
        manifest, fault = examined(path, key)
        return None if fault else Entry(key=key, path=path, manifest=manifest)

    def fault(self, key: str) -> str:
        """What is wrong with the entry, e.g. ``"curve.csv has 100 of 480 bytes"``; ``""`` if it is whole or absent.

        Of an absent one, what is wrong with its checkpoint.
        """
        place = self.folder(key)
        if os.path.lexists(place):
            fault = examined(place, key)[1]
            if fault and (place.is_symlink() or not place.is_dir()):
                return f"in the place of its folder lies something else, which moves to {self.root / KEPT}"
            return fault
        fault = kept_fault(self.checkpoint(key))
        return f"the checkpoint {fault}" if fault else ""

    def scratch(self) -> Path:
        """A new empty folder inside the store, to be filled and then handed to ``put``."""
        name = f"{machine()}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
        path = self.root / "tmp" / name
        path.mkdir()
        return path

    def checkpoint(self, key: str) -> Path:
        """File in which the running task of this key keeps how far it came; dropped once its entry is stored."""
        return self.root / "checkpoints" / f"{key}.npz"

    def put(self, key: str, filled: Path, record: Mapping[str, Any]) -> Entry:
        """Turn a filled scratch folder into the entry ``key`` by one rename.

        If another run stored the same key first, its whole entry is kept and ours dropped: both hold the same result.
        """
        files = {p.relative_to(filled).as_posix(): file_sha256(p) for p in sorted(filled.rglob("*")) if p.is_file()}
        sizes = {name: (filled / name).stat().st_size for name in files}
        about = {"schema": SCHEMA, "key": key, "files": files, "sizes": sizes, "stored_at": time.time()}
        manifest = {**record, "study": self.study, **about}
        (filled / MANIFEST).write_text(sealed(manifest), encoding="utf-8")
        target = self.folder(key)
        target.parent.mkdir(parents=True, exist_ok=True)
        for _ in range(10):
            try:
                filled.replace(target)
                self._forget(key)
                return Entry(key=key, path=target, manifest=manifest)
            except OSError:
                found = self.get(key)
                if found is not None:
                    shutil.rmtree(filled, ignore_errors=True)
                    return found
                self._set_aside(target)
        raise InputError("result store", target, "cannot be replaced", "check the folder's permissions")

    def _set_aside(self, target: Path) -> None:
        """Move a damaged entry out of the way; another run may do so at the same moment."""
        try:
            discard(self.root, target)
        except OSError:
            return

    def _forget(self, key: str) -> None:
        """Remove the checkpoint of this key, with halves of it that a killed run left."""
        for path in (self.root / "checkpoints").glob(f"*{key}*"):
            if CHECKPOINT.fullmatch(path.name) and path.is_file():
                path.unlink(missing_ok=True)

    def sweep(self) -> None:
        """Remove scratch folders left by runs on this machine that no longer live."""
        for path in (self.root / "tmp").iterdir():
            owner = SCRATCH.fullmatch(path.name)
            if owner and owner["host"] == machine() and not lives_here(owner["host"], owner["pid"]):
                shutil.rmtree(path, ignore_errors=True)


def discard(root: Path, path: Path) -> None:
    """Remove an entry or a scratch folder by one rename; what others had put into an entry moves to ``STORE/kept``.

    Where the entry's manifest cannot be trusted, nothing but the manifest is known to be ours; what lies in an entry's
    place and is no folder is not.
    """
    if KEY.fullmatch(path.name) and not stat.S_ISDIR(path.lstat().st_mode):
        (root / KEPT).mkdir(exist_ok=True)
        path.replace(root / KEPT / f"{path.name}-{uuid.uuid4().hex[:8]}")
        return
    if not os.access(path, os.R_OK | os.W_OK | os.X_OK):
        path.chmod(0o700)  # without these it can neither be read nor moved
    trash = root / "tmp" / f"{machine()}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    manifest, _ = stated(path, path.name)
    path.replace(trash)
    ours = {MANIFEST, *manifest.get("files", {})}
    found = [one for one in sorted(trash.rglob("*")) if not one.is_dir() or one.is_symlink()]
    found = found if KEY.fullmatch(path.name) else []  # scratch is ours as a whole
    for one in (one for one in found if one.relative_to(trash).as_posix() not in ours):
        place = root / KEPT / f"{path.name}-{trash.name[-8:]}" / one.relative_to(trash)
        place.parent.mkdir(parents=True, exist_ok=True)
        one.replace(place)
    shutil.rmtree(trash, ignore_errors=True)
