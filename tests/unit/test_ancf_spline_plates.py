"""B-spline surfaces to plates and back: one face or two, flat or curved, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.spline_plates import FACES, plate_surfaces, plates_between, plates_on_surface
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import refined_preset, thesis_preset
from contracts.errors import InputError
from geometry.spline_surface import SplineSurface, bezier_surface

RNG = np.random.default_rng(7)
LINEAR = np.array([0.0, 0.0, 1.0, 1.0])


def _flat(size: tuple[float, float], knots_u: np.ndarray = LINEAR, height: float = 0.0) -> SplineSurface:
    """A rectangle of degree 1 in x and y, so many spans along x as the knots have."""
    x = np.interp(knots_u[1:-1], [knots_u[0], knots_u[-1]], [0.0, size[0]])
    y = np.array([0.0, size[1]])
    points = np.stack([*np.meshgrid(x, y, indexing="ij"), np.full((len(x), 2), height)], axis=-1)
    return SplineSurface(name="flat", control_points=points, degrees=(1, 1), knots=(knots_u, LINEAR))


def test_a_rectangle_is_a_flat_patch() -> None:
    (found,) = plates_on_surface(_flat((0.3, 0.2)), 0.01, part="plate").patches
    wanted = flat_patch(np.zeros(3), np.array([0.3, 0.0, 0.0]), np.array([0.0, 0.2, 0.0]), 0.01, "plate")
    for name in ("corners", "gradients", "dimensions"):
        np.testing.assert_allclose(getattr(found, name), getattr(wanted, name), atol=1e-14)


def test_spans_and_subdivisions_make_plates_with_shared_nodes() -> None:
    surface = _flat((0.3, 0.2), np.array([0.0, 0.0, 0.25, 1.0, 1.0]))
    mesh = build_plate_mesh(plates_on_surface(surface, 0.01, part="plate", subdivisions=(2, 3)).patches)
    assert (len(mesh.elements), len(mesh.points)) == (12, 20)
    assert np.unique(mesh.points[:, 0].round(12)).tolist() == [0.0, 0.0375, 0.075, 0.1875, 0.3]


def test_a_deformed_tire_goes_through_its_faces_and_back() -> None:
    """Faces of a tire, every node's 12 coordinates disturbed, give its plates again to 1e-12."""
    mesh = build_tire(refined_preset(thesis_preset(), 8)).mesh
    p = mesh.reference_coordinates() + 0.05 * RNG.normal(size=(len(mesh.points), 4, 3)) * [[0.1], [1], [1], [1]]
    surfaces = {surface.name: surface for surface in plate_surfaces(mesh, p)}
    assert len(surfaces) == 3 * len(mesh.elements)
    e = mesh.normalised(p, mesh.gradients * mesh.dimensions[:, None, None, :])
    for j, part in enumerate(mesh.parts):
        lower, upper = (surfaces[f"{part} {j} {face}"] for face in FACES if face != "middle")
        found = plates_between(lower, upper, part=part)
        (patch,) = found.patches
        nodes = e[j].reshape(4, 4, 3)
        np.testing.assert_allclose(patch.corners, nodes[:, 0], atol=1e-12)
        frames = np.swapaxes(patch.gradients * patch.dimensions, 1, 2)
        np.testing.assert_allclose(frames, nodes[:, 1:], atol=1e-12)
        assert found.residual.max() < 1e-14


def test_faces_may_have_knots_of_their_own() -> None:
    lower, upper = _flat((0.3, 0.2)), _flat((0.3, 0.2), np.array([0.0, 0.0, 0.5, 1.0, 1.0]), height=0.02)
    patches = plates_between(lower, upper, part="plate").patches
    assert len(patches) == 2
    np.testing.assert_allclose([patch.dimensions for patch in patches], [[0.15, 0.2, 0.02]] * 2)
    np.testing.assert_allclose(patches[1].corners[0], [0.15, 0.0, 0.01])


def test_a_thickness_that_bulges_between_the_corners_is_reported() -> None:
    """Faces bent apart by control points 1 mm off: the directors are bilinear, and the residual says so."""
    lower = bezier_surface("lower", _flat((0.3, 0.2)).bezier_pieces()[0, 0])
    points = _flat((0.3, 0.2), height=0.02).bezier_pieces()[0, 0]
    points[1:3, :, 2] += 1e-3
    with pytest.raises(InputError, match=r"residual = 0\.0005 m"):
        plates_between(lower, bezier_surface("upper", points), part="plate")
    accepted = plates_between(lower, bezier_surface("upper", points), part="plate", tolerance=1e-3)
    assert accepted.residual[0] == pytest.approx(5e-4)


def test_what_cannot_become_plates_is_refused() -> None:
    flat = _flat((0.3, 0.2))
    with pytest.raises(InputError, match="thickness"):
        plates_on_surface(flat, 0.0, part="plate")
    with pytest.raises(InputError, match="subdivisions"):
        plates_on_surface(flat, 0.01, part="plate", subdivisions=(0, 1))
    with pytest.raises(InputError, match="normal"):
        plates_on_surface(_flat((0.3, 0.0)), 0.01, part="plate")
    with pytest.raises(InputError, match="breaks"):
        plates_between(flat, _flat((0.3, 0.2), 2.0 * LINEAR, height=0.02), part="plate")
    with pytest.raises(InputError, match="det J0"):
        plates_between(_flat((0.3, 0.2), height=0.02), flat, part="plate")
