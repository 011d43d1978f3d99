"""Relief of Poisson locking: consistent derivatives, no change where there is nothing to relieve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.plate_model import PlateModel, PoissonLocking, build_plate_model
from ancf_reduced.tire_mesh import build_tire
from ancf_reduced.tire_preset import thesis_preset

SCALE = np.array([0.005, 0.1, 0.1, 0.1])[:, None]


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
    p = model.mesh.reference_coordinates()
    return p + np.random.default_rng(5).normal(size=p.shape) * SCALE


def test_force_is_the_derivative_of_the_energy(model: PlateModel, deformed: np.ndarray) -> None:
    force, h = model.elastic_force(deformed), 1e-5
    direction = np.random.default_rng(6).normal(size=deformed.shape) * np.array([0.1, 1, 1, 1])[:, None]
    for i in range(3):
        step = np.zeros_like(deformed)
        step[..., i] = h * direction[..., i]
        difference = (model.elastic_energy(deformed + step) - model.elastic_energy(deformed - step)) / 2
        assert difference == pytest.approx(float((force * step).sum()), rel=1e-7)


def test_tangent_is_the_derivative_of_the_force(model: PlateModel, deformed: np.ndarray) -> None:
    tangent = model.elastic_tangent(deformed)
    np.testing.assert_allclose(tangent, tangent.T, rtol=0, atol=1e-9 * np.abs(tangent).max())
    rng = np.random.default_rng(7)
    for _ in range(3):
        step = 1e-6 * rng.normal(size=deformed.shape)
        difference = (model.elastic_force(deformed + step) - model.elastic_force(deformed - step)) / 2
        expected = (tangent @ step.ravel()).reshape(step.shape)
        np.testing.assert_allclose(difference, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


def test_tangent_without_the_relief_fails_the_same_check(model: PlateModel, deformed: np.ndarray) -> None:
    """Negative control: the tangent of the element as it is, against the relieved force."""
    tangent = replace(model, carry=None).elastic_tangent(deformed)
    step = 1e-6 * np.random.default_rng(7).normal(size=deformed.shape)
    difference = (model.elastic_force(deformed + step) - model.elastic_force(deformed - step)) / 2
    expected = (tangent @ step.ravel()).reshape(step.shape)
    assert np.abs(difference - expected).max() > 1e-5 * np.abs(expected).max()  # a hundred times the tolerance


def test_uniform_strain_is_left_alone(model: PlateModel) -> None:
    """The strain of the mid-surface, carried to a point of a curved plate, is the whole uniform strain."""
    F = np.array([[1.1, 0.2, 0.0], [0.0, 0.9, 0.1], [0.05, 0.0, 1.2]])
    p = model.mesh.reference_coordinates() @ F.T
    np.testing.assert_allclose(model.elastic_force(p), replace(model, carry=None).elastic_force(p), rtol=0.0, atol=1e-9)


def test_energy_is_objective(model: PlateModel, deformed: np.ndarray) -> None:
    R = Rotation.from_rotvec([0.7, -1.9, 0.4]).as_matrix()
    assert model.elastic_energy(deformed @ R.T) == pytest.approx(model.elastic_energy(deformed), rel=1e-12)
