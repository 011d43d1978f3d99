"""A file in which a long run keeps how far it came, so that a killed run goes on.

One NumPy archive, without pickle, replaced by one rename: whole or absent. It begins with the key of the problem it
belongs to; a damaged file, or one of another problem, counts as absent. Each process of a parallel run has its own part
in it. Verified by tests/unit/test_fe_checkpoint.py and tests/verification/test_fe_resume.py.
"""

from __future__ import annotations

import hashlib
import json
import os
import socket
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from reference_fe import dolfinx_api as api

__all__ = ["Arrays", "Checkpoint", "Recorder", "below", "packed", "problem_key", "unpacked"]

type Arrays = Mapping[str, NDArray[Any]]
"""Named arrays of numbers or text."""


class Recorder(Protocol):
    """What a run has recorded beside the solver's own state: rows of a curve, fields."""

    def recorded(self) -> Arrays:
        """Everything recorded so far."""

    def resume(self, arrays: Arrays) -> None:
        """Take up what a run that was killed had recorded."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Checkpoint:
    """One file for one problem.

    Attributes
    ----------
    path : the file
    key : digest of everything the run depends on, see `problem_key`
    recorder : what else is kept with the solver's state, or None
    """

    path: Path
    key: str
    recorder: Recorder | None = None

    def read(self) -> Arrays | None:
        """The state this process last wrote, or None without a file that fits; hands the recorder its part."""
        arrays = api.COMM.bcast(self._archive() if api.COMM.rank == 0 else None)
        if arrays is None:
            return None
        if self.recorder is not None:
            self.recorder.resume(below("recorded", arrays))
        return below(f"process{api.COMM.rank}", arrays)

    def write(self, state: Arrays) -> None:
        """Keep the state of every process and what is recorded; the last file stays whole until this one is."""
        states = api.COMM.gather(dict(state))
        recorded = {} if self.recorder is None else self.recorder.recorded()
        if states is None:
            return
        arrays: dict[str, NDArray[Any]] = {"key": np.array(self._key_and_size())}
        for folder, part in {"recorded": recorded, **{f"process{i}": s for i, s in enumerate(states)}}.items():
            arrays |= {f"{folder}/{name}": value for name, value in part.items()}
        fresh = self.path.with_name(f".{self.path.stem}-{socket.gethostname()}-{os.getpid()}.npz")
        try:
            with fresh.open("wb") as stream:
                np.savez(stream, allow_pickle=False, **arrays)
                stream.flush()
                os.fsync(stream.fileno())
            fresh.replace(self.path)
        finally:
            fresh.unlink(missing_ok=True)  # half of it, where the disk is full

    def discard(self) -> None:
        """Remove the file: the run has ended."""
        if api.COMM.rank == 0:
            self.path.unlink(missing_ok=True)

    def _key_and_size(self) -> str:
        return f"{self.key}, {api.COMM.size} processes"

    def _archive(self) -> dict[str, NDArray[Any]] | None:
        try:
            with self.path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
                arrays = {name: archive[name] for name in archive.files}
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None
        return arrays if str(arrays.get("key")) == self._key_and_size() else None


def problem_key(mesh: TaggedMesh, *inputs: object) -> str:
    """SHA-256 of mesh, inputs (by their ``repr``), source text of this package and library versions."""
    digest = hashlib.sha256(repr((dict(mesh.parts), dict(mesh.faces), inputs, api.versions())).encode())
    for array in (mesh.points, mesh.cells, mesh.cell_tags, mesh.facets, mesh.facet_tags):
        digest.update(repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def below(folder: str, arrays: Arrays) -> dict[str, NDArray[Any]]:
    """The arrays named ``folder/...``, without that prefix."""
    prefix = f"{folder}/"
    return {name.removeprefix(prefix): value for name, value in arrays.items() if name.startswith(prefix)}


def packed(values: object) -> NDArray[Any]:
    """Lists, mappings and numbers as an array of text; floats come back bit for bit, infinity included."""
    return np.array(json.dumps(values))


def unpacked(array: NDArray[Any]) -> Any:
    """What `packed` was given, tuples as lists."""
    return json.loads(str(array))
