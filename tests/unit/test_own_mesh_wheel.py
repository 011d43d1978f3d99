"""A wheel's own mesh in the wheel frame: volume, faces, names, axes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geometry.checks import check_boundary_tagged, check_mesh
from geometry.measures import mesh_volume
from geometry.own_mesh.roles import Placement, Roles
from geometry.own_mesh.wheel_checks import outer_radius
from geometry.own_mesh.wheel_mesh import wheel_of_file
from tests.ring_wheel import AROUND, MILLIMETRES, ROLES, ring_volume, ring_wheel


@pytest.mark.parametrize(("nodes", "error"), [(8, 0.05), (20, 2e-4), (27, 2e-4)])
def test_hexahedra_make_the_disc(nodes: int, error: float) -> None:
    mesh = wheel_of_file(ring_wheel(nodes), ROLES, MILLIMETRES)
    check_mesh(mesh)
    check_boundary_tagged(mesh)
    assert mesh.cells.shape == (2 * AROUND, 8 if nodes == 8 else 27)
    assert sum(mesh_volume(mesh).values()) == pytest.approx(ring_volume(), rel=error)
    assert outer_radius(mesh, ["tread"]) == pytest.approx(0.1)
    counts = {name: int(np.count_nonzero(mesh.facet_tags == tag)) for name, tag in mesh.faces.items()}
    assert counts == {"tread": AROUND, "bore": AROUND, "other_faces": 4 * AROUND}


def test_20_nodes_of_the_disc_are_completed_to_its_27() -> None:
    """Of cells between cylinders serendipity loses nothing."""
    full, made = (wheel_of_file(ring_wheel(n), ROLES, MILLIMETRES) for n in (27, 20))
    assert made.points[made.cells] == pytest.approx(full.points[full.cells], abs=1e-15)


def test_node_sets_are_the_same_faces() -> None:
    roles = Roles(parts=ROLES.parts, hub=("bore_nodes",), ground=("Tread_Nodes",))
    mesh = wheel_of_file(ring_wheel(), roles, MILLIMETRES)
    named = wheel_of_file(ring_wheel(), ROLES, MILLIMETRES)
    for ours, theirs in (("Tread_Nodes", "tread"), ("bore_nodes", "bore")):
        sets = [
            {tuple(sorted(row)) for row in one.facets[one.facet_tags == one.faces[name]].tolist()}
            for one, name in ((mesh, ours), (named, theirs))
        ]
        assert sets[0] == sets[1]


def test_a_part_may_gather_groups_and_be_held_whole() -> None:
    mesh = replace(ring_wheel(), groups={"a": np.arange(5), "b": np.arange(5, 12), "rim": np.arange(12, 24)})
    roles = Roles(parts={"core": ("a", "b"), "rim": ("rim",)}, hub=("core",), ground=("tread",))
    assert roles.held_parts == ("core",)
    assert roles.held_faces == ()
    found = wheel_of_file(mesh, roles, MILLIMETRES)
    assert {name: int(np.count_nonzero(found.cell_tags == tag)) for name, tag in found.parts.items()} == {
        "core": 12,
        "rim": 12,
    }


@pytest.mark.parametrize(("axle", "up"), [("x", "z"), ("x", "y"), ("y", "x"), ("z", "y"), ("z", "x")])
def test_axes_of_the_file_are_turned_into_the_wheel_frame(axle: str, up: str) -> None:
    """The same disc described in other axes is the same wheel, right-handed."""
    ours = wheel_of_file(ring_wheel(), ROLES, MILLIMETRES)
    placement = Placement(unit=1e-3, axle=axle, up=up, centre=(0.001, 0.002, 0.003))
    left, upward = np.eye(3)["xyz".index(axle)], np.eye(3)["xyz".index(up)]
    axes = np.stack([np.cross(left, upward), left, upward])
    assert np.linalg.det(axes) == pytest.approx(1.0)
    mesh = ring_wheel()
    moved = replace(mesh, points=mesh.points @ axes + [1.0, 2.0, 3.0])
    theirs = wheel_of_file(moved, ROLES, placement)
    assert theirs.points == pytest.approx(ours.points, abs=1e-15)
