"""The skin of a tire: on its surfaces, closed, with the strain of the deformation put on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.skin import tire_skin
from ancf_reduced.tire.surfaces import tire_surfaces

TIRE = build_tire(replace(thesis_preset(), quadrature=(3, 3, 2)))
SKIN = tire_skin(TIRE, 7, 3)
REST = SKIN.coordinates.restrict(TIRE.mesh.reference_coordinates())


def stretched(A: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors of the tire under the linear map r = A X."""
    return REST @ A.T


def test_a_tire_at_rest_or_turned_is_not_strained() -> None:
    c, s = np.cos(0.7), np.sin(0.7)
    turned = stretched(np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]))
    assert SKIN.largest_strain(REST).max() < 1e-12
    assert SKIN.largest_strain(turned).max() < 1e-12


def test_a_linear_map_has_its_strain_everywhere() -> None:
    A = np.array([[1.1, 0.05, 0.0], [0.0, 0.97, 0.02], [0.0, 0.0, 0.9]])
    E = 0.5 * (A.T @ A - np.eye(3))
    np.testing.assert_allclose(SKIN.strains(stretched(A)), np.broadcast_to(E, SKIN.strains(REST).shape), atol=1e-12)
    assert SKIN.largest_strain(stretched(A)) == pytest.approx(np.abs(np.linalg.eigvalsh(E)).max())
    np.testing.assert_allclose(SKIN.points(stretched(A)), SKIN.points(REST) @ A.T, atol=1e-12)


def test_the_outer_face_is_that_of_the_tires_surfaces() -> None:
    points = SKIN.points(REST)
    face = tire_surfaces(TIRE, TIRE.mesh.reference_coordinates(), 7).outer_face[:, :, ::3].reshape(-1, 3)
    distance = np.linalg.norm(points[:, None] - face, axis=-1).min(axis=0)
    assert distance.max() < 1e-12


def test_quads_look_outwards() -> None:
    """The volume that the skin of one plate encloses with flat ends is positive and that of the plate."""
    points, quads = SKIN.points(REST), SKIN.quads
    per_plate = len(quads) // len(TIRE.mesh.elements)
    a, b, t = TIRE.mesh.dimensions[TIRE.mesh.parts.index("spoke")]
    spoke = quads[TIRE.mesh.parts.index("spoke") * per_plate :][:per_plate]
    corners = points[spoke] - points[spoke].mean(axis=(0, 1))
    outward = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    area = np.linalg.norm(outward, axis=1).sum() / 2.0
    assert np.all(np.einsum("qi,qi->q", outward, corners.mean(axis=1)) > 0.0)
    assert area == pytest.approx(2.0 * a * (b + t), rel=1e-9)
