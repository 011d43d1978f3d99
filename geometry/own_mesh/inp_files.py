"""Reads input decks of Abaqus and CalculiX: nodes, solid elements, sets, and surfaces of element faces.

Keywords about anything but the mesh are skipped. An assembly of several instances is not read: it has no numbers of its
own. Verified by tests/unit/test_own_mesh_files.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.input_file import input_text
from geometry.hexahedra import FACE_CORNERS
from geometry.inp import TWENTY_NODES
from geometry.own_mesh.completion import TETRAHEDRON_FACES
from geometry.own_mesh.file_mesh import KINDS, CellBlock, FileMesh

__all__ = ["read_inp"]

Index = NDArray[np.int64]

_LARGEST = 1_000_000_000
_HINT = "write it again, or save the mesh as .msh"
_SOLID = re.compile(r"(?:C3D|DC3D|SC)(\d+)")
_FLAT = re.compile(r"(?:S|STRI|CPS|CPE|CAX|M3D|SFM3D|R3D)(\d+)")
_KIND = {n: kind for kind, n in KINDS.items() if n != 27}
_ORDERS = {20: TWENTY_NODES, 10: (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)}
"""Place among gmsh's nodes of each node of an element."""
_FACES = {
    8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 3, 7, 4)),
    4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
}
"""Corners of a cell -> those of its faces S1, S2 ... (Abaqus analysis user's guide, solid elements: from memory)."""


@dataclass(slots=True)
class _Deck:
    """What has been read so far, by the deck's own numbers."""

    nodes: dict[int, list[float]] = field(default_factory=dict)
    elements: dict[str, dict[int, list[int]]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    element_sets: dict[str, list[int]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    instances: int = 0


def read_inp(path: Path) -> FileMesh:
    """Element sets are groups of cells; node sets and surfaces of element faces are groups of faces.

    Raises
    ------
    InputError
        For text that is no deck, numbers that are none, nodes and elements that are not there.
    """
    deck = _Deck()
    for keyword, options, line, rows in _sections(path):
        try:
            _take(deck, keyword, options, rows)
        except (ValueError, IndexError) as error:
            said = " ".join(str(error).split())[:120]
            raise InputError(
                "mesh file", path, f"cannot be read from line {line} on, *{keyword} ({said})", _HINT
            ) from error
    if deck.instances > 1:
        rule = f"is an assembly of {deck.instances} instances"
        raise InputError("mesh file", path, rule, "write a flat deck, with all nodes and elements in one numbering")
    return _content(deck, path)


def _sections(path: Path) -> Iterator[tuple[str, dict[str, str], int, list[list[str]]]]:
    """Keyword, its options, its line, and the data below it, long rows joined."""
    keyword, options, first = "", dict[str, str](), 1
    rows: list[list[str]] = []
    open_row = False
    for number, line in enumerate(input_text(path, "mesh file", _LARGEST).splitlines(), start=1):
        text = line.strip()
        if text.startswith("**") or not text:
            continue
        if text.startswith("*"):
            if keyword:
                yield keyword, options, first, rows
            word, *more = [part.strip() for part in text[1:].split(",")]
            keyword, first, rows, open_row = word.upper(), number, [], False
            pairs = [part.partition("=") for part in more if part]
            options = {name.strip().upper(): value.strip().strip('"') for name, _, value in pairs}
            continue
        cells = [cell.strip() for cell in text.split(",")]
        goes_on = cells[-1] == ""
        cells = cells[:-1] if goes_on else cells
        if open_row and keyword == "ELEMENT":
            rows[-1] += cells
        else:
            rows.append(cells)
        open_row = goes_on
    if keyword:
        yield keyword, options, first, rows
    else:
        raise InputError("mesh file", path, "has no keyword such as *NODE: it is no input deck", _HINT)


def _take(deck: _Deck, keyword: str, options: dict[str, str], rows: list[list[str]]) -> None:
    if keyword in ("INCLUDE", "SYSTEM", "NGEN", "ELGEN", "NFILL", "NCOPY", "ELCOPY"):
        raise ValueError("this keyword is not read: write the nodes and elements out")
    if keyword == "NODE":
        found = {int(row[0]): [float(x) for x in row[1:4]] for row in rows}
        if any(len(place) != 3 for place in found.values()):
            raise ValueError("a node needs its number and three coordinates")
        deck.nodes |= found
        _add(deck.node_sets, options.get("NSET"), list(found))
    elif keyword == "ELEMENT":
        made = {int(row[0]): [int(n) for n in row[1:]] for row in rows}
        deck.elements.setdefault(options["TYPE"].upper() if "TYPE" in options else "", {}).update(made)
        _add(deck.element_sets, options.get("ELSET"), list(made))
    elif keyword in ("NSET", "ELSET"):
        sets = deck.node_sets if keyword == "NSET" else deck.element_sets
        _add(sets, options.get(keyword), _members(rows, sets, generated="GENERATE" in options))
    elif keyword == "SURFACE" and options.get("TYPE", "ELEMENT").upper() == "ELEMENT":
        mine = deck.surfaces.setdefault(options.get("NAME", ""), [])
        mine += [(row[0], row[1].upper()) for row in rows if len(row) > 1]
    elif keyword == "INSTANCE":
        deck.instances += 1


def _add(sets: dict[str, list[int]], name: str | None, members: list[int]) -> None:
    if name:
        sets.setdefault(_key(sets, name), []).extend(members)


def _key(sets: dict[str, list[int]], name: str) -> str:
    """The name as it stands in the sets, whatever its capitals."""
    return next((known for known in sets if known.casefold() == name.casefold()), name)


def _members(rows: list[list[str]], sets: dict[str, list[int]], *, generated: bool) -> list[int]:
    if generated:
        ends = [[int(n) for n in row] for row in rows]
        return [n for first, last, *step in ends for n in range(first, last + 1, step[0] if step else 1)]
    found: list[int] = []
    for one in (cell for row in rows for cell in row if cell):
        found += [int(one)] if one.lstrip("-").isdigit() else sets[_known(sets, one)]
    return found


def _known(sets: dict[str, list[int]], name: str) -> str:
    key = _key(sets, name.strip('"'))
    if key not in sets:
        raise ValueError(f"there is no set {name}")
    return key


def _content(deck: _Deck, path: Path) -> FileMesh:
    numbers = np.array(sorted(deck.nodes), dtype=np.int64)
    points = np.array([deck.nodes[n] for n in numbers.tolist()], dtype=np.float64).reshape(-1, 3)
    blocks, row_of, flat = [], dict[int, int](), 0
    for type_, elements in deck.elements.items():
        solid = _SOLID.match(type_)
        if solid is None:
            flat += len(elements) if _FLAT.match(type_) else 0
            continue
        n = int(solid[1])
        wrong = next((number for number, nodes in elements.items() if len(nodes) != n), None)
        if wrong is not None:
            rule = f"has element {wrong} of type {type_} with {len(elements[wrong])} nodes"
            raise InputError("mesh file", path, rule, _HINT)
        nodes = _rows(np.array(list(elements.values()), dtype=np.int64).reshape(-1, n), numbers, path)
        placed = np.empty_like(nodes)
        placed[:, list(_ORDERS.get(n, range(n)))] = nodes
        row_of |= {number: len(row_of) + k for k, number in enumerate(elements)}
        blocks.append(CellBlock(kind=_KIND.get(n, type_), nodes=placed, numbers=np.array(list(elements))))
    groups = {
        name: np.array([row_of[number] for number in members if number in row_of], dtype=np.int64)
        for name, members in deck.element_sets.items()
    }
    return FileMesh(
        points=points,
        node_numbers=numbers,
        blocks=blocks,
        groups={name: cells for name, cells in groups.items() if len(cells)},
        node_sets={name: _rows(np.array(n, dtype=np.int64), numbers, path) for name, n in deck.node_sets.items() if n},
        cell_faces={name: _faces(deck, entries, row_of, blocks, path) for name, entries in deck.surfaces.items()},
        flat=flat,
    )


def _rows(wanted: Index, numbers: Index, path: Path) -> Index:
    """Places of node numbers among those of the deck."""
    at = np.minimum(np.searchsorted(numbers, wanted), max(len(numbers) - 1, 0))
    absent = wanted[numbers[at] != wanted] if len(numbers) else wanted.ravel()
    if len(absent):
        raise InputError("mesh file", path, f"names node {absent[0]}, which it does not have", _HINT)
    return np.asarray(at, dtype=np.int64)


def _faces(
    deck: _Deck, entries: list[tuple[str, str]], row_of: dict[int, int], blocks: list[CellBlock], path: Path
) -> Index:
    """Cell and gmsh's number of the face, (k, 2), of a surface's entries: an element or a set of them, and S1 ..."""
    corners = 4 if blocks and "tetra" in blocks[0].kind else 8
    ours = [frozenset(face) for face in (TETRAHEDRON_FACES if corners == 4 else FACE_CORNERS)]
    number = {f"S{k}": ours.index(frozenset(face)) for k, face in enumerate(_FACES[corners], start=1)}
    found = []
    for where, face in entries:
        name = _key(deck.element_sets, where)
        members = [int(where)] if where.isdigit() else deck.element_sets.get(name, [])
        if face not in number or not members or any(one not in row_of for one in members):
            rule = f"has a surface with {where}, {face}, which is no face of solid elements"
            raise InputError("mesh file", path, rule, f"name faces {', '.join(number)} of elements")
        found += [(row_of[one], number[face]) for one in members]
    return np.array(found, dtype=np.int64).reshape(-1, 2)
