"""Mass, gravity and elastic force of one plate, against matrices by exact quadrature.

1 x 1 x 0.01 m, density 7850 kg/m^3, E = 210 GPa, nu = 0.3; node 2 raised by 1 mm for the elastic force. Source:
contracts/published/ancf_plate_*.csv, which agree with those that Project Chrono publishes for its 3443 shell, the same
element, to 1e-11. Verified by tests/verification/test_ancf_plate_reference.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.mass import gravity_force, mass_matrix
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.model import PlateModel, build_plate_model
from ancf_reduced.plates.shape_functions import THESIS_SHAPE, PlateShape, plate_shape, plate_shape_gradient
from contracts.published import published_matrix

__all__ = ["EXACT", "PlateErrors", "misread_shape", "plate_errors", "reference_plate"]

FloatArray = NDArray[np.float64]
X, Y, Z = np.eye(3)
EXACT = (8, 8, 4)
"""Gauss points that integrate the element's polynomials exactly."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateErrors:
    """What the run measured: largest difference from the reference over its largest entry [-]."""

    mass: float
    gravity: float
    elastic_force: float


def plate_errors(quadrature: tuple[int, int, int] = EXACT, shape: PlateShape = THESIS_SHAPE) -> PlateErrors:
    """Differences of one plate from the reference."""
    model = reference_plate(quadrature, shape)
    raised = model.mesh.reference_coordinates()
    raised[1, 0, 2] += 1e-3
    return PlateErrors(
        mass=_error(published_matrix("ancf_plate_mass"), mass_matrix(model)),
        gravity=_error(published_matrix("ancf_plate_gravity"), gravity_force(model, -9.80665 * Z)),
        elastic_force=_error(published_matrix("ancf_plate_elastic_force"), model.elastic_force(raised)),
    )


def reference_plate(quadrature: tuple[int, int, int] = EXACT, shape: PlateShape = THESIS_SHAPE) -> PlateModel:
    """The plate; MeshError for shape functions in which it folds over."""
    mesh = build_plate_mesh([flat_patch(0.0 * X, X, Y, 0.01, "plate")])
    return build_plate_model(
        mesh, young_modulus=210e9, poisson_ratio=0.3, density=7850.0, quadrature=quadrature, shape=shape
    )


def misread_shape() -> PlateShape:
    """Thesis eq. 2.13 with one sign of s_1 turned: 2 eta^2 + eta + ... instead of 2 eta^2 - eta + ..."""

    def value(xi: FloatArray, dimensions: FloatArray) -> FloatArray:
        s, (u, v, _) = plate_shape(xi, dimensions), xi.T
        s[:, 0] -= 2.0 * v * (u - 1.0) * (v - 1.0)
        return s

    def gradient(xi: FloatArray, dimensions: FloatArray) -> FloatArray:
        ds, (u, v, _) = plate_shape_gradient(xi, dimensions), xi.T
        ds[:, 0, 0] -= 2.0 * v * (v - 1.0) / dimensions[0]
        ds[:, 1, 0] -= 2.0 * (u - 1.0) * (2.0 * v - 1.0) / dimensions[1]
        return ds

    return PlateShape(value=value, gradient=gradient)


def _error(reference: FloatArray, value: FloatArray) -> float:
    return float(np.abs(value.reshape(reference.shape) - reference).max() / np.abs(reference).max())
