"""The wheel with its fields from a file in the report's folder, checked before anything is drawn.

Verified by tests/unit/test_viewer_scene.py and tests/unit/test_viewer_field_arrays.py.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from workbench.viewer.field_arrays import field_arrays
from workbench.viewer.wheel_body import WheelBody, wheel_body
from workbench.viewer.wheel_surface import WheelField

__all__ = ["read_fields", "read_shapes"]

_HEXAHEDRA = {12: 8, 29: 27}
"""VTK's cell types with their nodes."""
_QUADRANGLE = 9
_HINT = "run the report again, or take the file out of the folder"


def read_fields(path: Path) -> tuple[WheelBody, WheelField]:
    """The cells of the wheel and its fields from a file that ``workbench report`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, or lacks hexahedra, parts, displacement or stress.
    """
    with _one_message(path):
        found = field_arrays(path)
        points, kind, cells = _floats(found["Points"]), *_cells(found)
        part = np.asarray(found["part"], dtype=np.int64)
        moved, stress = _floats(found["displacement_m"]), _floats(found["von_mises_Pa"])
        principal = _floats(found["principal_stress_Pa"]) if "principal_stress_Pa" in found else None
    fields = [points, moved, stress, *([] if principal is None else [principal])]
    if _HEXAHEDRA.get(kind) != cells.shape[1] or not all(np.isfinite(each).all() for each in fields):
        raise InputError("field file", path, "must hold hexahedra with finite fields", _HINT)
    fits = points.shape == moved.shape == (len(stress), 3) and stress.ndim == 1 and part.shape == (len(cells),)
    fits &= principal is None or principal.shape == moved.shape
    if not fits or cells.min() < 0 or cells.max() >= len(points):
        raise InputError("field file", path, "must hold cells of its own points, and a field at each", _HINT)
    field = WheelField(displacement=moved, von_mises=stress, principal_stress=principal)
    return wheel_body(points, cells, part, moved), field


def read_shapes(path: Path, count: int) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Points (n, 3) [m], cells (m, 4, 8 or 27) and ``count`` shapes (count, n, 3) that ``workbench modes`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, or holds no such cells or fewer shapes.
    """
    with _one_message(path):
        found = field_arrays(path)
        points, kind, cells = _floats(found["Points"]), *_cells(found)
        shapes = np.array([_floats(found[f"mode_{number:02d}"]) for number in range(1, count + 1)])
    sound = ({_QUADRANGLE: 4} | _HEXAHEDRA).get(kind) == cells.shape[1] and shapes.shape[1:] == points.shape
    if not sound or points.shape[1:] != (3,) or cells.min() < 0 or cells.max() >= len(points):
        raise InputError("field file", path, "must hold cells of its own points, and a shape at each", _HINT)
    if not (np.isfinite(points).all() and np.isfinite(shapes).all()):
        raise InputError("field file", path, "must hold finite shapes", _HINT)
    return points, cells, shapes


@contextmanager
def _one_message(path: Path) -> Iterator[None]:
    """Whatever a file that is none raises, as an InputError."""
    try:
        yield
    except InputError:
        raise
    except (ValueError, KeyError, TypeError, zlib.error, ElementTree.ParseError) as error:
        lines = str(error).strip().splitlines()
        reason = f"{type(error).__name__}: {lines[0][:120]}" if lines else type(error).__name__
        raise InputError("field file", path, f"cannot be read ({reason})", _HINT) from error


def _floats(array: NDArray[Any]) -> NDArray[np.float64]:
    return np.asarray(array, dtype=np.float64)


def _cells(found: Any) -> tuple[int, NDArray[np.int64]]:
    """VTK's type of all cells, and their nodes (m, k)."""
    (kind,) = np.unique(found["types"]).tolist()
    return kind, np.asarray(found["connectivity"], dtype=np.int64).reshape(len(found["types"]), -1)
