"""From a wheel design to a tagged mesh of hexahedra."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError, MeshError
from contracts.mesh import TaggedMesh
from geometry.assembly import RawMesh, assemble, join
from geometry.counting import count_solid, require_buildable
from geometry.gmsh_session import gmsh_session
from geometry.resolution import (
    MeshSize,
    active_parts,
    axial_bands,
    axial_levels,
    cone_joints,
    hub_ring,
    part_names,
    rim_ring,
)
from geometry.rules import require_count, require_positive_length
from geometry.section import build_section
from geometry.sidewall_mesh import sidewall_cells
from geometry.solids import ConeShape, Solids, add_cone, add_section, mesh_solids
from geometry.wheel import WheelDesign

__all__ = ["AXIAL_RATIO", "add_cones", "add_extruded", "build_mesh", "mesh_size"]

AXIAL_RATIO = 2.5
"""Default axial element size over ``element_size``: nothing varies fast along the axle."""

_HEXAHEDRON = {1: 5, 2: 12}
_QUADRANGLE = {1: 3, 2: 10}


def build_mesh(
    design: WheelDesign,
    *,
    element_size: float,
    axial_size: float | None = None,
    thickness_elements: int = 1,
    order: int = 2,
    half_width: bool = True,
    refinement: Mapping[str, float] | None = None,
    parts: Literal["all", "flexible"] = "all",
    factor: float = 1.0,
    edge_size: float | None = None,
) -> TaggedMesh:
    """Mesh a wheel with structured hexahedra, conforming at every junction.

    Parameters
    ----------
    design : the wheel
    element_size : largest element length along strips and around rings [m]; half rings have at least 8 elements
    axial_size : largest element length along the axle [m]; by default ``AXIAL_RATIO * element_size``
    thickness_elements : elements through every thickness (strips, rings, grousers, cone)
    order : 1 for 8-node, 2 for 27-node hexahedra on the curved geometry
    half_width : mesh y in [0, width/2] with the face group ``"symmetry"`` at y = 0; else the full width
    refinement : part name -> element size [m] where it differs from ``element_size``
    parts : ``"all"``, or ``"flexible"`` without cone, impact springs and inner hub
    factor : at least 1; every count of elements along strips and along the axle is multiplied by it and rounded up,
        those through a thickness are not: whole factors give nested meshes
    edge_size : length along the axle of the elements at the edges of strips [m], see `MeshSize`; None: like the others

    Returns
    -------
    mesh : points [m] in the wheel frame; parts ``"tire"``, ``"grousers"``, one per spring set, ``"outer_hub"``,
        ``"cone"``, ``"impact_springs"``, ``"inner_hub"``; face groups ``"tire_outer"``, ``"tire_inner"``,
        ``"grouser_outer"``, ``"outer_hub_outer"``, ``"outer_hub_bore"``, ``"inner_hub_outer"``, ``"inner_hub_bore"``,
        ``"symmetry"`` (half width), per spring set ``"{set}_front"`` (the strips' broad side that faces rim and hub)
        and ``"{set}_back"`` (the other one, free faces of the welds included), and ``"free"`` for every boundary facet
        that is left

    Raises
    ------
    InputError
        For sizes out of range, unknown part names, more cells than can be built and solved, or a half of a wheel that
        is not symmetric about y = 0.

    Verified by tests/verification/test_mesh_volume.py and tests/verification/test_mesh_conformity.py.
    """
    if not (math.isfinite(factor) and factor >= 1.0):
        raise InputError("refinement factor", factor, "must be at least 1", "choose a larger element size instead")
    size = mesh_size(design, element_size, axial_size, thickness_elements, refinement, edge_size)
    size = replace(size, factor=factor)
    if order not in _HEXAHEDRON:
        raise InputError("order", order, "must be 1 or 2", "use 2 for curved geometry")
    names = part_names(design, parts)
    require_buildable(
        count_solid(design, size, order, parts, half_width=half_width),
        {"element_size": element_size, "axial_size": size.axial_size},
    )
    with gmsh_session(design.name) as gmsh:
        solids = add_extruded(gmsh, design, size, parts, half_width)
        mesh_solids(gmsh, solids, order)
        raw = _extract(gmsh, solids, order)
    if "cone" in names:
        with gmsh_session(f"{design.name} cone") as gmsh:
            solids = add_cones(gmsh, design, size, half_width)
            mesh_solids(gmsh, solids, order)
            raw = join(raw, _extract(gmsh, solids, order))
    if design.sidewall_springs is not None:
        rim = rim_ring(design, size), axial_levels(design, parts, half_width)
        raw = join(raw, sidewall_cells(design, size, rim, order, half_width))
    return assemble(raw, names)


def add_extruded(
    gmsh: Any, design: WheelDesign, size: MeshSize, parts: Literal["all", "flexible"], half_width: bool
) -> Solids:
    """Draw every axial band, which is every part but the cone, in an open gmsh session."""
    names = part_names(design, parts)
    rings = rim_ring(design, size), hub_ring(design, size, parts)
    solids = Solids()
    for k, band in enumerate(axial_bands(design, size, axial_levels(design, parts, half_width))):
        section = build_section(design, size, rings, active_parts(design, names, 0.5 * (band[0] + band[1])))
        add_section(gmsh, solids, section, band, "symmetry" if half_width and k == 0 else None)
    return solids


def add_cones(gmsh: Any, design: WheelDesign, size: MeshSize, half_width: bool) -> Solids:
    """Draw the cone, and over the full width its mirror image, in an open gmsh session."""
    solids, joints = Solids(), cone_joints(design)
    ring = hub_ring(design, size, "all")
    for outer, inner in [joints[:2]] if half_width else [joints[:2], joints[2:]]:
        add_cone(gmsh, solids, _cone_shape(design, size, outer, inner), ring)
    return solids


def _cone_shape(
    design: WheelDesign, size: MeshSize, outer: tuple[float, float], inner: tuple[float, float]
) -> ConeShape:
    assert design.inner_hub is not None
    radii = design.outer_hub.inner_radius, design.inner_hub.outer_radius
    slant = math.hypot(radii[0] - radii[1], outer[0] - inner[0])
    return ConeShape(
        radii=radii,
        joints=(outer, inner),
        n_radial=size.refined(max(1, math.ceil(slant / size.of("cone") - 1e-6))),
        n_thickness=size.thickness_elements,
    )


def mesh_size(
    design: WheelDesign,
    element_size: float,
    axial_size: float | None,
    thickness_elements: int,
    refinement: Mapping[str, float] | None,
    edge_size: float | None = None,
) -> MeshSize:
    """Element sizes [m], checked; raises InputError for sizes out of range or parts that the wheel does not have."""
    require_positive_length("element size", element_size)
    axial = AXIAL_RATIO * element_size if axial_size is None else axial_size
    require_positive_length("axial size", axial)
    require_count("elements through the thickness", thickness_elements)
    if edge_size is not None:
        require_positive_length("edge size", edge_size)
    for name, value in (refinement or {}).items():
        require_positive_length(f"element size of {name}", value)
        if name not in design.materials:
            raise InputError("refinement", name, "is not a part of the wheel", f"use {', '.join(design.materials)}")
    return MeshSize(
        element_size=element_size,
        axial_size=axial,
        thickness_elements=thickness_elements,
        refinement=dict(refinement or {}),
        edge_size=edge_size,
    )


def _extract(gmsh: Any, solids: Solids, order: int) -> RawMesh:
    """Nodes, cells by part and quadrangles by face group, as gmsh made them."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    index[tags] = np.arange(len(tags))

    def elements(dim: int, tag: int, kind: int) -> NDArray[np.int64]:
        kinds, _, nodes = gmsh.model.mesh.getElements(dim, tag)
        if list(kinds) != [kind]:
            raise MeshError(f"gmsh could not divide entity {tag} into structured cells; try a smaller element size")
        per_cell = {5: 8, 12: 27, 3: 4, 10: 9}[kind]
        return index[np.asarray(nodes[0], dtype=np.int64)].reshape(-1, per_cell)

    return RawMesh(
        points=np.asarray(coordinates, dtype=np.float64).reshape(-1, 3),
        cells=[(part, elements(3, tag, _HEXAHEDRON[order])) for part, tag in solids.volumes],
        quadrangles=[(group, elements(2, tag, _QUADRANGLE[order])[:, :4]) for group, tag in solids.surfaces],
    )
