"""The outside of hexahedra, and rays that meet it."""

from __future__ import annotations

import numpy as np
import pytest

from geometry.hexahedra import VTK_FROM_GMSH, reference_nodes
from tests.small_report_folder import ring_mesh
from workbench.viewer.wheel_body import STEPS, Cut, WheelBody, wheel_body
from workbench.viewer.wheel_surface import Probe, WheelField, WheelSurface


def _body() -> WheelBody:
    mesh = ring_mesh()
    return wheel_body(mesh.points, mesh.cells, mesh.cell_tags.astype(np.int64))


def _ring(cut: Cut | None = None) -> WheelSurface:
    return _body().surface(cut)


def _volume(surface: WheelSurface) -> float:
    """Enclosed by quadrangles that look outwards [m^3]; right only if they close."""
    corners = surface.places[surface.quads]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    return float(np.einsum("ij,ij->", corners.mean(axis=1), normal) / 6.0)


def _closed(surface: WheelSurface) -> bool:
    """Whether each edge is passed as often in one sense as in the other."""
    edges = np.stack([surface.quads, np.roll(surface.quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    there, count = np.unique(edges, axis=0, return_counts=True)
    back = dict(zip(map(tuple, there[:, ::-1].tolist()), count.tolist(), strict=True))
    return all(back.get(tuple(edge)) == n for edge, n in zip(there.tolist(), count.tolist(), strict=True))


def test_half_a_ring_becomes_a_whole_one_without_its_cut() -> None:
    surface = _ring()
    assert len(surface.quads) == 2 * 48 * 4  # inside, outside, and two radial strips of one face
    assert surface.places[:, 1].min() == pytest.approx(-0.05)
    middles = surface.places[surface.quads].mean(axis=1)
    assert np.abs(middles[:, 1]).min() > 0.01  # nothing lies in the cut y = 0
    assert set(surface.parts.tolist()) == {1, 2}


def test_quadrangles_look_outwards() -> None:
    assert _volume(_ring()) == pytest.approx(0.1 * 48 / 2 * np.sin(2 * np.pi / 48) * (0.14**2 - 0.1**2), rel=1e-9)


def test_a_triquadratic_cell_has_four_flat_pieces_a_face_on_its_own_nodes() -> None:
    points = reference_nodes(27)[list(VTK_FROM_GMSH)] + (0.0, 2.0, 0.0)
    surface = wheel_body(points, np.arange(27)[None], np.array([7])).surface()
    assert len(surface.quads) == 24
    corners = surface.places[surface.quads]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
    np.testing.assert_allclose(area, 1.0)
    assert set(surface.parts.tolist()) == {7}


def test_a_face_between_two_triquadratic_cells_is_inside() -> None:
    first = reference_nodes(27)[list(VTK_FROM_GMSH)] + np.array([0.0, 2.0, 0.0])
    both = np.concatenate([first, first + np.array([2.0, 0.0, 0.0])])
    points, cells = np.unique(both, axis=0, return_inverse=True)
    surface = wheel_body(points, cells.reshape(2, 27), np.array([7, 8])).surface()
    middles = surface.places[surface.quads].mean(axis=1)
    assert len(middles) == (24 - 4) * 2
    assert not np.any(np.isclose(middles[:, 0], 1.0))
    np.testing.assert_array_equal(surface.parts, np.where(middles[:, 0] < 1.0, 7, 8))


def test_a_ray_through_a_corner_does_not_slip_through() -> None:
    """Where VTK's locators report the far side of the wheel."""
    surface = _ring()
    for k in np.flatnonzero(surface.places[:, 2] < -0.13)[::7]:
        outside = surface.places[k] * (2.0, 1.0, 2.0)
        place = _met(surface, np.array([outside, -outside]))
        assert np.hypot(*place[[0, 2]]) == pytest.approx(0.14)
        assert place[2] < 0.0


def _met(surface: WheelSurface, ray: np.ndarray) -> np.ndarray:
    """Place of the point that a ray finds."""
    found = surface.probe(surface.places, ray)
    assert found is not None
    index = surface.index(found.point)
    assert index is not None
    return surface.places[index]


def test_a_ray_meets_the_nearest_point_and_its_part() -> None:
    surface = _ring()
    ray = np.array([[0.0, 0.045, -1.0], [0.0, 0.045, 1.0]])
    found = surface.probe(surface.places, ray)
    assert found is not None
    np.testing.assert_allclose(_met(surface, ray), [0.0, 0.05, -0.14], atol=1e-9)
    assert found.part == 2
    assert surface.probe(surface.places, ray[::-1]) is not None
    assert surface.probe(surface.places, ray + np.array([1.0, 0.0, 0.0])) is None


def test_the_mirror_image_moves_the_other_way_along_the_axle() -> None:
    surface, mesh = _ring(), ring_mesh()
    field = WheelField(
        displacement=np.tile([1.0, 2.0, 3.0], (len(mesh.points), 1)), von_mises=np.zeros(len(mesh.points))
    )
    moved = surface.displacement(field)
    sides = {float(y): moved[np.isclose(surface.places[:, 1], y)] for y in (0.05, -0.05)}
    np.testing.assert_array_equal(sides[0.05], np.tile([1.0, 2.0, 3.0], (48 * 3, 1)))
    np.testing.assert_array_equal(sides[-0.05], np.tile([1.0, -2.0, 3.0], (48 * 3, 1)))
    assert isinstance(surface.probe(surface.places, np.array([[0.12, -1.0, 0.0], [0.12, 1.0, 0.0]])), Probe)


def test_a_mesh_beside_the_plane_is_whole_and_one_that_ends_there_half() -> None:
    """On either side; one whose end moves across the plane only stands there."""
    cell = reference_nodes(27)[list(VTK_FROM_GMSH)]
    for shift, moved, quads in ((2.0, 0.0, 24), (1.0, 0.0, 40), (-1.0, 0.0, 40), (1.0, 1e-6, 24)):
        points = cell + np.array([0.0, shift, 0.0])
        surface = wheel_body(points, np.arange(27)[None], np.array([7]), np.full((27, 3), moved)).surface()
        assert len(surface.quads) == quads, (shift, moved)


def test_hidden_parts_are_neither_drawn_nor_met() -> None:
    ray = np.array([[0.0, 0.045, -1.0], [0.0, 0.045, 1.0]])
    outer, inner = _ring(Cut(hidden=frozenset({1}))), _ring(Cut(hidden=frozenset({2})))
    assert set(outer.parts.tolist()) == {2}
    assert _closed(outer)
    assert _closed(inner)
    assert _volume(outer) + _volume(inner) == pytest.approx(_volume(_ring()), rel=1e-12)
    np.testing.assert_allclose(_met(inner, ray), [0.0, 0.05, -0.12], atol=1e-9)
    nothing = _ring(Cut(hidden=frozenset({1, 2})))
    assert len(nothing.quads) == len(nothing.places) == 0
    assert nothing.probe(nothing.places, ray) is None
    assert nothing.index(0) is None


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_cut_in_the_middle_leaves_a_closed_half_that_faces_the_eye(axis: str) -> None:
    near, far = _ring(Cut(axis=axis, other_side=True)), _ring(Cut(axis=axis))
    whole, k = _volume(_ring()), "xyz".index(axis)
    for half in (near, far):
        assert _closed(half)
        assert _volume(half) == pytest.approx(0.5 * whole, rel=0.02)  # cells stay whole
    sign = -1.0 if axis == "y" else 1.0  # the eye is at +x, -y, +z
    assert sign * far.places[:, k].mean() < 0.0 < sign * near.places[:, k].mean()


def test_a_cut_shows_the_inside_to_eye_and_probe() -> None:
    """Through the middle plane, on which no face of the whole wheel lies."""
    half, ray = _ring(Cut(axis="y")), np.array([[0.115, -1.0, 0.0], [0.115, 1.0, 0.0]])
    inside = np.isclose(half.places[half.quads][:, :, 1], 0.0).all(axis=1)
    assert inside.sum() == 48 * 2
    np.testing.assert_allclose(_met(half, ray), [0.12, 0.0, 0.0], atol=1e-9)
    assert half.places[:, 1].min() == 0.0


def test_a_cut_goes_from_one_end_to_the_other_in_steps() -> None:
    body = _body()
    assert [body.place(Cut(axis="y", step=k)) for k in (0, STEPS // 2, STEPS)] == pytest.approx([-0.05, 0.0, 0.05])
    kept = [int(body.kept(Cut(axis="x", step=k)).sum()) for k in range(STEPS + 1)]
    assert kept == sorted(kept)
    assert (kept[0], kept[-1]) == (0, 2 * len(ring_mesh().cells))
