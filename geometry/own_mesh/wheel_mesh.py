"""From a mesh file's content to the wheel that is solved, in the wheel frame, with named parts and faces.

Verified by tests/unit/test_own_mesh_wheel.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.assembly import boundary_facets
from geometry.counting import LARGEST_MESH
from geometry.hexahedra import face_nodes
from geometry.own_mesh.cell_checks import require_finite, require_sound, solid_cells
from geometry.own_mesh.completion import completed, corners_of_faces, refined
from geometry.own_mesh.file_mesh import FileMesh
from geometry.own_mesh.roles import Placement, Roles
from geometry.own_mesh.wheel_checks import check_wheel

__all__ = ["OTHER_FACES", "SYMMETRY", "wheel_of_file"]

Index = NDArray[np.int64]

SYMMETRY = "symmetry"
"""What the solver knows the plane of symmetry by."""
OTHER_FACES = "other_faces"
"""Group of the faces that the study names nowhere."""


def wheel_of_file(file: FileMesh, roles: Roles, placement: Placement, factor: int = 1) -> TaggedMesh:
    """The wheel of a mesh file.

    Parameters
    ----------
    file : what the file holds
    roles : what its names stand for; parts and groups of faces keep the names that it gives them
    placement : unit and axes
    factor : each hexahedron is divided into so many along each of its axes

    Returns
    -------
    mesh : hexahedra of 8 or 27 nodes [m]; 20-node ones and tetrahedra are completed, see `completion.completed`

    Raises
    ------
    InputError
        For cells that cannot be solved, that are inverted or whose nodes are in another program's order, for names
        that the file does not have, for parts that hang on nothing, faces that are none of the wheel's outside, and a
        wheel that is no wheel of that size about that axle.
    """
    cells, numbers = solid_cells(file)
    require_finite(file, cells)
    tags = _part_of_cells(file, roles, numbers)
    require_sound(file.points, cells, lambda cell: f"cell {numbers[cell]} of part {list(roles.parts)[tags[cell] - 1]}")
    _require_solvable(len(cells), cells.shape[1], factor)
    made = refined(completed(file.points, cells), factor)
    groups = {name: _faces_of_group(file, cells, name, key) for name, key in roles.faces.items()}
    facets, facet_tags, faces = _facets(
        made.cells, {name: made.faces[at[:, 0], at[:, 1]] for name, at in groups.items()}
    )
    used, flat = np.unique(made.cells, return_inverse=True)
    place = np.full(len(made.points), -1, dtype=np.int64)
    place[used] = np.arange(len(used))
    renamed = {(SYMMETRY if name == roles.symmetry else name): tag for name, tag in faces.items()}
    mesh = TaggedMesh(
        points=placement.to_wheel(made.points[used]),
        cells=flat.reshape(made.cells.shape).astype(np.int64),
        cell_tags=tags[made.cell_of].astype(np.int32),
        facets=place[facets],
        facet_tags=facet_tags,
        parts={name: k for k, name in enumerate(roles.parts, start=1)},
        faces=renamed,
    )
    check_wheel(mesh, roles, lambda cell: f"cell {numbers[made.cell_of[cell]]}")
    return mesh


def _require_solvable(cells: int, nodes: int, factor: int) -> None:
    total = cells * (4 if nodes in (4, 10) else 1) * factor**3
    if total > LARGEST_MESH:
        rule = f"makes {total} hexahedra of {cells} cells, at most {LARGEST_MESH} can be solved"
        raise InputError("mesh factor", factor, rule, "choose a smaller one, or mesh with larger elements")


def _part_of_cells(file: FileMesh, roles: Roles, numbers: Index) -> Index:
    """Number of the part of each cell, from 1."""
    tags = np.zeros(len(numbers), dtype=np.int64)
    part_of = {group: k for k, groups in enumerate(roles.parts.values(), start=1) for group in groups}
    for name, number in part_of.items():
        part = list(roles.parts)[number - 1]
        group = _named(file.groups, name)
        if group is None or not len(file.groups[group]):
            rule = f"is no group of cells in the mesh file, which has {_listed(file.groups)}"
            raise InputError("group of cells", name, rule, "correct the name", key=f"parts.{part}")
        mine = file.groups[group]
        twice = mine[(tags[mine] > 0) & (tags[mine] != number)]
        if len(twice):
            rule = f"shares {len(twice)} cells with part {list(roles.parts)[tags[twice[0]] - 1]}, the first is cell "
            hint = "name groups that share no cell"
            raise InputError("part", part, f"{rule}{numbers[twice[0]]}", hint, key=f"parts.{part}")
        tags[mine] = number
    left = np.flatnonzero(tags == 0)
    if len(left):
        of_no_part = {name: group for name, group in file.groups.items() if np.isin(left, group).any()}
        told = f"those of {_listed(of_no_part)}" if of_no_part else "they are in no group"
        rule = f"leaves {len(left)} cells without a material, {told}; the first is cell {numbers[left[0]]}"
        hint = "add a part for them" if of_no_part else "put every cell into a group in the program that made the mesh"
        raise InputError("mesh.parts", "", rule, hint)
    return tags


def _faces_of_group(file: FileMesh, cells: Index, name: str, key: str) -> Index:
    """Cell and face number (k, 2) of each face of a group; all lie on the outside of the body."""
    found = _named(dict.fromkeys(file.face_names), name)
    if found is None:
        hint = "correct the name, or name the faces in the program that made the mesh"
        rule = f"is no group of faces in the mesh file, which has {_listed(file.face_names)}"
        raise InputError("group of faces", name, rule, hint, key=key)
    local = corners_of_faces(cells.shape[1])
    every = np.sort(cells[:, np.array(local)].reshape(-1, len(local[0])), axis=1)
    _, number, count = np.unique(every, axis=0, return_inverse=True, return_counts=True)
    number, outside = number.ravel(), count[number.ravel()] == 1
    if found in file.facets:
        chosen = _of_corners(file, every, name, found, key)
    elif found in file.cell_faces:
        chosen = file.cell_faces[found] @ np.array([len(local), 1])
    else:
        member = np.zeros(len(file.points), dtype=np.bool_)
        member[file.node_sets[found]] = True
        chosen = np.flatnonzero(_all_nodes(cells, member) & outside)
    if not len(chosen):
        rule = "holds no face of the wheel"
        if found in file.node_sets:
            rule += f": its {len(file.node_sets[found])} nodes are all nodes of no face on the outside"
        raise InputError("group of faces", name, rule, "name another, or mesh its faces too", key=key)
    inner = chosen[~outside[chosen]]
    if len(inner):
        nodes = ", ".join(str(n) for n in file.node_numbers[every[inner[0]]])
        rule = f"holds {len(np.unique(number[inner]))} faces between two cells, the first has the nodes {nodes}"
        raise InputError("group of faces", name, rule, "name faces on the outside of the body", key=key)
    chosen = np.unique(chosen)
    return np.column_stack([chosen // len(local), chosen % len(local)])


def _of_corners(file: FileMesh, every: Index, name: str, found: str, key: str) -> Index:
    """Rows of ``every`` face (m, corners) that are the faces of a group given by its corners."""
    wanted = [np.sort(faces, axis=1) for faces in file.facets[found] if len(faces)]
    if any(faces.shape[1] != every.shape[1] for faces in wanted):
        rule = f"has faces of other than {every.shape[1]} corners, which are none of these cells'"
        raise InputError("group of faces", name, rule, "mesh surface and volume together", key=key)
    rows = np.concatenate([np.zeros((0, every.shape[1]), dtype=np.int64), *wanted])
    _, number = np.unique(np.concatenate([every, rows]), axis=0, return_inverse=True)
    number = number.ravel()
    mine, theirs = number[: len(every)], number[len(every) :]
    alone = np.flatnonzero(~np.isin(theirs, mine))
    if len(alone):
        nodes = ", ".join(str(n) for n in file.node_numbers[rows[alone[0]]])
        rule = f"holds {len(alone)} faces that are no face of any cell, the first has the nodes {nodes}"
        raise InputError("group of faces", name, rule, "mesh surface and volume together", key=key)
    return np.flatnonzero(np.isin(mine, theirs))


def _all_nodes(cells: Index, member: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether all nodes that the file has of a face are members, (n_cells * faces,); for a tetrahedron its corners."""
    n = cells.shape[1]
    if n in (4, 10):
        local = np.array(corners_of_faces(n))
    else:
        local = face_nodes(27 if n >= 20 else 8)[:, : {8: 4, 20: 8, 27: 9}[n]]
    return np.asarray(member[cells[:, local]].all(axis=2).ravel())


def _facets(cells: Index, groups: dict[str, Index]) -> tuple[Index, NDArray[np.int32], dict[str, int]]:
    """Every outer facet of the hexahedra with its tag, and the groups' tags."""
    local = face_nodes(cells.shape[1])
    outer = boundary_facets(cells)
    every = np.concatenate([outer, *(_nodes(cells, local, group) for group in groups.values())])
    _, number = np.unique(np.sort(every, axis=1), axis=0, return_inverse=True)
    number = number.ravel()
    tag_of = np.zeros(int(number.max()) + 1, dtype=np.int32)
    at = len(outer)
    names = dict(enumerate(groups, start=1))
    for tag, (name, group) in enumerate(groups.items(), start=1):
        mine = number[at : at + group.size // 2]
        at += group.size // 2
        both = tag_of[mine][tag_of[mine] > 0]
        if len(both):
            rule = f"shares {len(both)} faces with {names[int(both[0])]}"
            raise InputError("group of faces", name, rule, "name groups that share no face")
        tag_of[mine] = tag
    tags = tag_of[number[: len(outer)]]
    tags[tags == 0] = len(groups) + 1
    faces = {name: tag for tag, name in names.items()}
    return outer, tags, faces | ({OTHER_FACES: len(groups) + 1} if np.any(tags == len(groups) + 1) else {})


def _nodes(cells: Index, local: Index, group: Index) -> Index:
    """Nodes of faces given by cell and number, (k, nodes)."""
    flat = group.reshape(-1, 2)
    return np.take_along_axis(cells[flat[:, 0]], local[flat[:, 1]], axis=1)


def _named(known: object, name: str) -> str | None:
    """The name as the file has it: the same, or the only one that differs in capitals alone."""
    names = [str(one) for one in known]  # type: ignore[attr-defined]
    alike = [one for one in names if one.casefold() == name.casefold()]
    return name if name in names else alike[0] if len(alike) == 1 else None


def _listed(names: object) -> str:
    known = [str(one) for one in names]  # type: ignore[attr-defined]
    return (", ".join(known[:12]) + (f" and {len(known) - 12} more" if len(known) > 12 else "")) or "none"
