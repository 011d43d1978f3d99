"""The outside of hexahedra, and rays that meet it."""

from __future__ import annotations

import numpy as np
import pytest

from geometry.hexahedra import VTK_FROM_GMSH, reference_nodes
from tests.small_report_folder import ring_mesh
from workbench.viewer.wheel_surface import Probe, WheelField, WheelSurface, wheel_surface


def _ring() -> WheelSurface:
    mesh = ring_mesh()
    return wheel_surface(mesh.points, mesh.cells, mesh.cell_tags.astype(np.int64))


def test_half_a_ring_becomes_a_whole_one_without_its_cut() -> None:
    surface = _ring()
    assert len(surface.quads) == 2 * 48 * 4  # inside, outside, and two radial strips of one face
    assert surface.places[:, 1].min() == pytest.approx(-0.05)
    middles = surface.places[surface.quads].mean(axis=1)
    assert np.abs(middles[:, 1]).min() > 0.01  # nothing lies in the cut y = 0
    assert set(surface.parts.tolist()) == {1, 2}


def test_quadrangles_look_outwards() -> None:
    surface = _ring()
    corners = surface.places[surface.quads]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    volume = np.einsum("ij,ij->", corners.mean(axis=1), normal) / 6.0
    assert volume == pytest.approx(0.1 * 48 / 2 * np.sin(2 * np.pi / 48) * (0.14**2 - 0.1**2), rel=1e-9)


def test_a_triquadratic_cell_has_four_flat_pieces_a_face_on_its_own_nodes() -> None:
    points = reference_nodes(27)[list(VTK_FROM_GMSH)] + (0.0, 2.0, 0.0)
    surface = wheel_surface(points, np.arange(27)[None], np.array([7]))
    assert len(surface.quads) == 24
    corners = surface.places[surface.quads]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
    np.testing.assert_allclose(area, 1.0)
    assert set(surface.parts.tolist()) == {7}


def test_a_face_between_two_triquadratic_cells_is_inside() -> None:
    first = reference_nodes(27)[list(VTK_FROM_GMSH)] + np.array([0.0, 2.0, 0.0])
    both = np.concatenate([first, first + np.array([2.0, 0.0, 0.0])])
    points, cells = np.unique(both, axis=0, return_inverse=True)
    surface = wheel_surface(points, cells.reshape(2, 27), np.array([7, 8]))
    middles = surface.places[surface.quads].mean(axis=1)
    assert len(middles) == (24 - 4) * 2
    assert not np.any(np.isclose(middles[:, 0], 1.0))
    np.testing.assert_array_equal(surface.parts, np.where(middles[:, 0] < 1.0, 7, 8))


def test_a_ray_through_a_corner_does_not_slip_through() -> None:
    """Where VTK's locators report the far side of the wheel."""
    surface = _ring()
    for k in np.flatnonzero(surface.places[:, 2] < -0.13)[::7]:
        place = surface.places[k]
        outside = place * (2.0, 1.0, 2.0)
        found = surface.probe(surface.places, np.array([outside, -outside]))
        assert found is not None
        assert np.hypot(*surface.places[found.point][[0, 2]]) == pytest.approx(0.14)
        assert surface.places[found.point][2] < 0.0


def test_a_ray_meets_the_nearest_point_and_its_part() -> None:
    surface = _ring()
    ray = np.array([[0.0, 0.045, -1.0], [0.0, 0.045, 1.0]])
    found = surface.probe(surface.places, ray)
    assert found is not None
    np.testing.assert_allclose(surface.places[found.point], [0.0, 0.05, -0.14], atol=1e-9)
    assert found.part == 2
    assert surface.probe(surface.places, ray[::-1]) is not None
    assert surface.probe(surface.places, ray + np.array([1.0, 0.0, 0.0])) is None


def test_the_mirror_image_moves_the_other_way_along_the_axle() -> None:
    surface, mesh = _ring(), ring_mesh()
    field = WheelField(
        displacement=np.tile([1.0, 2.0, 3.0], (len(mesh.points), 1)), von_mises=np.zeros(len(mesh.points))
    )
    moved = surface.displacement(field)
    half = len(moved) // 2
    assert moved[0].tolist() == [1.0, 2.0, 3.0]
    assert moved[half].tolist() == [1.0, -2.0, 3.0]
    assert isinstance(surface.probe(surface.places, np.array([[0.12, -1.0, 0.0], [0.12, 1.0, 0.0]])), Probe)


def test_a_mesh_beside_the_plane_is_whole_and_one_that_ends_there_half() -> None:
    """On either side; one whose end moves across the plane only stands there."""
    cell = reference_nodes(27)[list(VTK_FROM_GMSH)]
    for shift, moved, quads in ((2.0, 0.0, 24), (1.0, 0.0, 40), (-1.0, 0.0, 40), (1.0, 1e-6, 24)):
        points = cell + np.array([0.0, shift, 0.0])
        surface = wheel_surface(points, np.arange(27)[None], np.array([7]), np.full((27, 3), moved))
        assert len(surface.quads) == quads, (shift, moved)
