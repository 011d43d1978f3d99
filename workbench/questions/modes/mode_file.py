"""Modes in a task's folder. Verified by tests/unit/test_workbench_modes.py."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.archive import read_archive
from contracts.errors import InputError
from contracts.modes import Modes

__all__ = ["FIELDS", "MODES", "KeptModes", "read_modes", "write_modes"]

MODES, FIELDS = "modes.npz", "modes.vtu"
"""In a task's folder."""
_LARGEST = 2_000_000_000
"""Bytes of the shapes."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeptModes:
    """Modes with the part of each of their points.

    Attributes
    ----------
    modes : as found
    parts : names
    part : (n_points,) number of a point's part among them
    half : whether the points are those of half a wheel, y >= 0
    """

    modes: Modes
    parts: tuple[str, ...]
    part: NDArray[np.int64]
    half: bool


def write_modes(kept: KeptModes, path: Path) -> None:
    """Every array; shapes in single precision."""
    arrays = {one.name: getattr(kept.modes, one.name) for one in fields(Modes)}
    arrays["shape"] = arrays["shape"].astype(np.float32)
    names = np.array(kept.parts, dtype=np.str_)
    np.savez_compressed(path, allow_pickle=False, parts=names, part=kept.part, half=kept.half, **arrays)


def read_modes(path: Path) -> KeptModes:
    """Read what `write_modes` wrote; InputError for another file."""
    arrays = read_archive(path, "modes", _LARGEST)
    try:
        modes = Modes(**{one.name: arrays[one.name] for one in fields(Modes)})
        names = tuple(arrays["parts"].tolist())
        return KeptModes(modes=modes, parts=names, part=arrays["part"], half=bool(arrays["half"]))
    except KeyError as error:
        raise InputError("modes", path, f"lack {error}", "compute them again") from error
