"""A wheel as another program might mesh it: a disc with a bore in two rings of cells, hub and rim, in millimetres."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from geometry.hexahedra import face_nodes, reference_nodes
from geometry.inp import TWENTY_NODES
from geometry.own_mesh.file_mesh import KINDS, CellBlock, FileMesh
from geometry.own_mesh.roles import Placement, Roles

__all__ = ["AROUND", "MILLIMETRES", "ROLES", "ring_deck", "ring_volume", "ring_wheel"]

AROUND = 12
"""Cells around."""
_RADII = (40.0, 70.0, 100.0)
_WIDTH = 50.0
MILLIMETRES = Placement(unit=1e-3)
ROLES = Roles(parts={"hub": ("hub",), "rim": ("rim",)}, hub=("bore",), ground=("tread",))


def ring_wheel(n_nodes: int = 27) -> FileMesh:
    """The disc in hexahedra of 8, 20 or 27 nodes on cylinders about y; file numbers of cells and nodes from 1001.

    Groups of cells hub and rim, of faces bore and tread; node sets of the same names with the ending _nodes.
    """
    full = reference_nodes(27)
    places = []
    for ring in range(2):
        for k in range(AROUND):
            radius = _RADII[ring] + 0.5 * (full[:, 0] + 1.0) * (_RADII[ring + 1] - _RADII[ring])
            angle = 2.0 * math.pi * (k + 0.5 * (full[:, 1] + 1.0)) / AROUND
            y = 0.5 * _WIDTH * full[:, 2]
            places.append(np.column_stack([-radius * np.cos(angle), y, radius * np.sin(angle)]))
    kept = np.array(places)[:, :n_nodes].reshape(-1, 3)
    _, first, number = np.unique(np.round(kept, 6), axis=0, return_index=True, return_inverse=True)
    points, cells = kept[first], number.reshape(2 * AROUND, n_nodes).astype(np.int64)
    kind = next(name for name, n in KINDS.items() if n == n_nodes)
    outer = face_nodes(8)[_face(1.0)]
    inner = face_nodes(8)[_face(-1.0)]
    bore, tread = cells[:AROUND, inner], cells[AROUND:, outer]
    radius = np.hypot(points[:, 0], points[:, 2])
    return FileMesh(
        points=points,
        node_numbers=1001 + np.arange(len(points)),
        blocks=[CellBlock(kind=kind, nodes=cells, numbers=1001 + np.arange(len(cells)))],
        groups={"hub": np.arange(AROUND), "rim": AROUND + np.arange(AROUND)},
        facets={"bore": [bore], "tread": [tread]},
        node_sets={
            "bore_nodes": np.flatnonzero(np.isclose(radius, _RADII[0], atol=0.01 * _RADII[0])),
            "tread_nodes": np.flatnonzero(np.isclose(radius, _RADII[2], atol=0.01 * _RADII[2])),
        },
    )


def ring_volume() -> float:
    """Of the disc [m^3]."""
    return math.pi * (_RADII[2] ** 2 - _RADII[0] ** 2) * _WIDTH * 1e-9


def ring_deck(n_nodes: int = 20) -> str:
    """The same as an input deck, with node sets and surfaces."""
    mesh = ring_wheel(n_nodes)
    cells = mesh.blocks[0].nodes[:, list(TWENTY_NODES)] if n_nodes == 20 else mesh.blocks[0].nodes
    lines = ["** a wheel", "*NODE"]
    lines += [f"{k}, {x:.15g}, {y:.15g}, {z:.15g}" for k, (x, y, z) in zip(mesh.node_numbers, mesh.points, strict=True)]
    for name, members in mesh.groups.items():
        lines.append(f"*ELEMENT, TYPE=C3D{n_nodes}, ELSET={name.upper()}")
        for cell in members:
            row = [1001 + int(cell), *mesh.node_numbers[cells[cell]].tolist()]
            lines += [", ".join(map(str, row[:12])) + ("," if len(row) > 12 else "")]
            lines += [", ".join(map(str, row[12:]))] if len(row) > 12 else []
    for name, nodes in mesh.node_sets.items():
        lines += [f"*NSET, NSET={name}", *_rows(mesh.node_numbers[nodes].tolist())]
    lines += ["*SURFACE, NAME=TREAD, TYPE=ELEMENT", "RIM, S4", "*SURFACE, NAME=BORE", "HUB, S6", "*STEP", "*END STEP"]
    return "\n".join(lines) + "\n"


def _rows(numbers: Sequence[int]) -> list[str]:
    return [", ".join(map(str, numbers[k : k + 10])) for k in range(0, len(numbers), 10)]


def _face(side: float) -> int:
    """Face of the reference cell at the inner or outer radius."""
    corners: NDArray[np.float64] = reference_nodes(8)[face_nodes(8)]
    return int(np.flatnonzero((corners[:, :, 0] == side).all(axis=1))[0])
