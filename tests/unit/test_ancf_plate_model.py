"""Elastic energy, force and tangent of plates on a curved mesh with T-sections."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.motion.reference_node import rigid_reference_node, tie_reference_node
from ancf_reduced.plates.mesh import PlateMesh, build_plate_mesh, flat_patch
from ancf_reduced.plates.model import PlateModel, build_plate_model
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError, MeshError
from tests.plate_derivatives import asymmetry, crumpled, force_errors, tangent_error


@pytest.fixture(scope="module")
def model() -> PlateModel:
    """The thesis tire with nu = 0.3, so that both Lame terms count."""
    return build_tire(replace(thesis_preset(), poisson_ratio=0.3)).model


@pytest.fixture(scope="module")
def deformed(model: PlateModel) -> np.ndarray:
    return crumpled(model)


def test_force_is_the_derivative_of_the_energy(model: PlateModel, deformed: np.ndarray) -> None:
    assert force_errors(model, deformed).max() < 1e-7


def test_tangent_is_the_derivative_of_the_force(model: PlateModel, deformed: np.ndarray) -> None:
    tangent = model.elastic_tangent(deformed)
    assert asymmetry(tangent) < 1e-9
    assert tangent_error(model, deformed, tangent) < 1e-7


def test_damaged_tangent_fails_the_same_check(model: PlateModel, deformed: np.ndarray) -> None:
    """Negative control: without the geometric stiffness (tangent at the reference) the check must fail."""
    assert tangent_error(model, deformed, model.elastic_tangent(model.mesh.reference_coordinates())) > 1e-2


def test_rigid_motion_gives_no_force(model: PlateModel) -> None:
    mesh = model.mesh
    tie = tie_reference_node(mesh, np.arange(len(mesh.points)), np.zeros(3))
    R = Rotation.from_rotvec([0.7, -1.9, 0.4]).as_matrix()
    moved = tie.expand(np.empty((0, 4, 3)), rigid_reference_node(np.array([1.0, -2.0, 3.0]), R))
    stiffness = np.abs(model.elastic_tangent(moved)).max()
    assert np.abs(model.elastic_force(moved)).max() < 1e-12 * stiffness
    stretched = tie.expand(np.empty((0, 4, 3)), rigid_reference_node(np.zeros(3), 1.001 * R))
    assert np.abs(model.elastic_force(stretched)).max() > 1e-6 * stiffness


def test_uniform_strain_has_the_exact_energy() -> None:
    mesh = _plate()
    model = build_plate_model(mesh, young_modulus=2.0e5, poisson_ratio=0.25, density=1.0)
    F = np.array([[1.1, 0.2, 0.0], [0.0, 0.9, 0.1], [0.05, 0.0, 1.2]])
    E = 0.5 * (F.T @ F - np.eye(3))
    lam, mu = 0.8e5, 0.8e5
    volume = 0.3 * 0.2 * 0.05
    expected = volume * (0.5 * lam * np.trace(E) ** 2 + mu * np.sum(E * E))
    tie = tie_reference_node(mesh, np.arange(4), np.zeros(3))
    p = tie.expand(np.empty((0, 4, 3)), rigid_reference_node(np.zeros(3), F))
    assert model.elastic_energy(p) == pytest.approx(expected, rel=1e-12)
    np.testing.assert_allclose(model.volume_ratio(p), np.linalg.det(F), rtol=1e-12)


def test_bad_material_and_inverted_geometry_are_refused() -> None:
    mesh = _plate()
    with pytest.raises(InputError, match="young modulus"):
        build_plate_model(mesh, young_modulus=-1.0, poisson_ratio=0.0, density=1.0)
    with pytest.raises(InputError, match="poisson ratio"):
        build_plate_model(mesh, young_modulus=1.0, poisson_ratio=0.5, density=1.0)
    with pytest.raises(InputError, match="quadrature"):
        build_plate_model(mesh, young_modulus=1.0, poisson_ratio=0.0, density=1.0, quadrature=(0, 5, 3))
    preset = replace(thesis_preset(), circumferential_plates=8, rim_thickness=0.08, hub_radius=0.01)
    folded = build_tire(preset).mesh
    twisted = replace(folded, dimensions=folded.dimensions * np.array([1.0, 1.0, 8.0]))
    with pytest.raises(MeshError, match="det J0"):
        build_plate_model(twisted, young_modulus=1.0, poisson_ratio=0.0, density=1.0)


def _plate() -> PlateMesh:
    """One flat plate 0.3 x 0.2 x 0.05 m, askew in space."""
    R = Rotation.from_rotvec([0.3, 0.2, 0.1]).as_matrix()
    return build_plate_mesh([flat_patch(np.ones(3), 0.3 * R[:, 0], 0.2 * R[:, 1], 0.05, "plate")])
