"""Navier-Stokes damping of plates: objective, dissipative, with exact derivatives by coordinates and by rates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.plates.assembly import dense_matrix
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.model import PlateModel, PoissonLocking, build_plate_model
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError

VISCOSITY = (300.0, 500.0)
SCALE = np.array([0.005, 0.1, 0.1, 0.1])[:, None]


@pytest.fixture(scope="module")
def model() -> PlateModel:
    """The thesis tire, curved and with T-sections."""
    return replace(build_tire(thesis_preset()).model, viscosity=VISCOSITY)


@pytest.fixture(scope="module")
def state(model: PlateModel) -> tuple[np.ndarray, np.ndarray]:
    rng, p = np.random.default_rng(5), model.mesh.reference_coordinates()
    return p + rng.normal(size=p.shape) * SCALE, rng.normal(size=p.shape) * 10.0 * SCALE


def test_no_force_in_rigid_motion(model: PlateModel) -> None:
    """Translation and spin of the turned, deformed mesh; with coefficients of 1e9 Pa s the force is only round-off."""
    strong = replace(model, viscosity=(1e9, 1e9))
    p, omega = model.mesh.reference_coordinates(), np.array([0.3, -2.0, 1.1])
    p = p @ Rotation.from_rotvec([0.7, -1.9, 0.4]).as_matrix().T
    rates = np.cross(omega, p)
    rates[:, 0] += [1.0, -2.0, 3.0]
    stretching = 1e-3 * p
    scale = np.abs(strong.damping_force(p, stretching)).max()
    assert scale > 1.0
    assert np.abs(strong.damping_force(p, rates)).max() < 1e-9 * scale


def test_uniform_flow_has_the_exact_force_and_power() -> None:
    """A flat plate in the flow v = L x: dissipated power V (lambda_v tr(D)^2 + 2 mu_v D:D)."""
    mesh = build_plate_mesh([flat_patch(np.zeros(3), np.array([0.3, 0, 0]), np.array([0, 0.2, 0]), 0.05, "plate")])
    model = build_plate_model(mesh, young_modulus=1.0, poisson_ratio=0.0, density=1.0, viscosity=VISCOSITY)
    F = np.array([[1.1, 0.2, 0.0], [0.0, 0.9, 0.1], [0.05, 0.0, 1.2]])
    L = np.array([[0.4, -1.0, 0.3], [0.2, 0.1, 0.0], [0.7, 0.5, -0.6]])
    p = mesh.reference_coordinates() @ F.T
    rates, D = p @ L.T, 0.5 * (L + L.T)
    power = 0.003 * np.linalg.det(F) * (VISCOSITY[0] * np.trace(D) ** 2 + 2.0 * VISCOSITY[1] * np.sum(D * D))
    assert float((model.damping_force(p, rates) * rates).sum()) == pytest.approx(power, rel=1e-12)


def test_power_is_never_negative(model: PlateModel, state: tuple[np.ndarray, np.ndarray]) -> None:
    p, _ = state
    rng = np.random.default_rng(8)
    for _ in range(10):
        rates = rng.normal(size=p.shape)
        assert float((model.damping_force(p, rates) * rates).sum()) > 0.0


def test_tangents_are_the_derivatives(model: PlateModel, state: tuple[np.ndarray, np.ndarray]) -> None:
    p, rates = state
    by_position, by_rate = (dense_matrix(model.mesh, blocks) for blocks in model.damping_tangents(p, rates))
    np.testing.assert_allclose(by_rate, by_rate.T, rtol=0.0, atol=1e-12 * np.abs(by_rate).max())
    assert np.abs(by_position - by_position.T).max() > 1e-3 * np.abs(by_position).max()
    rng = np.random.default_rng(9)
    for _ in range(3):
        step = 1e-6 * rng.normal(size=p.shape)
        difference = (model.damping_force(p + step, rates) - model.damping_force(p - step, rates)) / 2.0
        expected = (by_position @ step.ravel()).reshape(step.shape)
        np.testing.assert_allclose(difference, expected, rtol=0.0, atol=1e-7 * np.abs(expected).max())
        linear = (by_rate @ step.ravel()).reshape(step.shape)
        difference = model.damping_force(p, rates + step) - model.damping_force(p, rates)
        np.testing.assert_allclose(difference, linear, rtol=0.0, atol=1e-8 * np.abs(linear).max())


def test_a_rate_of_strain_taken_for_the_rate_of_deformation_is_caught(model: PlateModel) -> None:
    """Negative control of objectivity: the rate of the position gradients alone, without L's symmetric part."""
    p = model.mesh.reference_coordinates()
    spin = np.cross(np.array([0.0, 3.0, 0.0]), p)
    spin[:, 1:] = 0.0  # nodes turn about the axle, their gradients do not: no rigid motion any more
    assert np.abs(model.damping_force(p, spin)).max() > 1.0


def test_negative_viscosity_is_refused(model: PlateModel) -> None:
    with pytest.raises(InputError, match="viscosity mu_v"):
        build_plate_model(model.mesh, young_modulus=1.0, poisson_ratio=0.0, density=1.0, viscosity=(0.0, -1.0))


@pytest.mark.parametrize("locking", PoissonLocking)
def test_a_steps_matrix_is_the_weighted_sum(locking: PoissonLocking, state: tuple[np.ndarray, np.ndarray]) -> None:
    """One pass over the points and two; with relief of Poisson locking too."""
    mesh = build_tire(thesis_preset()).mesh
    elastic = {"young_modulus": 3e5, "poisson_ratio": 0.3, "density": 1.0}
    model = build_plate_model(mesh, **elastic, viscosity=VISCOSITY, poisson_locking=locking)
    K, C = model.elastic_tangents(state[0]), model.damping_matrices(state[0])
    found = model.step_matrices(state[0], (0.2, 7.0))
    assert np.abs(found - (0.2 * K + 7.0 * C)).max() < 1e-12 * np.abs(found).max()
    assert min(np.abs(0.2 * K).max(), np.abs(7.0 * C).max()) > 1e-3 * np.abs(found).max()
