"""A mesh is compared with itself, turned by one sector; its ground faces with a circle."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.repeats import least_reach, require_repeats
from geometry.own_mesh.roles import Roles
from geometry.own_mesh.wheel_mesh import wheel_of_file
from tests.ring_wheel import AROUND, MILLIMETRES, ROLES, ring_wheel

SPIRAL = Path(__file__).parents[2] / "studies" / "spiral.inp"


@pytest.fixture(scope="module")
def spiral() -> TaggedMesh:
    """Ten spokes."""
    parts = {name: (name,) for name in ("hub", "spokes", "rim")}
    return wheel_of_file(read_mesh_file(SPIRAL), Roles(parts=parts, hub=("bore",), ground=("tread",)), MILLIMETRES)


def _disc(n_nodes: int = 27) -> TaggedMesh:
    return wheel_of_file(ring_wheel(n_nodes), ROLES, MILLIMETRES)


@pytest.mark.parametrize("repeats", [1, 2, 5, 10])
def test_ten_spokes_repeat_by_every_divisor_of_ten(spiral: TaggedMesh, repeats: int) -> None:
    require_repeats(spiral, repeats)


@pytest.mark.parametrize("repeats", [3, 9, 11, 20])
def test_another_number_is_told_with_part_place_and_distance(spiral: TaggedMesh, repeats: int) -> None:
    with pytest.raises(InputError, match=r"are not what part spokes has: turned by .* mm off at \(") as told:
        require_repeats(spiral, repeats)
    assert (told.value.what, told.value.value, told.value.key) == ("equal sectors", str(repeats), "repeats")


def test_cells_of_eight_nodes_repeat_as_the_polygon_they_draw() -> None:
    require_repeats(_disc(8), AROUND)
    with pytest.raises(InputError, match="are not what part hub has"):
        require_repeats(_disc(8), 8)


@pytest.mark.parametrize("repeats", [AROUND, 7])
def test_a_body_repeats_though_its_nodes_do_not(repeats: int) -> None:
    """A seventh of a turn brings no node of twelve cells onto another."""
    require_repeats(_disc(), repeats)


def test_one_cell_of_another_material_is_told() -> None:
    mesh = _disc()
    tags = mesh.cell_tags.copy()
    tags[AROUND] = mesh.parts["hub"]
    other = replace(mesh, cell_tags=tags)
    require_repeats(other, 1)
    with pytest.raises(InputError, match="are not what part hub has"):
        require_repeats(other, AROUND)


def test_ground_on_part_of_the_rim_is_told() -> None:
    """The body repeats, what may touch the ground does not."""
    mesh = _disc()
    tags = mesh.facet_tags.copy()
    tags[np.flatnonzero(tags == mesh.faces["tread"])[:3]] = mesh.faces["other_faces"]
    with pytest.raises(InputError, match="are not what group of faces"):
        require_repeats(replace(mesh, facet_tags=tags), AROUND)


@pytest.mark.parametrize("off", [0.05e-3, 0.3e-3])
def test_a_dent_of_more_than_a_thousandth_of_the_radius_is_told(spiral: TaggedMesh, off: float) -> None:
    """The middle of one face of the tread moved inwards; 0.125 mm is let through."""
    points = spiral.points.copy()
    middle = spiral.facets[spiral.facet_tags == spiral.faces["tread"]][0, 8]
    points[middle] *= 1.0 - off / np.hypot(*points[middle, [0, 2]])
    dented = replace(spiral, points=points)
    if off < 0.125e-3:
        require_repeats(dented, 10)
        return
    with pytest.raises(InputError, match="are not what part rim has"):
        require_repeats(dented, 10)


def test_a_circle_of_arcs_reaches_its_radius_and_a_polygon_less() -> None:
    """R cos(pi/n) at the middle of a straight edge; arcs of 30 degrees, ten samples each, leave 1.2e-4 and 4e-4."""
    assert least_reach(_disc(), ["tread"]) == pytest.approx(0.1, rel=6e-4)
    assert least_reach(_disc(8), ["tread"]) == pytest.approx(0.1 * math.cos(math.pi / AROUND), rel=1e-6)
