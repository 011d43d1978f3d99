"""Reads VTK's files, .vtu and .vtk, by meshio.

VTK's files have no groups: every value of an integer cell array is a group by its number, of solid cells a part, of
plane cells faces; a point array that is 0 and 1 names faces. Verified by tests/unit/test_own_mesh_files.py.
"""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.hexahedra import VTK_FROM_GMSH
from geometry.inp import TWENTY_NODES
from geometry.own_mesh.file_mesh import CellBlock, FileMesh
from geometry.vtu import meshio_module

__all__ = ["read_meshio"]

Index = NDArray[np.int64]

_MODULES = {".vtu": "vtu", ".vtk": "vtk"}
_SOLID = {
    "hexahedron": ("8-node hexahedra", tuple(range(8))),
    "hexahedron20": ("20-node hexahedra", TWENTY_NODES),
    "hexahedron27": ("27-node hexahedra", VTK_FROM_GMSH),
    "tetra": ("4-node tetrahedra", tuple(range(4))),
    "tetra10": ("10-node tetrahedra", (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)),
}
"""meshio's name -> ours, and the place among gmsh's nodes of each node."""
_FLAT = {"quad": 4, "quad8": 4, "quad9": 4, "triangle": 3, "triangle6": 3, "triangle7": 3}
_SOLID_WORDS = ("hexa", "tetra", "wedge", "pyramid", "VTK_LAGRANGE", "poly")


def read_meshio(path: Path) -> FileMesh:
    """Groups by number and name, see above.

    Raises
    ------
    InputError
        For a file that meshio cannot read.
    """
    module: Any = getattr(meshio_module(), _MODULES[path.suffix.lower()])
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            found = module.read(str(path))
    except (Exception, SystemExit) as error:  # meshio raises whatever its parsers raise
        said = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError("mesh file", path, f"cannot be read ({said})", "write it again, or save it as .msh") from error
    return _content(found, path)


def _content(found: Any, path: Path) -> FileMesh:
    points = np.asarray(found.points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise InputError("mesh file", path, "has points in a plane alone", "give a solid mesh")
    blocks, groups, facets, flat, count = [], dict[str, list[Index]](), dict[str, list[Index]](), 0, 0
    for k, block in enumerate(found.cells):
        nodes = np.asarray(block.data, dtype=np.int64)
        if nodes.size and not (nodes.min() >= 0 and nodes.max() < len(points)):
            raise InputError("mesh file", path, f"has cells that name nodes beyond its {len(points)}", "write it again")
        labels = _labels(found, k, len(nodes))
        if block.type in _FLAT:
            flat += len(nodes)
            for name, rows in labels.items():
                facets.setdefault(name, []).append(nodes[rows, : _FLAT[block.type]])
        elif block.type in _SOLID or block.type.startswith(_SOLID_WORDS):
            kind, places = _SOLID.get(block.type, (block.type, tuple(range(nodes.shape[1] if nodes.ndim > 1 else 0))))
            placed = np.empty_like(nodes)
            placed[:, list(places)] = nodes
            blocks.append(CellBlock(kind=kind, nodes=placed, numbers=np.arange(count, count + len(nodes))))
            for name, rows in labels.items():
                groups.setdefault(name, []).append(count + rows)
            count += len(nodes)
    node_sets = {name: np.asarray(rows, dtype=np.int64) for name, rows in (found.point_sets or {}).items()}
    for name, values in (found.point_data or {}).items():
        one = np.asarray(values)
        if one.ndim == 1 and one.dtype.kind in "iub" and set(np.unique(one)) == {0, 1}:
            node_sets[name] = np.flatnonzero(one)
    return FileMesh(
        points=points,
        node_numbers=np.arange(len(points)),
        blocks=blocks,
        groups={name: np.concatenate(rows) for name, rows in groups.items()},
        facets=facets,
        node_sets=node_sets,
        flat=flat,
    )


def _labels(found: Any, block: int, cells: int) -> dict[str, Index]:
    """Group -> rows of a block's cells: named sets, and the values of integer arrays by their number."""
    labels = {
        str(name): np.asarray(rows[block], dtype=np.int64)
        for name, rows in (found.cell_sets or {}).items()
        if rows[block] is not None and len(rows[block])
    }
    names = {(int(number), int(dim)): str(name) for name, (number, dim) in (found.field_data or {}).items()}
    for data in (found.cell_data or {}).values():
        values = np.asarray(data[block])
        if values.shape == (cells,) and values.dtype.kind in "iu":
            for value in np.unique(values).tolist():
                called = next((name for (number, _), name in names.items() if number == value), str(value))
                labels.setdefault(called, np.flatnonzero(values == value))
    return labels
