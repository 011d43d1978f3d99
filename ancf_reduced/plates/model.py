"""A mesh of plates with material and integration points: energy, forces and exact tangents.

Forces oppose an external generalised force of the same sign; tangents are their derivatives. Matrices come plate by
plate, (n_plates, 48, 48); `plates.assembly` puts them together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates import damping_kernels as damping
from ancf_reduced.plates import thickness_kernels as thickness
from ancf_reduced.plates.assembly import dense_matrix
from ancf_reduced.plates.elastic_kernels import energy_kernel, force_kernel
from ancf_reduced.plates.mesh import PlateMesh
from ancf_reduced.plates.shape_functions import THESIS_SHAPE, PlateShape
from ancf_reduced.plates.step_kernels import step_matrix_kernel
from ancf_reduced.plates.tables import PlateTables, in_blocks, plate_tables
from ancf_reduced.plates.tangent_kernels import tangent_kernel
from contracts.errors import InputError, MeshError

__all__ = ["PlateModel", "PoissonLocking", "build_plate_model"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Pair = tuple[float, float]
ElasticConstants = tuple[IntArray, FloatArray, FloatArray, FloatArray, FloatArray, Pair]
ReliefConstants = tuple[IntArray, FloatArray, tuple[FloatArray, FloatArray], FloatArray, FloatArray, FloatArray, Pair]
ViscousConstants = tuple[IntArray, FloatArray, FloatArray, FloatArray, Pair]


class PoissonLocking(StrEnum):
    """What is done about the thickness strain that cannot follow bending; nothing need be for nu = 0."""

    AS_IS = "as_is"
    """The thesis' element: a narrow strip is 12 % too stiff in bending at nu = 0.33."""
    RELIEVED = "relieved"
    """No normal stress through the thickness from the part of the strain that varies across it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateModel:
    """Everything about a mesh of plates that does not change with its motion.

    Attributes
    ----------
    mesh : nodes, plates, reference configuration
    lame : lambda, mu [Pa]
    viscosity : lambda_v, mu_v of the Navier-Stokes damping [Pa s]
    density : rho [kg/m^3]
    tables : shape functions at the integration points
    frame : (n_plates, 4, 3, 3) float [m], J0 diag(a, b, t) at the nodes
    metric : (n_plates, n_blocks, 2, 6, LANES) float [m^2, 1/m^2], G_kl and G^kl of the stress-free plates
    weight : (n_plates, n_blocks, LANES) float [m^3], dV0 times the Gauss weight
    carry : (n_plates, n_blocks, 3, 3, LANES) float [-], see `thickness_kernels`; None leaves Poisson locking as it is

    Verified by tests/unit/test_ancf_plate_model.py and tests/verification/test_ancf_plate_reference.py.
    """

    mesh: PlateMesh
    lame: tuple[float, float]
    viscosity: tuple[float, float]
    density: float
    tables: PlateTables
    frame: FloatArray
    metric: FloatArray
    weight: FloatArray
    carry: FloatArray | None
    _elastic: ElasticConstants = field(init=False, repr=False)
    _relief: ReliefConstants | None = field(init=False, repr=False)
    _viscous: ViscousConstants = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """The constant arguments of the loops."""
        elements, frame, tables, law = (
            self.mesh.elements,
            self.frame,
            self.tables,
            (self.metric, self.weight, self.lame),
        )
        object.__setattr__(self, "_elastic", (elements, frame, tables.gradient, *law))
        both = tables.gradient, tables.middle_gradient
        object.__setattr__(self, "_relief", None if self.carry is None else (elements, frame, both, self.carry, *law))
        object.__setattr__(self, "_viscous", (elements, frame, tables.gradient, tables.gauss_weight, self.viscosity))

    @property
    def volume(self) -> FloatArray:
        """dV0 = det(J0) dV times the Gauss weight at every point, (n_plates, n_points) float [m^3]."""
        return self.tables.at_points(self.weight)

    @property
    def shape(self) -> FloatArray:
        """Shape functions at the points in structure coordinates, r = shape . p, (n_plates, n_points, 16) float."""
        return self.mesh.in_structure_coordinates(self.tables.shape[None], self.frame)

    def elastic_energy(self, coordinates: FloatArray) -> float:
        """Strain energy [J] at the structure coordinates (n_nodes, 4, 3)."""
        energy = energy_kernel(coordinates, *self._elastic)
        if self._relief is not None:
            energy += thickness.relief_energy_kernel(coordinates, *self._relief)
        return energy

    def elastic_force(self, coordinates: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Generalised elastic force Q_s = dU/dp (thesis eq. 2.23).

        Parameters
        ----------
        coordinates : (n_nodes, 4, 3) float [m, -]
        out : array to write to, so that nothing is allocated

        Returns
        -------
        force : (n_nodes, 4, 3) float [N, N m]
        """
        force = np.empty_like(coordinates) if out is None else out
        force_kernel(coordinates, *self._elastic, force)
        if self._relief is not None:
            thickness.relief_force_kernel(coordinates, *self._relief, force)
        return force

    def elastic_tangents(self, coordinates: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Exact tangent dQ_s/dp of each plate, (n_plates, 48, 48) float [N/m, N, N m], symmetric."""
        tangents = np.empty((len(self.mesh.elements), 48, 48)) if out is None else out
        tangent_kernel(coordinates, *self._elastic, tangents)
        if self._relief is not None:
            thickness.relief_tangent_kernel(coordinates, *self._relief, tangents)
        return tangents

    def elastic_tangent(self, coordinates: FloatArray) -> FloatArray:
        """Exact tangent of the mesh, (12 n_nodes, 12 n_nodes) float; for small meshes, as it is not sparse."""
        return dense_matrix(self.mesh, self.elastic_tangents(coordinates))

    def damping_force(self, coordinates: FloatArray, rates: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Generalised force of the Navier-Stokes damping, zero in rigid motion.

        Parameters
        ----------
        coordinates, rates : (n_nodes, 4, 3) float [m, -] and [m/s, 1/s]
        out : array to write to

        Returns
        -------
        force : (n_nodes, 4, 3) float [N, N m]; its product with ``rates`` is the dissipated power, >= 0

        Verified by tests/unit/test_ancf_damping.py.
        """
        force = np.empty_like(coordinates) if out is None else out
        damping.damping_force_kernel(coordinates, rates, *self._viscous, force)
        return force

    def damping_tangents(self, coordinates: FloatArray, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the damping force by the coordinates and by the rates, (n_plates, 48, 48) float each."""
        by_position = np.empty((len(self.mesh.elements), 48, 48))
        damping.damping_position_kernel(coordinates, rates, *self._viscous, by_position)
        return by_position, self.damping_matrices(coordinates)

    def damping_matrices(self, coordinates: FloatArray) -> FloatArray:
        """Derivative C of the damping force C(p) p' by the rates, (n_plates, 48, 48) float, symmetric."""
        matrices = np.empty((len(self.mesh.elements), 48, 48))
        damping.damping_velocity_kernel(coordinates, *self._viscous, matrices)
        return matrices

    def step_matrices(self, coordinates: FloatArray, weights: Pair) -> FloatArray:
        """Elastic tangents times the first weight plus damping matrices times the second, (n_plates, 48, 48) float."""
        w_q, w_v = weights
        matrices, lame = np.empty((len(self.mesh.elements), 48, 48)), (w_q * self.lame[0], w_q * self.lame[1])
        viscosity = w_v * self.viscosity[0], w_v * self.viscosity[1]
        at_points = self.weight, self.tables.gauss_weight
        elements, frame, gradient, metric, *_ = self._elastic
        step_matrix_kernel(coordinates, elements, frame, gradient, metric, at_points, lame, viscosity, matrices)
        if self._relief is not None:
            thickness.relief_tangent_kernel(coordinates, *self._relief[:-1], lame, matrices)
        return matrices

    def volume_ratio(self, coordinates: FloatArray) -> FloatArray:
        """det F at the integration points, (n_plates, n_points) float [-]; <= 0 where a plate is inverted."""
        present = np.linalg.det(_base_vectors(self.tables, self.mesh.normalised(coordinates, self.frame)))
        return np.asarray(present * self.tables.weights / self.volume)


def build_plate_model(
    mesh: PlateMesh,
    *,
    young_modulus: float,
    poisson_ratio: float,
    density: float,
    quadrature: tuple[int, int, int] = (5, 5, 3),
    viscosity: tuple[float, float] = (0.0, 0.0),
    poisson_locking: PoissonLocking = PoissonLocking.AS_IS,
    shape: PlateShape = THESIS_SHAPE,
) -> PlateModel:
    """Evaluate shape functions, metric and volumes at the Gauss points of every plate.

    Parameters
    ----------
    mesh : plates in their stress-free configuration, which may be curved
    young_modulus, density : E > 0 [Pa], rho > 0 [kg/m^3]
    poisson_ratio : nu, -1 < nu < 0.5 [-]
    quadrature : Gauss points along x1, x2, x3
    viscosity : lambda_v, mu_v >= 0 of the Navier-Stokes damping [Pa s]
    poisson_locking : whether the element's locking for nu > 0 is relieved
    shape : interpolation, thesis eq. 2.13 by default

    Raises
    ------
    InputError, MeshError
        For a material or a quadrature out of range; if det J0 <= 0 at a Gauss point.
    """
    _check(young_modulus, poisson_ratio, density, viscosity)
    tables = plate_tables(quadrature, shape)
    frame = mesh.gradients * mesh.dimensions[:, None, None, :]
    e = mesh.normalised(mesh.reference_coordinates(), frame)
    base = _base_vectors(tables, e)
    determinant = np.linalg.det(base)
    if np.any(determinant <= 0.0):
        j = int(np.argwhere(determinant <= 0.0)[0, 0])
        raise MeshError(f"plate {j} ({mesh.parts[j]}) has det J0 <= 0 inside: too curved for its thickness")
    covariant = base @ np.swapaxes(base, -1, -2)
    metric = np.stack([_components(covariant), _components(np.linalg.inv(covariant))], axis=1)
    return PlateModel(
        mesh=mesh,
        lame=_lame(young_modulus, poisson_ratio),
        viscosity=viscosity,
        density=density,
        tables=tables,
        frame=np.ascontiguousarray(frame),
        metric=np.ascontiguousarray(np.moveaxis(in_blocks(metric), -2, 1)),
        weight=in_blocks(determinant * tables.weights),
        carry=_carry(tables, base, e) if poisson_locking is PoissonLocking.RELIEVED else None,
    )


def _lame(young_modulus: float, poisson_ratio: float) -> Pair:
    """lambda, mu [Pa]."""
    lam = young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio))
    return lam, young_modulus / (2.0 * (1.0 + poisson_ratio))


def _carry(tables: PlateTables, base: FloatArray, e: FloatArray) -> FloatArray:
    """H of `thickness_kernels`: the base vectors at the points in those of the mid-surface."""
    H = np.swapaxes(base @ np.linalg.inv(_base_vectors(tables, e, on_middle=True)), -1, -2)
    return np.ascontiguousarray(np.moveaxis(in_blocks(np.moveaxis(H, 1, -1)), -2, 1))


def _base_vectors(tables: PlateTables, e: FloatArray, *, on_middle: bool = False) -> FloatArray:
    """Rows dr/dxi^k, (n_plates, n_points, 3, 3), of plates with the normalised coordinates e (n_plates, 16, 3)."""
    blocks = tables.middle_gradient if on_middle else tables.gradient
    D = tables.at_points(np.moveaxis(blocks, 0, -2))  # (3, 16, n_points)
    return np.asarray(np.einsum("ksq,jsi->jqki", D, e, optimize=True))


def _components(tensor: FloatArray) -> FloatArray:
    """Components 11, 22, 33, 23, 13, 12 of symmetric tensors (n_plates, n_points, 3, 3), (n_plates, 6, n_points)."""
    return np.moveaxis(tensor[..., [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]], -1, -2)


def _check(young_modulus: float, poisson_ratio: float, density: float, viscosity: tuple[float, float]) -> None:
    """Raise InputError for a material out of range."""
    for what, value, unit in (("young modulus", young_modulus, "Pa"), ("density", density, "kg/m^3")):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(what, f"{value:g} {unit}", "must be finite and > 0", "check the unit")
    if not -1.0 < poisson_ratio < 0.5:
        raise InputError("poisson ratio", f"{poisson_ratio:g}", "must lie in (-1, 0.5)", "the thesis has 0")
    for what, value in zip(("lambda_v", "mu_v"), viscosity, strict=True):
        if not (math.isfinite(value) and value >= 0.0):
            raise InputError(f"viscosity {what}", f"{value:g} Pa s", "must be finite and >= 0", "0 is no damping")
