"""Networks of plates: shared nodes, structure-frame transform, T-sections."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.shape_functions import plate_shape, plate_shape_gradient
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError, MeshError

X, Y, Z = np.eye(3)


def test_corners_that_coincide_share_a_node() -> None:
    mesh = build_plate_mesh([flat_patch(i * X, X, 2.0 * Y, 0.1, "strip") for i in range(3)])
    assert mesh.points.shape == (8, 3)
    assert mesh.elements[0, 1] == mesh.elements[1, 0]
    np.testing.assert_array_equal(mesh.plates_of("strip"), [0, 1, 2])


def test_reference_coordinates_reproduce_each_plates_gradients() -> None:
    mesh = build_tire(thesis_preset()).mesh
    e = mesh.element_coordinates(mesh.reference_coordinates()).reshape(-1, 4, 4, 3)
    np.testing.assert_allclose(e[:, :, 0], mesh.points[mesh.elements], atol=1e-15)
    np.testing.assert_allclose(np.swapaxes(e[:, :, 1:], 2, 3), mesh.gradients, atol=1e-15)


def test_t_section_is_continuous_under_random_coordinates() -> None:
    """At each rim node on a spoke, two rim plates and the spoke agree on r and on the gradients dr/dX."""
    mesh = build_tire(thesis_preset()).mesh
    p = np.random.default_rng(3).normal(size=(len(mesh.points), 4, 3))
    e = mesh.element_coordinates(p)
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    meeting = np.bincount(mesh.elements.ravel())
    assert sorted(meeting) == [1] * 8 + [3] * 8
    for j, nodes in enumerate(mesh.elements):
        r = plate_shape(corners, mesh.dimensions[j]) @ e[j]
        by_x = np.einsum("gka,ai->gik", plate_shape_gradient(corners, mesh.dimensions[j]), e[j])
        by_X = by_x @ np.linalg.inv(mesh.gradients[j])
        np.testing.assert_allclose(r, p[nodes, 0], atol=1e-13)
        np.testing.assert_allclose(by_X, np.swapaxes(p[nodes, 1:], 1, 2), atol=1e-12)


def test_t_section_edge_is_shared_by_rim_and_spoke() -> None:
    """Where a spoke meets the rim, the two mid-surfaces have one line in common at any coordinates."""
    mesh = build_tire(thesis_preset()).mesh
    p = mesh.reference_coordinates() + np.random.default_rng(4).normal(scale=0.01, size=(len(mesh.points), 4, 3))
    e, eta = mesh.element_coordinates(p), np.linspace(0.0, 1.0, 7)
    rim = plate_shape(np.column_stack([0 * eta, eta, 0 * eta]), mesh.dimensions[0]) @ e[0]
    spoke = plate_shape(np.column_stack([0 * eta + 1, eta, 0 * eta]), mesh.dimensions[4]) @ e[4]
    np.testing.assert_allclose(rim, spoke, atol=1e-14)
    assert np.abs(rim - rim[0]).max() > 0.1


def test_bad_patches_are_refused() -> None:
    good = flat_patch(0 * X, X, Y, 0.1, "plate")
    with pytest.raises(InputError, match="shapes"):
        replace(good, corners=np.zeros((3, 3)))
    with pytest.raises(InputError, match="finite"):
        replace(good, corners=good.corners * np.nan)
    with pytest.raises(InputError, match="greater than zero"):
        replace(good, dimensions=np.array([1.0, 1.0, 0.0]))
    with pytest.raises(InputError, match="det J0"):
        replace(good, gradients=-good.gradients)
    with pytest.raises(InputError, match="right angles"):
        flat_patch(0 * X, X, X + Y, 0.1, "plate")


def test_bad_meshes_are_refused() -> None:
    with pytest.raises(MeshError, match="one patch or more"):
        build_plate_mesh([])
    with pytest.raises(MeshError, match="closer than"):
        build_plate_mesh([flat_patch(0 * X, X, Y, 0.1, "plate")], tolerance=1.1)
    with pytest.raises(InputError, match="not in the mesh"):
        build_plate_mesh([flat_patch(0 * X, X, Y, 0.1, "plate")]).plates_of("spoke")
