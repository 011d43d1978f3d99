"""One ANCF plate against exact reference matrices.

Claim: mass, gravity and elastic force of thesis eq. 2.13 equal the reference within 1e-10 relative to the largest
entry. Source: contracts/published/ancf_plate_*.csv (exact quadrature; agrees with Project Chrono's published 3443
element to 1e-11). Tolerance: the references carry 12 or more digits, and 8 x 8 x 4 Gauss points are exact for this
polynomial; 1e-10 is the room left for round-off. Negative control: one flipped sign in one shape function of eq. 2.13.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from ancf_reduced.plate_mass import gravity_force, mass_matrix
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import PlateModel, build_plate_model
from ancf_reduced.shape_functions import THESIS_SHAPE, PlateShape, plate_shape, plate_shape_gradient
from contracts.errors import MeshError
from contracts.published import published_matrix

TOLERANCE = 1e-10
X, Y, Z = np.eye(3)


def _model(shape: PlateShape = THESIS_SHAPE, quadrature: tuple[int, int, int] = (8, 8, 4)) -> PlateModel:
    mesh = build_plate_mesh([flat_patch(0 * X, X, Y, 0.01, "plate")])
    return build_plate_model(
        mesh, young_modulus=210e9, poisson_ratio=0.3, density=7850.0, quadrature=quadrature, shape=shape
    )


def _mass(model: PlateModel) -> np.ndarray:
    return mass_matrix(model)


def _gravity(model: PlateModel) -> np.ndarray:
    return gravity_force(model, np.array([0.0, 0.0, -9.80665])).reshape(16, 3)


def _elastic(model: PlateModel) -> np.ndarray:
    p = model.mesh.reference_coordinates()
    p[1, 0, 2] += 1e-3  # node 2
    return model.elastic_force(p).reshape(16, 3)


CASES = [("mass", _mass), ("gravity", _gravity), ("elastic_force", _elastic)]


def _error(name: str, value: np.ndarray) -> float:
    reference = published_matrix(f"ancf_plate_{name}")
    return float(np.abs(value - reference).max() / np.abs(reference).max())


@pytest.mark.parametrize(("name", "compute"), CASES)
def test_plate_matches_the_reference(name: str, compute: Callable[[PlateModel], np.ndarray]) -> None:
    assert _error(name, compute(_model())) < TOLERANCE


def _misread() -> PlateShape:
    """Thesis eq. 2.13 with one sign of s_1 turned: 2 eta^2 + eta + ... instead of 2 eta^2 - eta + ..."""

    def value(xi: np.ndarray, dimensions: np.ndarray) -> np.ndarray:
        s, (u, v, _) = plate_shape(xi, dimensions), xi.T
        s[:, 0] -= 2.0 * v * (u - 1.0) * (v - 1.0)
        return s

    def gradient(xi: np.ndarray, dimensions: np.ndarray) -> np.ndarray:
        ds, (u, v, _) = plate_shape_gradient(xi, dimensions), xi.T
        ds[:, 0, 0] -= 2.0 * v * (v - 1.0) / dimensions[0]
        ds[:, 1, 0] -= 2.0 * (u - 1.0) * (2.0 * v - 1.0) / dimensions[1]
        return ds

    return PlateShape(value=value, gradient=gradient)


@pytest.mark.parametrize(("name", "compute"), CASES)
def test_misread_sign_is_caught(name: str, compute: Callable[[PlateModel], np.ndarray]) -> None:
    """Negative control: the same check must fail, and by far."""
    assert _error(name, compute(_model(_misread()))) > 1e4 * TOLERANCE


@pytest.mark.parametrize("index", range(1, 16))  # s_1 belongs to the origin: turned, it moves nothing
def test_function_of_wrong_sign_cannot_even_build(index: int) -> None:
    """A whole shape function turned makes the reference configuration fold over: det J0 <= 0 stops it."""
    sign = np.where(np.arange(16) == index, -1.0, 1.0)
    turned = PlateShape(
        value=lambda x, d: sign * plate_shape(x, d), gradient=lambda x, d: sign * plate_shape_gradient(x, d)
    )
    with pytest.raises(MeshError, match="det J0"):
        _model(turned)


@pytest.mark.parametrize(
    ("quadrature", "published"), [((2, 2, 2), 0.14), ((3, 3, 2), 3.3e-3), ((4, 4, 2), 5e-7), ((5, 5, 2), 3e-10)]
)
def test_gauss_orders_have_their_published_errors(quadrature: tuple[int, int, int], published: float) -> None:
    """Source: contracts/published/README.md; one digit is printed, so within a factor of two."""
    assert published / 2 < _error("elastic_force", _elastic(_model(quadrature=quadrature))) < 2 * published
