"""What a wheel's own mesh must be as a wheel: in one piece with its hub, of a wheel's size, about its axle.

Verified by tests/unit/test_own_mesh_faults.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.hexahedra import face_nodes
from geometry.own_mesh.roles import Roles

__all__ = ["check_wheel", "outer_radius", "parts_of_faces"]

_SMALLEST, _LARGEST = 5e-3, 5.0
"""Radii of wheels [m], a toy's and a mine truck's: as the study's table of ranges has it."""
_OFF_AXLE = 0.1
"""Offset of the ground faces' middle from the axle over the radius that no wheel has [-]."""
_SAME = 1e-6
"""Relative to the radius."""


def outer_radius(mesh: TaggedMesh, ground: Iterable[str]) -> float:
    """Largest distance of the ground faces from the axle [m]."""
    return float(_radius(mesh.points[_nodes_of(mesh, ground)]).max())


def parts_of_faces(mesh: TaggedMesh, faces: Iterable[str]) -> tuple[str, ...]:
    """Parts on whose cells any face of these groups lies, in the mesh's order."""
    wanted = mesh.facets[np.isin(mesh.facet_tags, [mesh.faces[name] for name in faces])][:, :4]
    near = np.flatnonzero(np.isin(mesh.cells[:, :8], wanted).any(axis=1))
    every = mesh.cells[near][:, face_nodes(8)[:, :4]].reshape(-1, 4)
    _, number = np.unique(np.sort(np.concatenate([every, wanted]), axis=1), axis=0, return_inverse=True)
    number = number.ravel()
    mine = np.flatnonzero(np.isin(number[: len(every)], number[len(every) :]))
    tags = set(mesh.cell_tags[near[mine // 6]].tolist())
    return tuple(name for name, tag in mesh.parts.items() if tag in tags)


def check_wheel(mesh: TaggedMesh, roles: Roles, name: Callable[[int], str]) -> None:
    """Raise InputError for a mesh that is no wheel; ``name`` tells one of its cells in words."""
    radius = outer_radius(mesh, roles.ground)
    if not _SMALLEST <= radius <= _LARGEST:
        rule = f"is that of no wheel: it must lie between {1e3 * _SMALLEST:g} and {1e3 * _LARGEST:g} mm"
        hint = 'state the unit of the file\'s lengths in units, e.g. "mm"'
        raise InputError("radius of the ground faces", _length(radius), rule, hint, key="units")
    _require_about_axle(mesh, roles, radius)
    _require_outermost(mesh, roles, radius, name)
    _require_symmetry(mesh, roles, radius, name)
    _require_deformable(mesh, roles)
    _require_held(mesh, roles, name)


def _require_about_axle(mesh: TaggedMesh, roles: Roles, radius: float) -> None:
    points = mesh.points[_nodes_of(mesh, roles.ground)]
    low, high = points.min(axis=0), points.max(axis=0)
    for axis, what in ((0, "forward"), (2, "up")):
        middle = 0.5 * float(low[axis] + high[axis])
        if abs(middle) > _OFF_AXLE * radius:
            found = f"{_length(low[axis])} to {_length(high[axis])} {what}"
            rule = "lie off the axle, which goes through centre along axle"
            raise InputError("ground faces", found, rule, "give the hub's centre, and the axle's axis", key="centre")
    across = min(float(high[axis] - low[axis]) for axis in (0, 2))
    if across < radius:
        rule = "do not go around the axle"
        raise InputError("ground faces", f"{_length(across)} across", rule, "check axle, centre and ground", key="axle")


def _require_outermost(mesh: TaggedMesh, roles: Roles, radius: float, name: Callable[[int], str]) -> None:
    beyond = _radius(mesh.points) > radius * (1.0 + _SAME)
    if beyond.any():
        farthest = _radius(mesh.points)[mesh.cells].max(axis=1)
        cell, far = int(farthest.argmax()), _length(float(farthest.max()))
        rule = f"end at {_length(radius)} from the axle, but {name(cell)} of part {_part(mesh, cell)} reaches {far}"
        hint = "name every group of faces that may touch the ground"
        raise InputError("ground faces", ", ".join(roles.ground), rule, hint, key="ground")


def _require_symmetry(mesh: TaggedMesh, roles: Roles, radius: float, name: Callable[[int], str]) -> None:
    if not roles.symmetry:
        return
    plane = mesh.points[_nodes_of(mesh, ["symmetry"]), 1]
    if np.abs(plane).max() > _SAME * radius:
        worst = _length(float(plane[np.abs(plane).argmax()]))
        raise InputError(
            "symmetry", roles.symmetry, f"must lie in y = 0, one node lies at {worst}", "give centre", key="symmetry"
        )
    side = mesh.points[mesh.cells, 1].mean(axis=1)
    if side.min() < 0.0 < side.max():
        cell = int(np.flatnonzero(side < 0.0)[0])
        rule = f"must be the edge of half a wheel, but {name(cell)} lies on its other side"
        raise InputError("symmetry", roles.symmetry, rule, "leave it out for a whole wheel", key="symmetry")


def _require_deformable(mesh: TaggedMesh, roles: Roles) -> None:
    """Not every cell is held, and none that may touch the ground."""
    held = roles.held_parts
    if np.isin(mesh.cell_tags, [mesh.parts[part] for part in held]).all():
        raise InputError("parts", ", ".join(held), "hold every cell", "leave a part that can deform", key="hub")
    pressed = [part for part in parts_of_faces(mesh, roles.ground) if part in held]
    if pressed:
        rule = f"is held whole, though it has faces of {', '.join(roles.ground)}, which may touch the ground"
        hint = "name other ground faces, or faces to hold in the part's place"
        raise InputError("part", ", ".join(pressed), rule, hint, key="hub")


def _require_held(mesh: TaggedMesh, roles: Roles, name: Callable[[int], str]) -> None:
    """Every piece of the mesh hangs on what is held."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n_cells, n_nodes = mesh.cells.shape
    rows = np.repeat(np.arange(n_cells), n_nodes)
    size = n_cells + len(mesh.points)
    graph = coo_array((np.ones(len(rows)), (rows, n_cells + mesh.cells.ravel())), shape=(size, size))
    _, piece = connected_components(graph, directed=False)
    tags = [mesh.parts[part] for part in roles.held_parts]
    held = np.concatenate([mesh.cells[np.isin(mesh.cell_tags, tags)].ravel(), _nodes_of(mesh, roles.held_faces)])
    loose = np.flatnonzero(~np.isin(piece[:n_cells], piece[n_cells + held]))
    if len(loose):
        parts = ", ".join(dict.fromkeys(_part(mesh, int(cell)) for cell in loose))
        rule = f"do not hang on the hub by common nodes, the first is {name(int(loose[0]))}"
        hint = "merge the nodes where parts are joined, or name what holds them in hub"
        raise InputError("cells", f"{len(loose)} of {parts}", rule + _touching(mesh, loose), hint, key="hub")


def _touching(mesh: TaggedMesh, loose: NDArray[np.int64]) -> str:
    """How many nodes of loose cells lie on nodes of others, in words."""
    from scipy.spatial import cKDTree

    mine = np.unique(mesh.cells[loose])
    others = np.setdiff1d(np.arange(len(mesh.points)), mine)
    if not len(others):
        return ""
    distance, _ = cKDTree(mesh.points[others]).query(mesh.points[mine])
    near = int(np.count_nonzero(distance < 1e-7))
    return f"; {near} of their nodes lie on nodes of the rest" if near else ""


def _nodes_of(mesh: TaggedMesh, faces: Iterable[str]) -> NDArray[np.int64]:
    tags = [mesh.faces[name] for name in faces]
    return np.unique(mesh.facets[np.isin(mesh.facet_tags, tags)])


def _radius(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.hypot(points[:, 0], points[:, 2]))


def _part(mesh: TaggedMesh, cell: int) -> str:
    return next(name for name, tag in mesh.parts.items() if tag == mesh.cell_tags[cell])


def _length(metres: float) -> str:
    return f"{metres:.4g} m" if abs(metres) >= 10.0 else f"{1e3 * metres:.4g} mm"
