"""How many cells and nodes a mesh will have, counted before anything is drawn; what no mesher could hold is refused.

Verified by tests/unit/test_geometry_counting.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from contracts.errors import InputError
from geometry.blocks import Block
from geometry.lattice import JOINTS, LATTICE
from geometry.resolution import (
    MeshSize,
    Ring,
    active_parts,
    axial_bands,
    axial_levels,
    hub_ring,
    part_names,
    rim_ring,
    sidewall_angles,
)
from geometry.section import build_section
from geometry.sidewall import weld_half_angle
from geometry.sidewall_mesh import elements_along
from geometry.wheel import WheelDesign

__all__ = ["LARGEST_MESH", "MeshCount", "count_planar", "count_solid", "require_buildable"]

LARGEST_MESH = 2_000_000
"""Most cells of a mesh: of second order some 70 million unknowns, beyond what a direct solver holds on any machine."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshCount:
    """Cells, exactly but for the cone's, and nodes, to about 5 %."""

    cells: int
    nodes: int


def count_solid(
    design: WheelDesign, size: MeshSize, order: int, parts: Literal["all", "flexible"], *, half_width: bool
) -> MeshCount:
    """What `geometry.build.build_mesh` will make of a wheel."""
    names, rings = part_names(design, parts), (rim_ring(design, size), hub_ring(design, size, parts))
    levels = axial_levels(design, parts, half_width)
    cells, nodes = 0, 0.0
    bands = axial_bands(design, size, levels)
    sections: dict[frozenset[str], tuple[int, float]] = {}
    for low, high, axial in bands:
        active = active_parts(design, names, 0.5 * (low + high))
        if active not in sections:
            sections[active] = _count_section(design, size, order, rings, active)
        faces, face_nodes = sections[active]
        cells += faces * axial
        nodes += (order * axial + 1.0 / len(bands)) * face_nodes
    for more in (_sidewall(design, size, bands, half_width), _cone(design, size, names, half_width)):
        cells += more
        nodes += more * order * _nodes_per_face(size, order)
    return MeshCount(cells=cells, nodes=math.ceil(nodes))


def count_planar(design: WheelDesign, size: MeshSize, order: int) -> MeshCount:
    """What `geometry.planar.build_planar_mesh` will make of a wheel."""
    names = frozenset(part_names(design, "flexible"))
    rings = rim_ring(design, size), hub_ring(design, size, "flexible")
    cells, nodes = _count_section(design, size, order, rings, names)
    return MeshCount(cells=cells, nodes=math.ceil(nodes))


def require_buildable(count: MeshCount, sizes: Mapping[str, float]) -> None:
    """Raise InputError for a mesh of more cells than any run could use; ``sizes`` [m] are named in it."""
    if count.cells > LARGEST_MESH:
        given = " and ".join(f"{name} = {1e3 * value:g} mm" for name, value in sizes.items())
        amount = f"{count.cells:.3g}" if count.cells > 1e7 else f"{count.cells}"
        rule = f"would make {amount} cells, at most {LARGEST_MESH} can be built and solved"
        raise InputError("mesh", given, rule, "choose larger elements or a smaller refinement factor")


def _count_section(
    design: WheelDesign, size: MeshSize, order: int, rings: tuple[Ring, Ring], active: frozenset[str]
) -> tuple[int, float]:
    """Faces and nodes of the section that the ``active`` parts make."""
    blocks = build_section(design, size, rings, active).blocks
    return sum(block.n_length * block.n_thickness for block in blocks), sum(_nodes(b, size, order) for b in blocks)


def _nodes(block: Block, size: MeshSize, order: int) -> float:
    """Nodes of a block's faces, with its share of those on its sides."""
    across = 2 * size.half_wall_elements if block.part == LATTICE else size.thickness_elements
    if block.part == JOINTS or block.part == "tread":
        across = max(across, 4)
    return block.n_length * block.n_thickness * order * (order + 1.0 / across)


def _nodes_per_face(size: MeshSize, order: int) -> float:
    """Nodes of a section for each of its faces: along a strip they are shared, through its thickness at one end."""
    return order * (order + 1.0 / size.thickness_elements)


def _sidewall(design: WheelDesign, size: MeshSize, bands: list[tuple[float, float, int]], half_width: bool) -> int:
    """Cells of sidewall springs."""
    springs = design.sidewall_springs
    if springs is None:
        return 0
    edge, ring = 0.5 * design.tire.width, rim_ring(design, size)
    weld = sum(n for low, high, n in bands if low > edge - springs.weld_length - 1e-9 and high < edge + 1e-9)
    half = weld_half_angle(springs, design.tire.inner_radius)
    across = [
        sum(int(ring.counts[i]) for i in ring.span(middle - half, middle + half)) for middle in sidewall_angles(springs)
    ]
    sides = 1 if half_width else 2
    return sides * sum(across) * (weld + sum(elements_along(springs, size))) * size.thickness_elements


def _cone(design: WheelDesign, size: MeshSize, names: tuple[str, ...], half_width: bool) -> int:
    """Cells of the cone."""
    if "cone" not in names or design.inner_hub is None:
        return 0
    length = design.outer_hub.inner_radius - design.inner_hub.outer_radius
    slant = math.hypot(length, design.cone.outer_position - design.cone.inner_position) if design.cone else length
    radial = size.refined(max(1, math.ceil(slant / size.of("cone") - 1e-6)))
    around = int(hub_ring(design, size, "all").counts.sum())
    return around * radial * size.thickness_elements * (1 if half_width else 2)
