"""Modes of a wheel from the two files that ``workbench modes`` wrote of them, and what is drawn of each.

Verified by tests/unit/test_viewer_modes.py.
"""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.input_file import input_bytes
from workbench.viewer.folder import ModesFile
from workbench.viewer.names import plain
from workbench.viewer.wheel_body import wheel_body
from workbench.viewer.wheel_file import read_shapes
from workbench.viewer.wheel_surface import WheelSurface

__all__ = ["Mode", "ModeShapes", "read_modes"]

FloatArray = NDArray[np.float64]
_WAVES = ("radial", "warping", "springs")
"""Kinds that are told apart by the waves around the rim."""
_LARGEST = 1_000_000
_HINT = "compute the modes again, or take the file out of the folder"


@dataclass(frozen=True, slots=True, kw_only=True)
class Mode:
    """A row of the table.

    Attributes
    ----------
    frequency : [Hz]; 0 for rigid motions and modes that grow
    growth : rate of these [1/s]
    kind : in words
    parity : 1 even about y = 0, -1 odd
    """

    frequency: float
    growth: float
    kind: str
    parity: int

    @property
    def words(self) -> str:
        """``18.54 Hz, torsional``."""
        value = f"grows at {self.growth:.3g}/s" if self.growth > 0.0 else f"{self.frequency:.2f} Hz"
        return f"{value}, {self.kind}"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ModeShapes:
    """Modes of one wheel in one state.

    Attributes
    ----------
    surface : the wheel at rest, both halves
    modes : in the order of the table
    shapes : (n, n_nodes, 3) float, at the mesh's nodes, of any size
    """

    surface: WheelSurface
    modes: tuple[Mode, ...]
    shapes: FloatArray

    def displacement(self, number: int) -> FloatArray:
        """Of the surface's points in one mode (n, 3), the largest of length 1.

        Of half a wheel the other half moves as the mirror image, in an odd mode the other way.
        """
        moved: FloatArray = self.shapes[number][self.surface.nodes].copy()
        image = self.surface.mirror < 0.0
        moved[image] *= np.array([1.0, -1.0, 1.0]) * (-1.0 if self.modes[number].parity < 0 else 1.0)
        largest = float(np.linalg.norm(moved, axis=1).max())
        return moved / (largest or 1.0)


def read_modes(found: ModesFile) -> ModeShapes:
    """Read both files.

    Raises
    ------
    InputError
        For a file that cannot be used, or two that do not belong together.
    """
    modes = _table(found.table)
    points, cells, shapes = read_shapes(found.path, len(modes))
    if cells.shape[1] == 4:
        n = len(points)
        surface = WheelSurface(
            places=points,
            nodes=np.arange(n),
            mirror=np.ones(n),
            numbers=np.arange(n),
            quads=cells,
            parts=np.zeros(len(cells), dtype=np.int64),
        )
    else:
        surface = wheel_body(points, cells, np.zeros(len(cells), dtype=np.int64)).surface()
    return ModeShapes(surface=surface, modes=modes, shapes=shapes)


def _table(path: Path) -> tuple[Mode, ...]:
    text = input_bytes(path, "table of modes", _LARGEST).decode("utf-8", errors="replace")
    try:
        modes = tuple(_mode(row) for row in csv.DictReader(io.StringIO(text)))
    except (KeyError, ValueError, TypeError, csv.Error) as error:
        reason = plain(f"{type(error).__name__}: {error}")[:120]
        raise InputError("table of modes", path, f"cannot be read ({reason})", _HINT) from error
    if not modes:
        raise InputError("table of modes", path, "has no row", _HINT)
    return modes


def _mode(row: dict[str, str]) -> Mode:
    frequency, growth, waves = float(row["frequency_Hz"]), float(row["growth_1_s"]), int(row["waves"])
    if not (math.isfinite(frequency) and math.isfinite(growth)):
        raise ValueError("a frequency is not finite")
    kind = re.sub(r"^rigid_", "rigid ", row["kind"]) + (f" n={waves}" if row["kind"] in _WAVES else "")
    return Mode(frequency=frequency, growth=growth, kind=plain(kind), parity=int(row["parity"]))
