"""Meshes the solids of a STEP file in tetrahedra of second order: gmsh, by OpenCASCADE.

Solids that touch are joined: their common faces are cut to be one, and meshed once. A name is that of the file's
product. Verified by tests/unit/test_own_mesh_step.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.input_file import require_ordinary_file
from geometry.counting import LARGEST_MESH
from geometry.gmsh_session import gmsh_session
from geometry.own_mesh.file_mesh import FileMesh
from geometry.own_mesh.gmsh_files import cell_blocks, face_corners, node_table
from geometry.own_mesh.step_body import StepBody, StepFace, StepSizes, StepSolid
from geometry.step import in_metres, silenced_stdout

__all__ = ["LARGEST_STEP", "STEP_ENDINGS", "read_step"]

Index = NDArray[np.int64]
Entity = tuple[int, int]

STEP_ENDINGS = (".step", ".stp")
LARGEST_STEP = 200_000_000
"""Of a STEP file [byte]."""
_OF_AN_EDGE = 2.0**-1.5 / 3.0
"""Volume of a regular tetrahedron over its edge's third power [-]."""
_NO_NAME = re.compile(r"Open CASCADE STEP translator.*|SOLID|COMPOUND|COMPSOLID|SHELL|Shapes|\d+|")
_FLAT, _BENT = 0.1, 0.5
"""Radius of the inscribed over that of the circumscribed sphere (1 if regular), and scaled Jacobian of the map (1 if
straight), below which tetrahedra are improved [-]: in walls of one element some have all corners on one face."""
_SAME_VOLUME = 1e-6
"""Of the solids before they are joined and after: more is an overlap."""


def read_step(path: Path, sizes: StepSizes) -> StepBody:
    """The solids of a STEP file, whatever its unit, meshed in metres.

    Raises
    ------
    InputError
        For a file that is no STEP, that has no solids or some that overlap, sizes that make too many elements or that
        are given for solids that are not there, and shapes that gmsh cannot mesh.
    """
    require_ordinary_file(path, "mesh file", LARGEST_STEP)
    with path.open("rb") as stream:
        begin = stream.read(64).lstrip()
    if not begin.startswith(b"ISO-10303-21"):
        hint = "export it as STEP, AP203 or AP214"
        raise InputError("mesh file", path, "is no STEP file: it does not begin with ISO-10303-21", hint)
    with gmsh_session("STEP") as gmsh, _options(gmsh, sizes), in_metres(gmsh):
        names = _joined(gmsh, path)
        solids = [_solid(gmsh, tag, name) for tag, name in names.items()]
        _require_possible(path, solids, sizes)
        _set_sizes(gmsh, names, sizes)
        _meshed(gmsh, path, names)
        return _body(gmsh, names, solids)


@contextmanager
def _options(gmsh: Any, sizes: StepSizes) -> Iterator[None]:
    """Options of gmsh that only a STEP file needs."""
    wanted = {
        "Geometry.OCCImportLabels": 1.0,
        "Mesh.MeshSizeMax": sizes.element_size,
        "Mesh.MeshSizeFromCurvature": float(sizes.around),
        "Mesh.MeshSizeExtendFromBoundary": 1.0,
        "Mesh.Optimize": 1.0,
        "Mesh.OptimizeThreshold": 0.6,
        "Mesh.HighOrderThresholdMin": _BENT,
    }
    before = {name: gmsh.option.getNumber(name) for name in wanted}
    for name, value in wanted.items():
        gmsh.option.setNumber(name, value)
    try:
        yield
    finally:
        for name, value in before.items():
            gmsh.option.setNumber(name, value)


def _joined(gmsh: Any, path: Path) -> dict[int, str]:
    """Solids of the file, joined where they touch: number -> name."""
    occ = gmsh.model.occ
    try:
        with silenced_stdout():
            read = occ.importShapes(str(path), True, "step")
        occ.synchronize()
    except Exception as error:  # gmsh raises nothing more special
        said = " ".join(str(error).split())[:200]
        raise InputError("mesh file", path, f"cannot be read ({said})", "export it again") from error
    solids = [one for one in read if one[0] == 3]
    if not solids:
        rule = "has no solids" + (f", but {len(read)} surfaces or curves" if read else "")
        hint = "export closed solids; in the CAD program, sew surfaces to one"
        raise InputError("mesh file", path, rule, hint)
    called = [_called(gmsh, one) for one in solids]
    before = sum(occ.getMass(*one) for one in solids)
    _, pieces = occ.fragment(solids, [])
    occ.synchronize()
    owners: dict[int, list[int]] = {}
    for k, mine in enumerate(pieces[: len(solids)]):
        for dim, tag in mine:
            if dim == 3:
                owners.setdefault(tag, []).append(k)
    shared = next((found for found in owners.values() if len(found) > 1), None)
    if shared is not None:
        first, second = (called[k] or f"solid {solids[k][1]}" for k in shared[:2])
        rule = f"has solids that overlap: {first} and {second}"
        raise InputError("mesh file", path, rule, "cut one out of the other in the CAD program")
    after = sum(occ.getMass(3, tag) for tag in owners)
    if not owners or abs(after - before) > _SAME_VOLUME * abs(before) or min(occ.getMass(3, t) for t in owners) <= 0.0:
        rule = f"has solids of {1e6 * before:.4g} cm^3, which joined have {1e6 * after:.4g} cm^3"
        raise InputError("mesh file", path, rule, "repair the solids in the CAD program")
    return {tag: called[k] or str(tag) for tag, (k, *_) in sorted(owners.items())}


def _called(gmsh: Any, solid: Entity) -> str:
    """Name of the product that a solid is; empty without one."""
    labels = gmsh.model.getEntityName(*solid).split("/")
    return next((label.strip() for label in reversed(labels) if not _NO_NAME.fullmatch(label.strip())), "")


def _solid(gmsh: Any, tag: int, name: str) -> StepSolid:
    box = np.array(gmsh.model.occ.getBoundingBox(3, tag)).reshape(2, 3)
    ends = frozenset(point for _, point in gmsh.model.getBoundary([(3, tag)], recursive=True))
    return StepSolid(number=tag, name=name, volume=gmsh.model.occ.getMass(3, tag), box=box, ends=ends)


def _require_possible(path: Path, solids: Sequence[StepSolid], sizes: StepSizes) -> None:
    known = {solid.name for solid in solids}
    for name in sizes.of_solids:
        if name not in known:
            rule = f"is no solid of the file, which has {', '.join(sorted(known))}"
            raise InputError("size of solids", name, rule, "correct the name")
    least = [solid.volume / (_OF_AN_EDGE * _size(solid, sizes) ** 3) for solid in solids]
    if 4.0 * sum(least) > LARGEST_MESH:
        most = solids[int(np.argmax(least))]
        box = np.ptp(np.concatenate([solid.box for solid in solids]), axis=0)
        size = " x ".join(f"{round(1e3 * length, 1):g}" for length in box)
        rule = f"makes at least {sum(least):.3g} tetrahedra of {path.name}, whose body is {size} mm"
        rule = f"{rule}; at most {LARGEST_MESH // 4} can be solved"
        hint = "choose a larger one; a STEP file states its own unit"
        of_part = f"parts.{sizes.part_of.get(most.name, most.name)}." if most.name in sizes.of_solids else ""
        shown = f"{1e3 * _size(most, sizes):g} mm"
        raise InputError("element size", shown, rule, hint, key=f"{of_part}element_size")


def _size(solid: StepSolid, sizes: StepSizes) -> float:
    """Largest edge of a solid's elements [m]."""
    return sizes.of_solids.get(solid.name, sizes.element_size)


def _set_sizes(gmsh: Any, names: Mapping[int, str], sizes: StepSizes) -> None:
    """Sizes of some solids alone; on a common face the smaller holds."""
    field = gmsh.model.mesh.field
    made = []
    for name, size in sizes.of_solids.items():
        made.append(field.add("Constant"))
        field.setNumber(made[-1], "VIn", size)
        field.setNumbers(made[-1], "VolumesList", [tag for tag, one in names.items() if one == name])
    if made:
        least = field.add("Min")
        field.setNumbers(least, "FieldsList", made)
        field.setAsBackgroundMesh(least)


def _meshed(gmsh: Any, path: Path, names: Mapping[int, str]) -> None:
    mesh = gmsh.model.mesh
    try:
        mesh.generate(3)
        if _worst(gmsh, 4, "gamma") < _FLAT:
            mesh.optimize("Netgen")
        mesh.setOrder(2)
        if _worst(gmsh, 11, "minSJ") < _BENT:
            mesh.optimize("HighOrder")
    except Exception as error:  # gmsh raises nothing more special
        said = " ".join(str(error).split())[:200]
        hint = "choose smaller elements, or repair the shape"
        raise InputError("mesh file", path, f"cannot be meshed ({said})", hint) from error
    empty = [name for tag, name in names.items() if not len(mesh.getElementsByType(11, tag)[0])]
    if empty:
        hint = "choose smaller elements, or repair the shape"
        raise InputError("mesh file", path, f"cannot be meshed: no element in {', '.join(empty)}", hint)


def _worst(gmsh: Any, kind: int, measure: str) -> float:
    """Quality [-] of the worst tetrahedron of one of gmsh's kinds, 4 or 10 nodes."""
    tags = gmsh.model.mesh.getElementsByType(kind)[0]
    return float(min(gmsh.model.mesh.getElementQualities(tags, measure), default=0.0))


def _body(gmsh: Any, names: Mapping[int, str], solids: Sequence[StepSolid]) -> StepBody:
    numbers, points = node_table(gmsh)
    blocks, of_entity = cell_blocks(gmsh, numbers)
    groups: dict[str, list[Index]] = {}
    for tag, name in names.items():
        groups.setdefault(name, []).extend(of_entity[tag])
    faces, facets = [], dict[str, list[Index]]()
    for _, tag in gmsh.model.getEntities(2):
        beside, _ = gmsh.model.getAdjacencies(2, tag)
        if len(beside) != 1:
            continue
        facets[str(tag)], nodes = face_corners(gmsh, tag, numbers)
        faces.append(
            StepFace(
                number=tag,
                kind=gmsh.model.getType(2, tag).lower(),
                solid=names[int(beside[0])],
                area=gmsh.model.occ.getMass(2, tag),
                points=points[nodes],
            )
        )
    file = FileMesh(
        points=points,
        node_numbers=numbers,
        blocks=blocks,
        groups={name: np.concatenate(cells) for name, cells in groups.items()},
        facets=facets,
        flat=sum(len(rows) for one in facets.values() for rows in one),
    )
    return StepBody(file=file, solids=solids, faces=faces)
