"""Claim: the planar mesh is the section of its design: areas, joints, and spring sets that cross without touching.

Source: closed forms of the design (`geometry.closed_form`). Tolerance: 1e-5 of an area (parabolic edges on circles at
8 mm elements), 2e-4 of a joint (its chords: (h/R)^2/24 for 2.8 mm on 50 mm). Negative control: nodes at one place
merged into one would weld the crossing sets.
"""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.assembly import merge_nodes
from geometry.closed_form import closed_form_joint_areas, closed_form_volume
from geometry.planar import build_planar_mesh, planar_areas
from geometry.springs import spring_leg
from geometry.wheel import WheelDesign, exomars_hoops

WHEEL = exomars_hoops()


@functools.cache
def planar_mesh(order: int = 2) -> TaggedMesh:
    return build_planar_mesh(WHEEL, element_size=8e-3, order=order)


def nodes_of(mesh: TaggedMesh, part: str) -> set[int]:
    return set(mesh.cells[mesh.cell_tags == mesh.parts[part]].ravel().tolist())


def crossing_design() -> WheelDesign:
    """Two sets that are mirror images in a plane through the half-way points of their strips, which meet there."""
    outer, inner = (replace(springs, shape="arc") for springs in WHEEL.spring_sets)
    leg = spring_leg(outer, (WHEEL.outer_hub.outer_radius, WHEEL.tire.inner_radius), outer.phase, 1)
    x, z = leg.points[len(leg.points) // 2]
    mirrored = replace(inner, direction=-1, phase=2.0 * math.atan2(x, -z) - outer.phase)
    return replace(WHEEL, spring_sets=(outer, mirrored))


def test_area_times_width_is_the_volume() -> None:
    mesh = planar_mesh()
    exact = closed_form_volume(WHEEL, half_width=False)
    for part, area in planar_areas(mesh).items():
        assert area * mesh.widths[part] == pytest.approx(exact[part], rel=1e-5), part


def test_joints_are_as_long_as_the_welds() -> None:
    mesh = planar_mesh()
    for (a, b), area in closed_form_joint_areas(WHEEL, half_width=False).items():
        if a not in mesh.parts or b not in mesh.parts:
            continue
        width = min(mesh.widths[a], mesh.widths[b])
        edges = {p: set(map(tuple, edges_of(mesh, p).tolist())) for p in (a, b)}
        ends = mesh.points[np.array(sorted(edges[a] & edges[b]))]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1).sum()
        assert length == pytest.approx(area / width, rel=2e-4), (a, b)


def edges_of(mesh: TaggedMesh, part: str) -> np.ndarray:
    cells = mesh.cells[mesh.cell_tags == mesh.parts[part]]
    return np.sort(cells[:, [[0, 1], [1, 2], [2, 3], [3, 0]]].reshape(-1, 2), axis=1)


def test_crossing_sets_share_no_node() -> None:
    mesh = build_planar_mesh(crossing_design(), element_size=8e-3)
    assert not nodes_of(mesh, "springs_outer") & nodes_of(mesh, "springs_inner")
    assert nodes_of(mesh, "springs_outer") & nodes_of(mesh, "tire")


def test_merging_by_place_would_weld_them() -> None:
    """Negative control: the crossing strips have nodes at one place, which only their names keep apart."""
    mesh = build_planar_mesh(crossing_design(), element_size=8e-3)
    merged = replace(mesh, cells=merge_nodes(np.insert(mesh.points, 1, 0.0, axis=1))[mesh.cells])
    assert nodes_of(merged, "springs_outer") & nodes_of(merged, "springs_inner")


@pytest.mark.parametrize("order", [1, 2])
def test_faces_and_right_handed_cells(order: int) -> None:
    mesh = planar_mesh(order)
    assert (mesh.dim, mesh.order) == (2, order)
    assert set(mesh.faces) >= {"tire_outer", "tire_inner", "grouser_outer", "outer_hub_outer", "outer_hub_bore"}
    corners = mesh.points[mesh.cells[:, :4]]
    diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    assert np.all(diagonals[0][:, 0] * diagonals[1][:, 1] > diagonals[0][:, 1] * diagonals[1][:, 0])
    outer = mesh.points[mesh.facets[mesh.facet_tags == mesh.faces["tire_outer"]][:, :2]]
    np.testing.assert_allclose(np.linalg.norm(outer, axis=-1), WHEEL.tire.outer_radius, rtol=1e-9)
    along = outer[:, 1] - outer[:, 0]  # the body on the left: an edge's right-hand normal points out
    outward = np.einsum("ei,ei->e", np.stack([along[:, 1], -along[:, 0]], axis=-1), outer.mean(axis=1))
    assert np.all(outward > 0.0)


def test_bad_orders_and_parts_are_refused() -> None:
    with pytest.raises(InputError, match="order"):
        build_planar_mesh(WHEEL, element_size=8e-3, order=3)
    with pytest.raises(InputError, match="refinement"):
        build_planar_mesh(WHEEL, element_size=8e-3, refinement={"wing": 1e-3})
