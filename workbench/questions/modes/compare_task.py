"""Task: modes of the solid wheel paired with those of the ANCF wheel by their shapes.

At nodes of the solid on the plates' middle surfaces, and their mirror images, the modal assurance criterion of two
shapes a, b is (a.b)^2 / (a.a b.b) (Allemang & Brown 1982, from memory). Modes that share a frequency, as a wheel's
come in pairs, are compared with all that their frequency has: the share of b in the span of them. The pairs are those
of the largest sum. Verified by tests/end_to_end/test_modes.py and tests/unit/test_workbench_modes.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ancf_reduced.wheel.closest import PlateFace
from ancf_reduced.wheel.hub import HUB_PARTS
from ancf_reduced.wheel.mesh import AncfWheel
from ancf_reduced.wheel.vibration import node_shapes
from contracts.archive import read_archive
from contracts.errors import InputError
from workbench.execution.result_files import write_result
from workbench.questions.modes.ancf_task import SHAPES, wheel_of
from workbench.questions.modes.mode_file import MODES, KeptModes, read_modes

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["assurance", "compare", "paired"]

Array = NDArray[np.float64]
_ON = 20e-6
"""Distance up to which a node lies on a middle surface [m]."""
_LARGEST = 2_000_000_000
"""Bytes of the plates' shapes."""


def compare(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: rows of both numbers, frequencies, criterion; returns their number.

    Needs the tasks ``inputs["fe"]`` and ``inputs["ancf_wheel"]``.
    """
    solid = read_modes(needs[inputs["fe"]] / MODES)
    plates = read_modes(needs[inputs["ancf_wheel"]] / MODES)
    shapes = read_archive(needs[inputs["ancf_wheel"]] / SHAPES, "shapes", _LARGEST)["shapes"]
    progress(0.2)
    first, second = _at_common_points(solid, wheel_of(inputs), shapes)
    elastic = [np.flatnonzero(~one.modes.rigid) for one in (solid, plates)]
    groups = [g[~solid.modes.rigid[g]] for g in solid.modes.clusters()]
    table = assurance(first, second, [g for g in groups if len(g)])
    rows = [
        {
            "fe": int(i),
            "ancf_wheel": int(j),
            "fe_Hz": float(solid.modes.frequency[i]),
            "ancf_wheel_Hz": float(plates.modes.frequency[j]),
            "mac": float(table[i, j]),
        }
        for i, j in paired(table, elastic[0], elastic[1])
    ]
    write_result(out, {"rows": rows, "points": first.shape[1] // 3})
    return len(rows)


def assurance(first: Array, second: Array, groups: Sequence[NDArray[np.int64]]) -> Array:
    """Criterion (n, m) of shapes (n, k) and (m, k), those of a group of the first taken together; 0 for the others."""
    found = np.zeros((len(first), len(second)))
    lengths = (second**2).sum(axis=1)
    for group in groups:
        basis, _ = np.linalg.qr(first[group].T)
        found[group] = ((basis.T @ second.T) ** 2).sum(axis=0) / lengths
    return found


def paired(table: Array, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Pairs of some rows and columns with the largest sum of the table's entries, by rows."""
    i, j = linear_sum_assignment(-table[np.ix_(rows, columns)])
    return [(int(rows[a]), int(columns[b])) for a, b in zip(i, j, strict=True)]


def _at_common_points(solid: KeptModes, wheel: AncfWheel, shapes: Array) -> tuple[Array, Array]:
    """Shapes of both, (n, k) and (m, k), at the solid's nodes on middle surfaces, those of half a wheel mirrored."""
    places, numbers = solid.modes.points, list[NDArray[np.int64]]()
    first, second = list[Array](), list[Array]()
    mirror = np.array([1.0, -1.0, 1.0])
    for part in dict.fromkeys(wheel.parts.tolist()):
        if part in HUB_PARTS or part not in solid.parts:
            continue
        face = PlateFace(wheel.plates, np.flatnonzero(wheel.parts == part), np.zeros(len(wheel.parts)))
        own = np.flatnonzero(solid.part == solid.parts.index(part))
        for side in (np.ones(3), mirror) if solid.half else (np.ones(3),):
            found, plate, rows = face.closest(wheel.plates.reference, places[own] * side, 2.0 * _ON)
            local = wheel.plates.reference[wheel.plates.plates[plate]].reshape(len(plate), 16, 3)
            apart = np.linalg.norm(np.einsum("nk,nki->ni", rows[:, 0], local) - places[own[found]] * side, axis=1)
            on = apart < _ON
            nodes = own[found[on]]
            numbers.append(nodes)
            sign = 1.0 if side[1] > 0.0 else solid.modes.parity[:, None, None].astype(np.float64)
            first.append(sign * solid.modes.shape[:, nodes].astype(np.float64) * side)
            second.append(np.stack([node_shapes(wheel, plate[on], rows[on, 0], one) for one in shapes]))
    if not sum(len(one) for one in numbers):
        hint = "mesh the solid with one quadratic cell through the thickness, or an even number of linear ones"
        raise InputError("nodes of the solid", "0", "lie on the plates' middle surfaces", hint)
    return tuple(np.concatenate(one, axis=1).reshape(len(one[0]), -1) for one in (first, second))  # type: ignore[return-value]
