"""The mesh hangs together at every junction, its cells are upright, and its boundary is wholly named.

Claim: cells meet node to node, no two nodes coincide, all parts are one piece; each boundary facet is in exactly one
face group; nodes lie on the surfaces they belong to; the same design gives the same mesh.
Source: the definition of a conforming mesh; surfaces from the design's radii.
Tolerance: nodes on their surface to 1 nm (0.609 mm strips); scaled Jacobian > 0.99 for strips, rings and grousers, and
>= cos(slope) - 0.01 for the cone, whose cells are sheared by its slope.
Negative controls: springs whose weld nodes are not merged, one weld of one spring not merged, a part moved away, a
flipped cell, untagged, doubly tagged and wrongly tagged facets, middle nodes that are not shared: each is caught.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import MeshError
from contracts.mesh import TaggedMesh
from geometry.assembly import boundary_facets
from geometry.build import build_mesh
from geometry.checks import (
    check_boundary_tagged,
    check_connected,
    check_matches_design,
    check_mesh,
    check_no_coincident_nodes,
    check_not_inverted,
)
from geometry.hexahedra import face_nodes
from geometry.measures import mesh_quality, scaled_jacobians
from geometry.wheel import exomars_hoops

WHEEL = exomars_hoops()


@pytest.fixture(scope="module")
def mesh() -> TaggedMesh:
    return build_mesh(WHEEL, element_size=12e-3)


@pytest.mark.parametrize(
    ("order", "half_width", "thickness_elements"), [(1, True, 1), (1, False, 2), (2, False, 1), (2, True, 3)]
)
def test_every_kind_of_mesh_passes_its_checks(order: int, half_width: bool, thickness_elements: int) -> None:
    mesh = build_mesh(
        WHEEL, element_size=15e-3, order=order, half_width=half_width, thickness_elements=thickness_elements
    )
    check_mesh(mesh)
    assert list(mesh.parts) == list(WHEEL.materials)
    assert ("symmetry" in mesh.faces) == half_width


def test_local_refinement_stays_conforming(mesh: TaggedMesh) -> None:
    fine = build_mesh(WHEEL, element_size=12e-3, refinement={"springs_outer": 3e-3, "tire": 6e-3})
    check_mesh(fine)
    check_matches_design(fine, WHEEL)

    def cells(of: TaggedMesh, part: str) -> int:
        return int(np.count_nonzero(of.cell_tags == of.parts[part]))

    assert cells(fine, "springs_outer") > 2 * cells(mesh, "springs_outer")
    assert cells(fine, "tire") > 1.5 * cells(mesh, "tire")
    assert cells(fine, "impact_springs") == cells(mesh, "impact_springs")


def test_size_of_the_flexible_half_wheel() -> None:
    """600 to 1200 cells at 8 mm, as the finite element model was planned for."""
    quality = mesh_quality(build_mesh(WHEEL, element_size=8e-3, parts="flexible"))
    assert 600 <= quality.n_cells <= 1200
    assert quality.min_scaled_jacobian > 0.99
    assert quality.min_edge == pytest.approx(0.609e-3, rel=1e-9)


def test_cells_are_upright(mesh: TaggedMesh) -> None:
    scaled = scaled_jacobians(mesh)
    assert WHEEL.cone is not None
    slope = math.atan2(WHEEL.cone.outer_position - WHEEL.cone.inner_position, 0.048 - 0.020)
    for part, tag in mesh.parts.items():
        least = math.cos(slope) - 0.01 if part == "cone" else 0.99
        assert scaled[mesh.cell_tags == tag].min() > least, part


@pytest.mark.parametrize("thickness_elements", [1, 3])
def test_nodes_lie_on_their_surfaces(thickness_elements: int) -> None:
    mesh = build_mesh(WHEEL, element_size=12e-3, thickness_elements=thickness_elements)
    radii = {
        "tire_outer": 0.1425,
        "tire_inner": 0.1425 - 0.609e-3,
        "outer_hub_outer": 0.050,
        "outer_hub_bore": 0.048,
        "inner_hub_outer": 0.020,
        "inner_hub_bore": 0.017,
    }
    for group, radius in radii.items():
        points = mesh.points[np.unique(mesh.facets[mesh.facet_tags == mesh.faces[group]])]
        assert np.hypot(points[:, 0], points[:, 2]) == pytest.approx(radius, abs=1e-9), group
    symmetry = mesh.points[np.unique(mesh.facets[mesh.facet_tags == mesh.faces["symmetry"]])]
    assert np.abs(symmetry[:, 1]).max() < 1e-12
    tire = mesh.points[np.unique(mesh.cells[mesh.cell_tags == mesh.parts["tire"]])]
    levels = 0.1425 - 0.609e-3 * np.linspace(0.0, 1.0, 2 * thickness_elements + 1)
    off = np.abs(np.hypot(tire[:, 0], tire[:, 2])[:, None] - levels[None, :]).min(axis=1)
    assert off.max() < 1e-9


def test_tire_and_grousers_make_the_whole_outside(mesh: TaggedMesh) -> None:
    """Outer faces of the tire start and end at the grousers' feet; tips reach the grouser height."""
    points = mesh.points[np.unique(mesh.facets[mesh.facet_tags == mesh.faces["grouser_outer"]])]
    radius = np.hypot(points[:, 0], points[:, 2])
    assert radius.max() == pytest.approx(0.1455, abs=1e-9)
    assert radius.min() == pytest.approx(0.1425, abs=1e-9)
    local = mesh.points[mesh.facets[mesh.facet_tags == mesh.faces["tire_outer"]][:, 8]]
    off = (np.degrees(np.arctan2(local[:, 0], -local[:, 2])) + 15.0) % 30.0 - 15.0
    assert np.abs(off).min() > math.degrees(0.5e-3 / 0.1425)


def test_same_design_same_mesh(mesh: TaggedMesh) -> None:
    assert build_mesh(exomars_hoops(), element_size=12e-3).hash() == mesh.hash()
    outer, inner = WHEEL.spring_sets
    other = replace(WHEEL, spring_sets=(replace(outer, weld_length=outer.weld_length + 1e-6), inner))
    assert build_mesh(other, element_size=12e-3).hash() != mesh.hash()


def test_facets_look_outwards(mesh: TaggedMesh) -> None:
    assert np.array_equal(mesh.facets, boundary_facets(mesh.cells))
    outside = mesh.facets[mesh.facet_tags == mesh.faces["tire_outer"]]
    x = mesh.points[outside]
    normal = np.cross(x[:, 1] - x[:, 0], x[:, 3] - x[:, 0])
    assert np.all(np.einsum("ij,ij->i", normal[:, [0, 2]], x[:, 8][:, [0, 2]]) > 0.0)


def detach(mesh: TaggedMesh, cells: np.ndarray, shift: float = 0.0) -> TaggedMesh:
    """The mesh with its own copies of the nodes of ``cells``: joints not merged; boundary tagged anew as free."""
    nodes = np.unique(mesh.cells[cells])
    number = np.arange(len(mesh.points))
    number[nodes] = len(mesh.points) + np.arange(len(nodes))
    joined = mesh.cells.copy()
    joined[cells] = number[joined[cells]]
    points = np.vstack([mesh.points, mesh.points[nodes] + [0.0, shift, 0.0]])
    used, flat = np.unique(joined, return_inverse=True)
    facets = boundary_facets(flat.reshape(joined.shape))
    tags = np.full(len(facets), mesh.faces["free"], dtype=np.int32)
    return replace(mesh, points=points[used], cells=flat.reshape(joined.shape), facets=facets, facet_tags=tags)


def part_cells(mesh: TaggedMesh, part: str) -> np.ndarray:
    return np.asarray(mesh.cell_tags == mesh.parts[part])


def test_negative_control_springs_not_joined(mesh: TaggedMesh) -> None:
    """Weld nodes not merged: four checks see it."""
    loose = detach(mesh, part_cells(mesh, "springs_outer"))
    with pytest.raises(MeshError, match="coincident"):
        check_no_coincident_nodes(loose)
    with pytest.raises(MeshError, match="pieces"):
        check_connected(loose)
    with pytest.raises(MeshError, match=r"joint of .*springs_outer"):
        check_matches_design(loose, WHEEL)
    with pytest.raises(MeshError, match="coincident"):
        check_mesh(loose)


def test_negative_control_one_weld_not_joined(mesh: TaggedMesh) -> None:
    """One rim weld comes loose while its spring still hangs on the hub: connectivity is blind, two checks are not."""
    centres = mesh.points[mesh.cells].mean(axis=1)
    radius = np.hypot(centres[:, 0], centres[:, 2])
    upper = part_cells(mesh, "springs_outer") & (radius > 0.070) & (np.abs(centres[:, 0]) < 0.05) & (centres[:, 2] < 0)
    rim = part_cells(mesh, "tire")
    joint = np.intersect1d(mesh.cells[upper], mesh.cells[rim])
    number = np.arange(len(mesh.points))
    number[joint] = len(mesh.points) + np.arange(len(joint))
    cells = mesh.cells.copy()
    spring = part_cells(mesh, "springs_outer")
    cells[spring] = number[cells[spring]]
    facets = boundary_facets(cells)
    loose = replace(
        mesh,
        points=np.vstack([mesh.points, mesh.points[joint]]),
        cells=cells,
        facets=facets,
        facet_tags=np.full(len(facets), mesh.faces["free"], dtype=np.int32),
    )
    check_connected(loose)
    check_boundary_tagged(loose)
    with pytest.raises(MeshError, match="coincident"):
        check_no_coincident_nodes(loose)
    with pytest.raises(MeshError, match="joint of springs_outer and tire"):
        check_matches_design(loose, WHEEL)


def test_negative_control_part_moved_away(mesh: TaggedMesh) -> None:
    """Moved by a micrometre no nodes coincide, yet the part is a piece of its own."""
    loose = detach(mesh, part_cells(mesh, "cone"), shift=1e-6)
    check_no_coincident_nodes(loose)
    with pytest.raises(MeshError, match="separate from the rest: cone"):
        check_mesh(loose)


def test_negative_control_flipped_cell(mesh: TaggedMesh) -> None:
    cells = mesh.cells.copy()
    cells[7, :8] = cells[7, [4, 5, 6, 7, 0, 1, 2, 3]]
    with pytest.raises(MeshError, match=r"inverted cells, the first is cell 7 of part tire"):
        check_not_inverted(replace(mesh, cells=cells))


def test_negative_control_middle_node_pulled_through(mesh: TaggedMesh) -> None:
    """Corners are sound and a middle node has passed the opposite face: seen inside the cell."""
    points = mesh.points.copy()
    points[mesh.cells[7, 20:26]] += 5e-3 * np.array([1.0, 0.0, 1.0])
    with pytest.raises(MeshError, match="inverted"):
        check_not_inverted(replace(mesh, points=points))


def _drop(mesh: TaggedMesh) -> TaggedMesh:
    return replace(mesh, facets=mesh.facets[1:], facet_tags=mesh.facet_tags[1:])


def _twice(mesh: TaggedMesh) -> TaggedMesh:
    tags = np.append(mesh.facet_tags, np.int32(mesh.faces["tire_outer"]))
    return replace(mesh, facets=np.vstack([mesh.facets, mesh.facets[:1]]), facet_tags=tags)


def _inner(mesh: TaggedMesh) -> TaggedMesh:
    """Tag a facet between two cells in place of one on the boundary."""
    every = mesh.cells[:, face_nodes(27)].reshape(-1, 9)
    boundary = {tuple(sorted(row)) for row in mesh.facets}
    inside = next(row for row in every if tuple(sorted(row)) not in boundary)
    facets = mesh.facets.copy()
    facets[0] = inside
    return replace(mesh, facets=facets)


def _own_middle(mesh: TaggedMesh) -> TaggedMesh:
    """Two cells share a facet's corners, but one has a centre node of its own there."""
    count = np.bincount(mesh.cells[:, 20:26].ravel(), minlength=len(mesh.points))
    cell = int(np.flatnonzero((count[mesh.cells[:, 20:26]] == 2).any(axis=1))[0])
    local = 20 + int(np.flatnonzero(count[mesh.cells[cell, 20:26]] == 2)[0])
    cells = mesh.cells.copy()
    cells[cell, local] = len(mesh.points)
    return replace(mesh, cells=cells, points=np.vstack([mesh.points, mesh.points[mesh.cells[cell, local]] + 1e-6]))


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (_drop, "1 boundary facets are untagged"),
        (_twice, "1 are tagged twice"),
        (_inner, "1 tagged facets are not on the boundary"),
        (_own_middle, "share corners but not their middle nodes"),
    ],
    ids=["untagged", "tagged twice", "inner facet", "middle node"],
)
def test_negative_control_boundary(mesh: TaggedMesh, damage: Callable[[TaggedMesh], TaggedMesh], says: str) -> None:
    check_boundary_tagged(mesh)
    with pytest.raises(MeshError, match=says):
        check_mesh(damage(mesh))
