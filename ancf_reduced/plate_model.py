"""A mesh of plates with material and integration points: strain energy, elastic force, exact tangent."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plate_kernels import elastic_energy_kernel, elastic_force_kernel, elastic_tangent_kernel
from ancf_reduced.plate_mesh import PlateMesh
from ancf_reduced.shape_functions import THESIS_SHAPE, PlateShape, gauss_points
from contracts.errors import InputError, MeshError

__all__ = ["PlateModel", "build_plate_model"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateModel:
    """Everything about a mesh of plates that does not change with its motion.

    Attributes
    ----------
    mesh : nodes, plates, reference configuration
    lame : lambda, mu [Pa]
    density : rho [kg/m^3]
    shape : (n_plates, n_points, 16) float, shape functions at the integration points, T folded in: r = shape . p
    gradient : (n_plates, n_points, 3, 16) float, d shape / d X, J0^-1 and T folded in:
        F[i, k] = sum_a p[a, i] gradient[k, a]
    volume : (n_plates, n_points) float [m^3], dV0 = det(J0) dV times the Gauss weight

    Verified by tests/unit/test_ancf_plate_model.py and tests/verification/test_ancf_plate_reference.py.
    """

    mesh: PlateMesh
    lame: tuple[float, float]
    density: float
    shape: FloatArray
    gradient: FloatArray
    volume: FloatArray

    def elastic_energy(self, coordinates: FloatArray) -> float:
        """Strain energy [J] at the structure coordinates (n_nodes, 4, 3)."""
        return elastic_energy_kernel(coordinates, self.mesh.elements, self.gradient, self.volume, self.lame)

    def elastic_force(self, coordinates: FloatArray) -> FloatArray:
        """Generalised elastic force Q_s = dU/dp (thesis eq. 2.23).

        Parameters
        ----------
        coordinates : (n_nodes, 4, 3) float [m, -]

        Returns
        -------
        force : (n_nodes, 4, 3) float [N, N m]; it opposes an external generalised force of the same sign
        """
        force = np.empty_like(coordinates)
        elastic_force_kernel(coordinates, self.mesh.elements, self.gradient, self.volume, self.lame, force)
        return force

    def elastic_tangent(self, coordinates: FloatArray) -> FloatArray:
        """Exact tangent dQ_s/dp, (12 n_nodes, 12 n_nodes) float [N/m, N, N m], symmetric."""
        tangent = np.empty((coordinates.size, coordinates.size))
        elastic_tangent_kernel(coordinates, self.mesh.elements, self.gradient, self.volume, self.lame, tangent)
        return tangent

    def volume_ratio(self, coordinates: FloatArray) -> FloatArray:
        """det F at the integration points, (n_plates, n_points) float [-]; <= 0 where a plate is inverted."""
        e = coordinates[self.mesh.elements].reshape(len(self.volume), 1, 16, 3)
        determinant: FloatArray = np.linalg.det(self.gradient @ e)
        return determinant


def build_plate_model(
    mesh: PlateMesh,
    *,
    young_modulus: float,
    poisson_ratio: float,
    density: float,
    quadrature: tuple[int, int, int] = (5, 5, 3),
    shape: PlateShape = THESIS_SHAPE,
) -> PlateModel:
    """Evaluate shape functions, J0 and volumes at the Gauss points of every plate.

    Parameters
    ----------
    mesh : plates in their reference configuration
    young_modulus, density : E > 0 [Pa], rho > 0 [kg/m^3]
    poisson_ratio : nu, -1 < nu < 0.5 [-]; nu > 0 locks in thickness, about 12 % in bending
    quadrature : Gauss points along x1, x2, x3
    shape : interpolation, thesis eq. 2.13 by default

    Raises
    ------
    InputError, MeshError
        For a material or a quadrature out of range; if det J0 <= 0 at a Gauss point.
    """
    _check(young_modulus, poisson_ratio, density, quadrature)
    xi, weights = gauss_points(quadrature)
    T, X = mesh.transform, mesh.element_coordinates(mesh.reference_coordinates())
    value = np.array([shape.value(xi, d) for d in mesh.dimensions])
    local = np.array([shape.gradient(xi, d) for d in mesh.dimensions])
    J0 = np.einsum("jgka,jai->jgik", local, X)  # J0[i, k] = dX_i/dx_k, thesis eq. 2.9
    determinant = np.linalg.det(J0)
    if np.any(determinant <= 0.0):
        j = int(np.argwhere(determinant <= 0.0)[0, 0])
        raise MeshError(f"plate {j} ({mesh.parts[j]}) has det J0 <= 0 inside: too curved for its thickness")
    by_X = np.einsum("jgik,jgka->jgia", np.swapaxes(np.linalg.inv(J0), 2, 3), local)
    volume = determinant * weights * mesh.dimensions.prod(axis=1)[:, None]
    lam = young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio))
    return PlateModel(
        mesh=mesh,
        lame=(lam, young_modulus / (2.0 * (1.0 + poisson_ratio))),
        density=density,
        shape=np.ascontiguousarray(value @ T),
        gradient=np.ascontiguousarray(by_X @ T[:, None]),
        volume=volume,
    )


def _check(young_modulus: float, poisson_ratio: float, density: float, quadrature: tuple[int, int, int]) -> None:
    """Raise InputError for a material or a Gauss rule out of range."""
    for what, value, unit in (("young modulus", young_modulus, "Pa"), ("density", density, "kg/m^3")):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(what, f"{value:g} {unit}", "must be finite and > 0", "check the unit")
    if not -1.0 < poisson_ratio < 0.5:
        raise InputError("poisson ratio", f"{poisson_ratio:g}", "must lie in (-1, 0.5)", "the thesis has 0")
    if len(quadrature) != 3 or min(quadrature) < 1:
        raise InputError("quadrature", quadrature, "needs three counts of 1 or more", "give e.g. (5, 5, 3)")
