"""STEP export: the wheel's parts over the full width as CAD solids, in millimetres, named by part.

Verified by tests/unit/test_geometry_files.py.
"""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from geometry.gmsh_session import gmsh_session
from geometry.lattice import JOINTS, LATTICE
from geometry.resolution import MeshSize, Ring, cone_joints, hub_ring, part_bands, rim_ring
from geometry.section import build_section
from geometry.solids import draw_faces, draw_frustum_section
from geometry.wheel import WheelDesign
from geometry.written import check_written

__all__ = ["in_metres", "silenced_stdout", "write_named", "write_step"]

_UNIT = "Geometry.OCCTargetUnit"
_PRODUCT = re.compile(r"PRODUCT\('[^']* \d+(?:\.(\d+))?',\s*'[^']*'")


def write_step(design: WheelDesign, path: Path) -> None:
    """Write the whole wheel as one solid per ring, grouser, spring and cone; the product's name is the part's.

    Parameters
    ----------
    design : the wheel
    path : file to write (``.step``); its folder is made if needed
    """
    names: list[str] = []
    with gmsh_session(design.name) as gmsh:
        for part, solids in _solids(gmsh, design):
            names += [part] * len(solids)
        occ = gmsh.model.occ
        occ.remove([entity for dim in (2, 1, 0) for entity in occ.getEntities(dim)])
        occ.synchronize()
        write_named(gmsh, path, names)


def write_named(gmsh: Any, path: Path, names: list[str]) -> None:
    """Write an open session's shapes, drawn in metres, with a product's name for each in the order of their tags."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with in_metres(gmsh), silenced_stdout():
        gmsh.write(str(path))
    check_written(path, b"END-ISO-10303-21;")
    text = path.read_text(encoding="utf-8")
    path.write_text(_PRODUCT.sub(lambda m: _named(m, names), text), encoding="utf-8")


@contextmanager
def in_metres(gmsh: Any) -> Iterator[None]:
    """Let OpenCASCADE take the numbers of shapes written or read as metres."""
    before = gmsh.option.getString(_UNIT)
    gmsh.option.setString(_UNIT, "M")
    try:
        yield
    finally:
        gmsh.option.setString(_UNIT, before)


@contextmanager
def silenced_stdout() -> Iterator[None]:
    """Send the process's standard output nowhere: OpenCASCADE's STEP writer reports there, whatever gmsh is told."""
    sys.stdout.flush()
    kept = os.dup(1)
    with Path(os.devnull).open("w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)


def _named(match: re.Match[str], names: list[str]) -> str:
    """Product of the k-th shape, which OpenCASCADE numbers 1.k (1 if it is the only one), with its name."""
    if match.group(1) is None and len(names) > 1:
        return match.group(0)  # the assembly
    name = names[int(match.group(1) or 1) - 1]
    return f"PRODUCT('{name}','{name}'"


def _solids(gmsh: Any, design: WheelDesign) -> Iterator[tuple[str, list[tuple[int, int]]]]:
    """Make and yield the solids of each part, in the order of their tags."""
    coarse = MeshSize(element_size=1.0, axial_size=1.0, thickness_elements=1, refinement={})
    rings = rim_ring(design, coarse), hub_ring(design, coarse, "all")
    for part, bands in part_bands(design).items():
        for low, high in bands if part != JOINTS else ():
            yield part, _extruded(gmsh, design, rings, part, (low, high))
    joints = cone_joints(design)
    for outer, inner in zip(joints[::2], joints[1::2], strict=True):
        yield "cone", _revolved(gmsh, design, outer, inner)


def _extruded(
    gmsh: Any, design: WheelDesign, rings: tuple[Ring, Ring], part: str, band: tuple[float, float]
) -> list[tuple[int, int]]:
    """Unite a part's blocks in the section plane and extrude what remains over one of its bands.

    A lattice is one solid, of walls, joints and feet.
    """
    occ = gmsh.model.occ
    coarse = MeshSize(element_size=1.0, axial_size=1.0, thickness_elements=1, refinement={})
    section = build_section(design, coarse, rings, frozenset({part, "tire"} if part == "grousers" else {part}))
    own = (LATTICE, JOINTS) if part == LATTICE else (part,)
    drawn = [(2, face) for block, face, _ in draw_faces(occ, section, band[0]) if block.part in own]
    united, _ = occ.fuse(drawn[:1], drawn[1:])
    solids = [s for s in occ.extrude(united, 0.0, band[1] - band[0], 0.0) if s[0] == 3]
    return occ.fuse(solids[:1], solids[1:])[0] if len(solids) > 1 else solids


def _revolved(
    gmsh: Any, design: WheelDesign, outer: tuple[float, float], inner: tuple[float, float]
) -> list[tuple[int, int]]:
    assert design.inner_hub is not None
    occ = gmsh.model.occ
    radii = design.outer_hub.inner_radius, design.inner_hub.outer_radius
    face = draw_frustum_section(occ, radii, (outer, inner), 0.0)
    return [s for s in occ.revolve([(2, face)], 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 2.0 * math.pi) if s[0] == 3]
