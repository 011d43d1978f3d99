"""Relief of Poisson locking: consistent derivatives, no change where there is nothing to relieve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.plates.model import PlateModel, PoissonLocking, build_plate_model
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from tests.plate_derivatives import asymmetry, crumpled, force_errors, tangent_error


def _model(poisson_ratio: float, locking: PoissonLocking) -> PlateModel:
    mesh = build_tire(thesis_preset()).mesh
    return build_plate_model(
        mesh, young_modulus=2.8e5, poisson_ratio=poisson_ratio, density=1.0, poisson_locking=locking
    )


@pytest.fixture(scope="module")
def model() -> PlateModel:
    return _model(0.3, PoissonLocking.RELIEVED)


@pytest.fixture(scope="module")
def deformed(model: PlateModel) -> np.ndarray:
    return crumpled(model)


def test_force_is_the_derivative_of_the_energy(model: PlateModel, deformed: np.ndarray) -> None:
    assert force_errors(model, deformed).max() < 1e-7


def test_tangent_is_the_derivative_of_the_force(model: PlateModel, deformed: np.ndarray) -> None:
    tangent = model.elastic_tangent(deformed)
    assert asymmetry(tangent) < 1e-9
    assert tangent_error(model, deformed, tangent) < 1e-7


def test_tangent_without_the_relief_fails_the_same_check(model: PlateModel, deformed: np.ndarray) -> None:
    """Negative control: the tangent of the element as it is is a hundred times the tolerance off the relieved force."""
    assert tangent_error(model, deformed, replace(model, carry=None).elastic_tangent(deformed)) > 1e-5


def test_uniform_strain_is_left_alone(model: PlateModel) -> None:
    """The strain of the mid-surface, carried to a point of a curved plate, is the whole uniform strain."""
    F = np.array([[1.1, 0.2, 0.0], [0.0, 0.9, 0.1], [0.05, 0.0, 1.2]])
    p = model.mesh.reference_coordinates() @ F.T
    np.testing.assert_allclose(model.elastic_force(p), replace(model, carry=None).elastic_force(p), rtol=0.0, atol=1e-9)


def test_energy_is_objective(model: PlateModel, deformed: np.ndarray) -> None:
    R = Rotation.from_rotvec([0.7, -1.9, 0.4]).as_matrix()
    assert model.elastic_energy(deformed @ R.T) == pytest.approx(model.elastic_energy(deformed), rel=1e-12)
