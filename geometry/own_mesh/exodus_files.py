"""Reads Exodus II files, of Cubit and others: element blocks are groups of cells, side and node sets groups of faces.

Files of the classic netCDF format are read by SciPy, those on HDF5 need netCDF4. Orders of nodes and numbers of sides:
Exodus II's element types (Sandia, SEACAS documentation). Verified by tests/unit/test_own_mesh_exodus.py.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.hexahedra import FACE_CORNERS, reference_nodes
from geometry.own_mesh.completion import TETRAHEDRON_FACES
from geometry.own_mesh.file_mesh import KINDS, CellBlock, FileMesh

__all__ = ["read_exodus"]

Index = NDArray[np.int64]
Read = Callable[[str], NDArray[Any] | None]

_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4))
_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (2, 3, 7, 6))
"""Corners of the edges and faces whose middles are nodes 9 to 20 and 22 to 27; 21 is the body's."""
_SIDES = {
    8: ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)),
    4: ((0, 1, 3), (1, 2, 3), (0, 2, 3), (0, 1, 2)),
}
"""Corners of a cell -> those of its sides 1, 2, ..."""
_SHELLS = ("SHELL", "QUAD", "TRI", "BAR", "BEAM", "TRUSS", "SPHERE", "CIRCLE", "NSIDED")
_HINT = "write it again, or save the mesh as .msh"


def read_exodus(path: Path) -> FileMesh:
    """Blocks and sets by name, or else by number.

    Raises
    ------
    InputError
        For a file that is none of Exodus', that needs netCDF4 where that is not installed, or that cannot be read.
    """
    try:
        return _content(_variables(path), path)
    except InputError:
        raise
    except Exception as error:  # whatever the libraries and a damaged file raise
        said = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError("mesh file", path, f"cannot be read ({said})", _HINT) from error


def _variables(path: Path) -> Read:
    """A function that gives a variable of the file by name, None where it has none; characters as text."""
    with path.open("rb") as stream:
        classic = stream.read(4) in (b"CDF\x01", b"CDF\x02")
    if classic:
        from scipy.io import netcdf_file

        with netcdf_file(str(path), "r", mmap=False) as file:
            kept = {
                name: (np.array(one.data), one.__dict__.get("elem_type", b"")) for name, one in file.variables.items()
            }
    else:
        try:
            import netCDF4  # type: ignore[import-not-found, unused-ignore]
        except ModuleNotFoundError as error:
            rule = f"cannot be read without the library {error.name}"
            raise InputError("mesh file", path, rule, "install it with pip, or save the mesh as .msh") from error
        with netCDF4.Dataset(str(path)) as file:
            file.set_auto_mask(False)
            kept = {name: (np.array(one[:]), getattr(one, "elem_type", "")) for name, one in file.variables.items()}

    def read(name: str) -> NDArray[Any] | None:
        if name.endswith(":type"):
            kind = kept[name.removesuffix(":type")][1]
            return np.array(kind.decode() if isinstance(kind, bytes) else str(kind))
        return kept[name][0] if name in kept else None

    return read


def _content(read: Read, path: Path) -> FileMesh:
    points = _points(read, path)
    blocks, groups, rows = list[CellBlock](), dict[str, Index](), dict[int, int]()
    element, flat = 0, 0
    for k, name in enumerate(_named(read, "eb", "connect"), start=1):
        nodes = np.asarray(read(f"connect{k}"), dtype=np.int64) - 1
        if nodes.ndim != 2 or (nodes.size and not (nodes.min() >= 0 and nodes.max() < len(points))):
            raise InputError("mesh file", path, f"has cells that name nodes beyond its {len(points)}", _HINT)
        numbers = np.arange(element, element + len(nodes))
        element += len(nodes)
        kind = str(read(f"connect{k}:type")).upper()
        if kind.startswith(_SHELLS):
            flat += len(nodes)
            continue
        first = sum(len(block.nodes) for block in blocks)
        rows |= {int(number): first + i for i, number in enumerate(numbers)}
        blocks.append(_block(kind, nodes, numbers + 1))
        groups[name] = np.concatenate([groups.get(name, _none()), first + np.arange(len(nodes))])
    corners = 4 if blocks and "tetra" in blocks[0].kind else 8
    node_sets = {
        name: np.asarray(read(f"node_ns{k}"), dtype=np.int64) - 1
        for k, name in enumerate(_named(read, "ns", "node_ns"), start=1)
    }
    cell_faces = {
        name: _faces(read, k, rows, corners, path) for k, name in enumerate(_named(read, "ss", "elem_ss"), start=1)
    }
    return FileMesh(
        points=points,
        node_numbers=np.arange(1, len(points) + 1),
        blocks=blocks,
        groups=groups,
        node_sets={name: nodes for name, nodes in node_sets.items() if len(nodes)},
        cell_faces={name: faces for name, faces in cell_faces.items() if len(faces)},
        flat=flat,
    )


def _points(read: Read, path: Path) -> NDArray[np.float64]:
    """Places (n, 3)."""
    together, apart = read("coord"), [read(f"coord{axis}") for axis in "xyz"]
    if together is not None and together.shape[0] == 3:
        return np.asarray(together, dtype=np.float64).T.copy()
    if any(one is None for one in apart):
        raise InputError("mesh file", path, "has no coordinates in space: it is no solid mesh of Exodus", _HINT)
    return np.stack([np.asarray(one, dtype=np.float64) for one in apart], axis=1)


def _named(read: Read, what: str, each: str) -> list[str]:
    """Names of the blocks or sets that are there, their numbers where they have none."""
    count = 0
    while read(f"{each}{count + 1}") is not None:
        count += 1
    texts, numbers = read(f"{what}_names"), read(f"{what}_prop1")
    named = [""] * count if texts is None else [_text(row) for row in texts[:count]]
    told = range(1, count + 1) if numbers is None else np.asarray(numbers).tolist()
    return [name or str(number) for name, number in zip(named, told, strict=False)]


def _text(characters: NDArray[Any]) -> str:
    return b"".join(characters.tolist()).split(b"\0")[0].decode("utf-8", errors="replace").strip()


def _block(kind: str, nodes: Index, numbers: Index) -> CellBlock:
    """Cells in gmsh's order; of a kind that is not solved as they are."""
    count = nodes.shape[1]
    shape = "hexahedra" if kind.startswith("HEX") else "tetrahedra" if kind.startswith("TET") else kind
    name = f"{count}-node {shape}"
    if name not in KINDS:
        return CellBlock(kind=name, nodes=nodes, numbers=numbers)
    placed = np.empty_like(nodes)
    placed[:, _places(count)] = nodes
    return CellBlock(kind=name, nodes=placed, numbers=numbers)


def _places(count: int) -> list[int]:
    """Place among gmsh's nodes of each of Exodus'."""
    if count < 20:
        return [0, 1, 2, 3, 4, 5, 6, 7, 9, 8] if count == 10 else list(range(count))
    ours = reference_nodes(count)
    corners = ours[:8]
    theirs = [*corners, *(corners[list(edge)].mean(axis=0) for edge in _EDGES)]
    if count == 27:
        theirs += [np.zeros(3), *(corners[list(face)].mean(axis=0) for face in _FACES)]
    return [int(np.flatnonzero((ours == place).all(axis=1))[0]) for place in theirs]


def _faces(read: Read, number: int, rows: dict[int, int], corners: int, path: Path) -> Index:
    """Cell and gmsh's number of the face, (k, 2), of a side set; sides of shells are left out."""
    elements, sides = (np.asarray(read(f"{what}_ss{number}"), dtype=np.int64) for what in ("elem", "side"))
    ours = [frozenset(face) for face in (TETRAHEDRON_FACES if corners == 4 else FACE_CORNERS)]
    face_of = [ours.index(frozenset(face)) for face in _SIDES[corners]]
    kept = [(rows[int(e) - 1], int(s)) for e, s in zip(elements, sides, strict=True) if int(e) - 1 in rows]
    wrong = next((side for _, side in kept if not 1 <= side <= len(face_of)), None)
    if wrong is not None:
        raise InputError("mesh file", path, f"has a side set with side {wrong} of a solid cell", _HINT)
    return np.array([(cell, face_of[side - 1]) for cell, side in kept], dtype=np.int64).reshape(-1, 2)


def _none() -> Index:
    return np.zeros(0, dtype=np.int64)
